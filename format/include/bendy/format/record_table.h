#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/chunk.h>
#include <bendy/format/public.h>
#include <bendy/format/records.h>

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

// The table records.def as data, for code that treats all records alike: displays, compares or rewrites them.
namespace BENDY_PUBLIC bendy {

enum class FieldType : std::uint8_t { u8, u16, u32, u64, f32, record };
enum class NumberType : std::uint8_t { u8, i8, u16, i16, u32, i32, u64, f32 };

/// Size in bytes of one number of the type.
constexpr std::uint64_t size_of(NumberType type) {
    constexpr std::uint64_t kSizes[] = {1, 1, 2, 2, 4, 4, 8, 4};
    return kSizes[static_cast<std::size_t>(type)];
}
/// "u8", "f32", ...
std::string_view name_of(NumberType type);
/// \param type  not FieldType::record
NumberType number_type(FieldType type);
NumberType number_type(ComponentType type);

/// Size in bytes of one number of the type; 0 for `record`.
constexpr std::uint64_t field_type_size(FieldType type) {
    constexpr std::uint64_t kSizes[] = {1, 2, 4, 8, 4, 0};
    return kSizes[static_cast<std::size_t>(type)];
}

/// The kinds of things that an index can refer to. Joints, meshes and chains are numbered within their object,
/// materials and textures within HEAD; for any_material, numbers with kLocalMaterial are among the joint's own. Frames
/// are those of a mesh.
enum class Entity : std::uint8_t { nothing, joint, material, any_material, mesh, texture, chain, frame };
inline constexpr unsigned kEntities = 8;
/// "joint", "mesh", ...; empty for nothing.
std::string_view name_of(Entity entity);

/// The kind of thing that the number in a field refers to.
struct Reference {
    static constexpr std::size_t kMostChoices = 8;

    Entity entity = Entity::nothing;             ///< without a selector
    std::string_view selector;                   ///< field of the same record that picks one of `choices`; or empty
    std::array<Entity, kMostChoices> choices{};  ///< by the selector's value
    bool is_optional = false;                    ///< kNone is allowed; otherwise the record is removed with what it
                                                 ///< refers to

    [[nodiscard]] bool is_any() const { return entity != Entity::nothing || !selector.empty(); }
};

struct RecordField {
    std::string_view record;     ///< name of its struct
    std::string_view name;       ///< as in records.h
    std::string_view type_name;  ///< as in the table; for a nested record, its struct
    FieldType type = FieldType::u8;
    std::uint32_t count = 1;   ///< number of numbers, or of records
    std::uint64_t offset = 0;  ///< bytes from the start of the record
    std::string_view unit;     ///< "metres", "seconds", "radians", or empty
    std::string_view values;   ///< names of an enumeration's values from 0 on, separated by spaces; or empty
    Reference reference;

    /// True for fields that must be zero: a later version may give them a meaning.
    [[nodiscard]] bool is_reserved() const { return name.starts_with("reserved"); }
    /// True for UTF-8 padded with zeros to the field's end.
    [[nodiscard]] bool is_text() const { return unit == "text"; }
    /// Returns the name of an enumeration's value; empty if it has none.
    [[nodiscard]] std::string_view value_name(std::uint64_t value) const;
};

struct RecordLayout {
    std::string_view name;       ///< of the struct
    FourCC chunk;                ///< the chunk under which the table lists it
    std::uint64_t shortest = 0;  ///< minimum size of a payload in bytes
    std::uint64_t size = 0;      ///< size of all fields in bytes
    std::span<const RecordField> fields;

    /// Returns the field with this name; nothing if there is none.
    [[nodiscard]] const RecordField* find(std::string_view field) const;
};

/// Returns all records in table order.
std::span<const RecordLayout> record_layouts();

/// Returns the record with this name, including JointSubmesh; nothing if there is none.
const RecordLayout* find_layout(std::string_view record);

/// Returns the unsigned integer in a field of a record at `base`; 0 beyond the payload's end.
std::uint64_t field_number(const RecordField& field, Bytes payload, std::uint64_t base);

/// Returns what the field refers to in the record at `base`.
Entity referred_entity(const RecordLayout& layout, const RecordField& field, Bytes payload, std::uint64_t base);

}  // namespace bendy
