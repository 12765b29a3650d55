#include "compare_content.h"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <vector>

// Compares leaves as described by leaf_parts.def: field by field, record by record, number by number.
namespace bendy::diff {
namespace {

/// Returns false for fields beyond the end of a record: a shorter one lacks its last fields.
bool has_field(const RecordField& field, Bytes record) {
    return field.offset < record.size();
}

double real_at(NumberType type, Bytes payload, std::uint64_t at) {
    const auto read = [&](auto number) {
        copy_at(payload, at, number);
        return static_cast<double>(number);
    };
    switch (type) {
        case NumberType::u8:
            return read(std::uint8_t{});
        case NumberType::i8:
            return read(std::int8_t{});
        case NumberType::u16:
            return read(std::uint16_t{});
        case NumberType::i16:
            return read(std::int16_t{});
        case NumberType::u32:
            return read(std::uint32_t{});
        case NumberType::i32:
            return read(std::int32_t{});
        case NumberType::u64:
            return read(std::uint64_t{});
        case NumberType::f32:
            break;
    }
    return read(0.0f);
}

bool is_unsigned(NumberType type) {
    return type != NumberType::f32 && type != NumberType::i8 && type != NumberType::i16 && type != NumberType::i32;
}

/// Returns a field of numbers or of text; nothing if the record is too short for it.
Value field_value(const RecordField& field, Bytes record) {
    if (!has_field(field, record)) return {};
    if (field.is_text()) {
        const std::string_view text =
            as_text(record.subspan(field.offset, std::min<std::uint64_t>(field.count, record.size() - field.offset)));
        return Scalar{std::string(text.substr(0, text.find('\0')))};
    }
    Value value;
    value.items.clear();
    value.is_list = field.count != 1;
    for (std::uint32_t k = 0; k < field.count; ++k) {
        RecordField one = field;
        one.offset += k * field_type_size(field.type);
        if (field.type == FieldType::f32) {
            value.items.emplace_back(real_at(NumberType::f32, record, one.offset));
        } else {
            value.items.emplace_back(field_number(one, record, 0));
        }
    }
    return value;
}

/// Returns true if the values are equal as numbers: 0 equals -0, and NaN equals NaN.
bool are_equal(const Value& a, const Value& b) {
    const auto is_same = [](const Scalar& x, const Scalar& y) {
        const double* here = std::get_if<double>(&x);
        const double* there = std::get_if<double>(&y);
        return x == y || (here != nullptr && there != nullptr && *here != *here && *there != *there);
    };
    return a.is_list == b.is_list &&
           std::equal(a.items.begin(), a.items.end(), b.items.begin(), b.items.end(), is_same);
}

/// Returns the texts, each of which is followed by a zero.
std::vector<std::string_view> names_in(Bytes payload) {
    std::vector<std::string_view> names;
    for (std::string_view text = as_text(payload); !text.empty();) {
        const std::size_t end = std::min(text.find('\0'), text.size() - 1);
        names.push_back(text.substr(0, end));
        text.remove_prefix(end + 1);
    }
    return names;
}

Value text_value(std::string_view text) {
    return Scalar{std::string(text)};
}

}  // namespace

void ContentComparer::compare_parts(ChunkPair leaves) {
    const LeafLayout* leaf = find_leaf(a_.tree[leaves.a].id);
    if (leaf == nullptr) return;
    const Bytes a = a_.tree.payload(leaves.a);
    const Bytes b = b_.tree.payload(leaves.b);
    const LocatedParts parts_a = locate_parts(*leaf, a);
    const LocatedParts parts_b = locate_parts(*leaf, b);
    for (const LocatedPart& here : parts_a.list) {
        const LocatedPart* there = parts_b.find(here.part->name);
        if (there == nullptr || there->part->kind != here.part->kind) continue;
        const Bytes bytes_a = a.subspan(here.offset, here.size);
        const Bytes bytes_b = b.subspan(there->offset, there->size);
        switch (here.part->kind) {
            case PartKind::record:
                compare_fields(leaves, {}, *here.shape.record, bytes_a, bytes_b);
                break;
            case PartKind::records:
                compare_records(leaves, here, *there);
                break;
            case PartKind::numbers:
                compare_number_parts(leaves, here, *there);
                break;
            case PartKind::text:
                if (as_text(bytes_a) != as_text(bytes_b)) {
                    add_value(leaves, std::string(here.part->name), text_value(as_text(bytes_a)),
                              text_value(as_text(bytes_b)));
                }
                break;
            case PartKind::names:
                compare_names(leaves, *here.part, bytes_a, bytes_b);
                break;
            case PartKind::bytes:
            case PartKind::odd:
                break;
        }
    }
}

/// Fields of nested records are called "outer.inner".
void ContentComparer::compare_fields(ChunkPair leaves, const std::string& prefix, const RecordLayout& layout, Bytes a,
                                     Bytes b) {
    for (const RecordField& field : layout.fields) {
        if (field.type != FieldType::record) {
            compare_field(leaves, prefix, field, a, b);
            continue;
        }
        const auto rest = [&](Bytes record) {
            return record.subspan(std::min<std::uint64_t>(field.offset, record.size()));
        };
        for (const RecordField& inner : find_layout(field.type_name)->fields)
            compare_field(leaves, prefix + std::string(field.name) + '.', inner, rest(a), rest(b));
    }
}

/// Compares a field of numbers.
void ContentComparer::compare_field(ChunkPair leaves, const std::string& prefix, const RecordField& field, Bytes a,
                                    Bytes b) {
    if (field.is_reserved()) return;
    Value here = field_value(field, a);
    Value there = field_value(field, b);
    if (!are_equal(here, there)) add_value(leaves, prefix + std::string(field.name), std::move(here), std::move(there));
}

/// Returns "joint 3 \"Hips\": " if each row belongs to a joint, otherwise "ranges 3: ".
std::string ContentComparer::row_name(ChunkPair leaves, const LeafPart& part, std::uint64_t row) const {
    if (part.each == Entity::nothing) return std::string(part.name) + ' ' + std::to_string(row);
    if (part.each == Entity::joint) return joint_name(a_.objects[a_.tree[leaves.a].parent], row);
    return std::string(name_of(part.each)) + ' ' + std::to_string(row);
}

std::string ContentComparer::joint_name(const ObjectView* object, std::uint64_t joint) {
    std::string name = "joint " + std::to_string(joint);
    const bool has_name = object != nullptr && joint < object->skeleton.joints.size();
    if (!has_name || object->skeleton.joints[joint].name.empty()) return name;
    return name + " \"" + std::string(object->skeleton.joints[joint].name) + '"';
}

void ContentComparer::compare_records(ChunkPair leaves, const LocatedPart& a, const LocatedPart& b) {
    const RecordLayout& layout = *a.shape.record;
    if (a.shape.count != b.shape.count && a.part->count == "rest")
        add_value(leaves, std::string(a.part->name), Scalar{a.shape.count}, Scalar{b.shape.count});
    for (std::uint64_t row = 0; row < std::min(a.shape.count, b.shape.count); ++row) {
        const Bytes here = a_.tree.payload(leaves.a).subspan(a.offset + row * layout.size, layout.size);
        const Bytes there = b_.tree.payload(leaves.b).subspan(b.offset + row * layout.size, layout.size);
        if (std::memcmp(here.data(), there.data(), layout.size) == 0) continue;
        compare_fields(leaves, row_name(leaves, *a.part, row) + ": ", layout, here, there);
    }
}

void ContentComparer::compare_number_parts(ChunkPair leaves, const LocatedPart& a, const LocatedPart& b) {
    const std::string name = a.part->name == "values" ? std::string() : std::string(a.part->name);
    if (a.shape.count != b.shape.count && a.part->count == "rest")
        add_value(leaves, name.empty() ? "numbers" : name, Scalar{a.shape.count}, Scalar{b.shape.count});
    const auto number_of = [](Bytes payload, const LocatedPart& part) {
        return [payload, &part](std::uint64_t at) {
            return real_at(part.shape.type, payload, part.offset + at * part.shape.unit());
        };
    };
    compare_numbers(leaves, name, std::min(a.shape.count, b.shape.count), a.shape.row,
                    number_of(a_.tree.payload(leaves.a), a), number_of(b_.tree.payload(leaves.b), b),
                    is_unsigned(a.shape.type) && is_unsigned(b.shape.type));
}

void ContentComparer::compare_names(ChunkPair leaves, const LeafPart& part, Bytes a, Bytes b) {
    const auto here = names_in(a);
    const auto there = names_in(b);
    if (here.size() != there.size())
        add_value(leaves, std::string(part.name), Scalar{here.size()}, Scalar{there.size()});
    for (std::size_t k = 0; k < std::min(here.size(), there.size()); ++k) {
        if (here[k] == there[k]) continue;
        const std::string row = std::string(name_of(part.each)) + ' ' + std::to_string(k);
        add_value(leaves, row, text_value(here[k]), text_value(there[k]));
    }
}

void ContentComparer::compare_bytes(ChunkPair leaves, Bytes a, Bytes b) {
    const std::size_t shared = std::min(a.size(), b.size());
    Difference difference;
    difference.kind = Difference::Kind::bytes;
    difference.chunks = leaves;
    difference.of = std::max(a.size(), b.size());
    difference.count = difference.of - shared;
    difference.first_element = shared;
    difference.a_value = Scalar{a.size()};
    difference.b_value = Scalar{b.size()};
    for (std::size_t at = shared; at-- > 0;) {
        if (a[at] == b[at]) continue;
        ++difference.count;
        difference.first_element = at;
    }
    if (difference.count != 0) differences_.add(std::move(difference));
}

}  // namespace bendy::diff
