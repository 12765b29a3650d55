#pragma once

#include <bendy/format/fourcc.h>
#include <bendy/format/public.h>

#include <cstdint>
#include <span>
#include <string_view>

// The table records.def as data, for code that treats all records alike: shows, compares, or rewrites them.
namespace BENDY_PUBLIC bendy {

enum class FieldType : std::uint8_t { u8, u16, u32, u64, f32, record };

/// Bytes of one number of the type; of `record` 0.
constexpr std::uint64_t field_type_size(FieldType type) {
    constexpr std::uint64_t kSizes[] = {1, 2, 4, 8, 4, 0};
    return kSizes[static_cast<std::size_t>(type)];
}

struct RecordField {
    std::string_view record;     ///< struct that it belongs to
    std::string_view name;       ///< as in records.h
    std::string_view type_name;  ///< as in the table; of a record inside the record, its struct
    FieldType type = FieldType::u8;
    std::uint32_t count = 1;   ///< numbers, or records
    std::uint64_t offset = 0;  ///< bytes from the start of the record

    /// Fields that must be zero: they may mean something one day.
    [[nodiscard]] bool is_reserved() const { return name.starts_with("reserved"); }
};

struct RecordLayout {
    std::string_view name;       ///< of the struct
    FourCC chunk;                ///< under which it stands in the table
    std::uint64_t shortest = 0;  ///< bytes that a payload must have at least
    std::uint64_t size = 0;      ///< bytes of all fields
    std::span<const RecordField> fields;
};

/// All records in the table's order.
std::span<const RecordLayout> record_layouts();

/// The record of this name; nothing if there is none.
const RecordLayout* find_layout(std::string_view record);

/// The record at the start of the chunk's payload, or of which the payload is an array; nothing if it has none.
const RecordLayout* layout_of(FourCC chunk);

/// The payload is text: NAME, EXTR, EXTN, MORE, LINK.
bool is_text(FourCC chunk);

/// The payload is a StreamRecord and its numbers.
bool is_stream(FourCC chunk);

}  // namespace bendy
