#include "inspect/describe_leaf.h"

#include "terminal/problem.h"
#include "terminal/text.h"

#include <algorithm>
#include <string_view>

namespace bendy::cli {
namespace {

using Json = nlohmann::ordered_json;

/// A field of plain numbers, or of text; null for one that is a record itself.
Json field_json(const RecordField& field, Bytes payload, std::uint64_t base) {
    const std::uint64_t at = base + field.offset;
    if (field.is_text()) {
        const std::uint64_t size = std::min<std::uint64_t>(field.count, payload.size() - at);
        const std::string_view text = as_text(payload.subspan(at, size));
        return text.substr(0, text.find('\0'));
    }
    if (field.type == FieldType::record) return nullptr;
    Json list = Json::array();
    for (std::uint32_t k = 0; k < field.count; ++k) {
        if (field.type == FieldType::f32) {
            float number = 0.0f;
            copy_at(payload, at + k * sizeof number, number);
            list.push_back(number);
        } else {
            list.push_back(field_number(field, payload, base + k * field_type_size(field.type)));
        }
    }
    return field.count == 1 ? list.front() : list;
}

/// Calls visit(field) for each field of a record at `base` that the payload holds.
template <class Visit>
void for_each_field(const RecordLayout& layout, Bytes payload, std::uint64_t base, const Visit& visit) {
    for (const RecordField& field : layout.fields) {
        if (!field.is_reserved() && base + field.offset < payload.size()) visit(field);
    }
}

/// Of a record inside a record, which holds numbers only.
Json inner_record_json(const RecordLayout& layout, Bytes payload, std::uint64_t base) {
    Json fields = Json::object();
    for_each_field(layout, payload, base, [&](const RecordField& field) {
        fields[std::string(field.name)] = field_json(field, payload, base);
    });
    return fields;
}

Json record_json(const RecordLayout& layout, Bytes payload, std::uint64_t base) {
    Json fields = Json::object();
    for_each_field(layout, payload, base, [&](const RecordField& field) {
        fields[std::string(field.name)] =
            field.type == FieldType::record
                ? inner_record_json(*find_layout(field.type_name), payload, base + field.offset)
                : field_json(field, payload, base);
    });
    return fields;
}

Json names_json(std::string_view text) {
    Json names = Json::array();
    while (!text.empty()) {
        const std::size_t end = text.find('\0');
        names.push_back(text.substr(0, end));
        text.remove_prefix(std::min(end, text.size() - 1) + 1);
    }
    return names;
}

/// The field says how many bytes a text has, which is shown itself.
bool is_size_of_text(const LeafLayout& leaf, const RecordField& field) {
    return std::any_of(leaf.parts.begin(), leaf.parts.end(),
                       [&](const LeafPart& part) { return part.kind == PartKind::text && part.count == field.name; });
}

/// "solver two_bone", "target joint 3", "soft_zone 0.1 radians".
std::string field_text(const RecordLayout& layout, const RecordField& field, Bytes payload) {
    std::string text(field.name);
    const std::uint64_t number = field_number(field, payload, 0);
    if (const std::string_view value = field.value_name(number); !value.empty() && field.count == 1)
        return text.append(1, ' ').append(value);
    if (field.reference.is_any()) {
        const std::string_view thing = name_of(referred_entity(layout, field, payload, 0));
        if (number == kNone) return text + " none";
        if (!thing.empty() && thing != field.name) text.append(1, ' ').append(thing);
        return text + ' ' + std::to_string(number);
    }
    const Json value = field_json(field, payload, 0);
    if (value.is_string()) return text + " \"" + brief(value.get_ref<const std::string&>()) + '"';
    const auto add = [&](const Json& one) {
        text += ' ';
        text += one.is_number_float() ? brief(one.get<float>()) : grouped(one.get<std::uint64_t>());
    };
    if (value.is_array()) {
        std::for_each(value.begin(), value.end(), add);
    } else {
        add(value);
    }
    if (!field.unit.empty()) text.append(1, ' ').append(field.unit);
    return text;
}

}  // namespace

nlohmann::ordered_json leaf_fields(const LeafLayout& leaf, Bytes payload) {
    Json fields = Json::object();
    const bool is_records = leaf.record() == nullptr;
    // A record that is cut short still says something.
    if (!is_records) fields = record_json(*leaf.record(), payload, 0);
    for (const LocatedPart& located : locate_parts(leaf, payload).list) {
        const std::string name(located.part->name);
        const Bytes bytes = payload.subspan(located.offset, located.size);
        if (located.part->kind == PartKind::text) fields[name] = as_text(bytes);
        if (located.part->kind == PartKind::names) fields[name] = names_json(as_text(bytes));
        if (located.part->kind != PartKind::records || !is_records) continue;
        Json list = Json::array();
        for (std::uint64_t k = 0; k < located.shape.count; ++k)
            list.push_back(record_json(*located.shape.record, bytes, k * located.shape.unit()));
        fields[name] = std::move(list);
    }
    return fields;
}

std::string leaf_text(const LeafLayout& leaf, Bytes payload) {
    std::string text;
    const RecordLayout* record = leaf.record();
    if (record != nullptr) {
        for_each_field(*record, payload, 0, [&](const RecordField& field) {
            if (field.type != FieldType::record && !is_size_of_text(leaf, field))
                add_part(text, field_text(*record, field, payload));
        });
    }
    for (const LocatedPart& located : locate_parts(leaf, payload).list) {
        const Bytes bytes = payload.subspan(located.offset, located.size);
        const std::string name(located.part->name);
        if (located.part->kind == PartKind::text && !bytes.empty())
            add_part(text, name + " \"" + brief(as_text(bytes)) + '"');
        const bool is_list = located.part->kind == PartKind::records || located.part->kind == PartKind::numbers;
        if (is_list && located.part->count == "rest") add_part(text, grouped(located.shape.count) + ' ' + name);
    }
    return text;
}

}  // namespace bendy::cli
