#include <bendy/format/record_table.h>

#include <bendy/format/records.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>

namespace bendy {
namespace {

constexpr FieldType type_of(std::string_view name) {
    constexpr std::array<std::string_view, 5> kNames{"u8", "u16", "u32", "u64", "f32"};
    for (std::size_t k = 0; k < kNames.size(); ++k) {
        if (name == kNames[k]) return static_cast<FieldType>(k);
    }
    return FieldType::record;
}

constexpr std::array<std::string_view, kEntities> kEntityNames{"nothing", "joint",   "material", "any_material",
                                                               "mesh",    "texture", "chain",    "frame"};

constexpr Entity entity_of(std::string_view name) {
    std::size_t k = 0;
    while (kEntityNames.at(k) != name) ++k;
    return static_cast<Entity>(k);
}

/// Returns the word with this number in a list separated by spaces; empty if there are fewer.
constexpr std::string_view word_of(std::string_view words, std::uint64_t number) {
    for (; number > 0; --number) {
        const std::size_t blank = words.find(' ');
        if (blank == std::string_view::npos) return {};
        words.remove_prefix(blank + 1);
    }
    return words.substr(0, words.find(' '));
}

/// A row with more information about a field: the names of its values, its unit.
struct Note {
    std::string_view record, field, text;
};

struct Values {
    std::string_view name, values;
};

/// "any pull two_bone" of "any, pull, two_bone", and zeros.
template <std::size_t N>
constexpr std::array<char, N> without_commas(const char (&list)[N]) {
    std::array<char, N> words{};
    std::copy_if(list, list + N, words.begin(), [](char c) { return c != ','; });
    return words;
}
#define BENDY_VALUES(Values, kCount, ...) constexpr auto k##Values##Words = without_commas(#__VA_ARGS__);
#include <bendy/format/records.def>

constexpr Values kValues[] = {
#define BENDY_VALUES(Values, kCount, ...) {#Values, k##Values##Words.data()},
#include <bendy/format/records.def>
};
constexpr Note kEnums[] = {
#define BENDY_ENUM(Struct, field, Values) {#Struct, #field, #Values},
#include <bendy/format/records.def>
};
constexpr Note kUnits[] = {
#define BENDY_UNIT(Struct, field, unit) {#Struct, #field, #unit},
#include <bendy/format/records.def>
};

struct ReferenceRow {
    std::string_view record, field, selector, things, need;
};
constexpr ReferenceRow kReferences[] = {
#define BENDY_REFERENCE(Struct, field, thing, need) {#Struct, #field, "", #thing, #need},
#define BENDY_REFERENCE_BY(Struct, field, selector, things, need) {#Struct, #field, #selector, things, #need},
#include <bendy/format/records.def>
};

constexpr std::string_view note_of(std::span<const Note> notes, std::string_view record, std::string_view field) {
    for (const Note& note : notes) {
        if (note.field == field && note.record == record) return note.text;
    }
    return {};
}

constexpr std::string_view values_of(std::string_view record, std::string_view field) {
    const std::string_view name = note_of(kEnums, record, field);
    for (const Values& values : kValues) {
        if (values.name == name) return values.values;
    }
    return {};
}

constexpr Reference reference_of(std::string_view record, std::string_view field) {
    Reference reference;
    for (const ReferenceRow& row : kReferences) {
        if (row.field != field || row.record != record) continue;
        reference.is_optional = row.need == "optional";
        reference.selector = row.selector;
        if (row.selector.empty()) {
            reference.entity = entity_of(row.things);
            continue;
        }
        for (std::size_t k = 0; !word_of(row.things, k).empty(); ++k)
            reference.choices.at(k) = entity_of(word_of(row.things, k));
    }
    return reference;
}

constexpr RecordField make_field(std::string_view record, std::string_view name, std::string_view type,
                                 std::uint32_t count, std::uint64_t offset) {
    return {record,
            name,
            type,
            type_of(type),
            count,
            offset,
            note_of(kUnits, record, name),
            values_of(record, name),
            reference_of(record, name)};
}

constexpr RecordField kFields[] = {
#define BENDY_FIELD(Struct, field, type, count, offset, what, ...) make_field(#Struct, #field, #type, count, offset),
#include <bendy/format/records.def>
};

/// The fields of a record are consecutive in the table.
constexpr std::span<const RecordField> fields_of(std::string_view record) {
    std::size_t first = 0;
    while (first < std::size(kFields) && kFields[first].record != record) ++first;
    std::size_t last = first;
    while (last < std::size(kFields) && kFields[last].record == record) ++last;
    return {kFields + first, last - first};
}

constexpr RecordLayout kLayouts[] = {
#define BENDY_RECORD(chunk, Struct, shortest) {#Struct, FourCC(#chunk), shortest, sizeof(Struct), fields_of(#Struct)},
#include <bendy/format/records.def>
};

/// JNTS: a joint and the fields of a SubmeshRecord, as one record.
constexpr auto kJointSubmeshFields = [] {
    constexpr std::span<const RecordField> kRange = fields_of("SubmeshRecord");
    std::array<RecordField, 1 + kRange.size()> fields{};
    fields[0] = make_field("JointSubmesh", "joint", "u32", 1, 0);
    fields[0].reference.entity = Entity::joint;
    for (std::size_t k = 0; k < kRange.size(); ++k) {
        fields[k + 1] = kRange[k];
        fields[k + 1].offset += offsetof(JointSubmesh, submesh);
    }
    return fields;
}();
constexpr RecordLayout kJointSubmesh{"JointSubmesh", FourCC("JNTS"), sizeof(JointSubmesh), sizeof(JointSubmesh),
                                     kJointSubmeshFields};

// Every field has the offset from the table, and there are no gaps.
#define BENDY_RECORD(chunk, Struct, shortest)                                                 \
    static_assert(std::is_trivially_copyable_v<Struct> && std::is_standard_layout_v<Struct>); \
    static_assert(kShortest<Struct> <= sizeof(Struct));
#define BENDY_FIELD(Struct, field, type, count, offset, what, ...) static_assert(offsetof(Struct, field) == (offset));
#include <bendy/format/records.def>

constexpr std::size_t sum_of_fields(std::string_view record) {
    std::size_t sum = 0;
#define BENDY_FIELD(Struct, field, type, count, offset, what, ...) sum += record == #Struct ? sizeof(Struct::field) : 0;
#include <bendy/format/records.def>
    return sum;
}

#define BENDY_RECORD(chunk, Struct, shortest) static_assert(sum_of_fields(#Struct) == sizeof(Struct));
#include <bendy/format/records.def>

}  // namespace

std::string_view name_of(NumberType type) {
    constexpr std::array<std::string_view, 8> kNames{"u8", "i8", "u16", "i16", "u32", "i32", "u64", "f32"};
    return kNames[static_cast<std::size_t>(type)];
}

NumberType number_type(FieldType type) {
    constexpr std::array kTypes{NumberType::u8, NumberType::u16, NumberType::u32, NumberType::u64, NumberType::f32};
    return kTypes[static_cast<std::size_t>(type)];
}

NumberType number_type(ComponentType type) {
    constexpr std::array<NumberType, kComponentTypes> kTypes{NumberType::u8,  NumberType::i8,  NumberType::u16,
                                                             NumberType::i16, NumberType::u32, NumberType::f32};
    return kTypes[static_cast<std::size_t>(type)];
}

std::string_view name_of(Entity entity) {
    return entity == Entity::nothing ? std::string_view() : kEntityNames[static_cast<std::size_t>(entity)];
}

std::string_view RecordField::value_name(std::uint64_t value) const {
    return values.empty() ? values : word_of(values, value);
}

const RecordField* RecordLayout::find(std::string_view field) const {
    const auto found =
        std::find_if(fields.begin(), fields.end(), [&](const RecordField& each) { return each.name == field; });
    return found == fields.end() ? nullptr : &*found;
}

std::span<const RecordLayout> record_layouts() {
    return kLayouts;
}

const RecordLayout* find_layout(std::string_view record) {
    if (record == kJointSubmesh.name) return &kJointSubmesh;
    const auto* found = std::find_if(std::begin(kLayouts), std::end(kLayouts),
                                     [&](const RecordLayout& layout) { return layout.name == record; });
    return found == std::end(kLayouts) ? nullptr : found;
}

std::uint64_t field_number(const RecordField& field, Bytes payload, std::uint64_t base) {
    const std::uint64_t size = field_type_size(field.type);
    const std::uint64_t at = base + field.offset;
    std::uint64_t number = 0;
    if (payload.size() < size || at > payload.size() - size) return number;
    for (std::uint64_t k = 0; k < size; ++k) number |= std::to_integer<std::uint64_t>(payload[at + k]) << (8 * k);
    return number;
}

Entity referred_entity(const RecordLayout& layout, const RecordField& field, Bytes payload, std::uint64_t base) {
    const Reference& reference = field.reference;
    if (reference.selector.empty()) return reference.entity;
    const std::uint64_t choice = field_number(*layout.find(reference.selector), payload, base);
    return choice < reference.choices.size() ? reference.choices[choice] : Entity::nothing;
}

}  // namespace bendy
