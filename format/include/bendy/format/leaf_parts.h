#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/chunk.h>
#include <bendy/format/public.h>
#include <bendy/format/record_table.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

// The table leaf_parts.def as data: the parts of a leaf, and where they are in a payload.
namespace BENDY_PUBLIC bendy {

enum class PartKind : std::uint8_t { record, records, numbers, text, names, bytes, odd };
enum class PartEnding : std::uint8_t { plain, padded };

/// A row of the table. The strings are as in the table.
struct LeafPart {
    PartKind kind = PartKind::record;
    std::string_view name;
    std::string_view type;   ///< struct, number type, or field that gives the type
    std::string_view count;  ///< "2 * components", "rest"
    std::string_view when;   ///< "packed == 1", or empty
    std::string_view row;    ///< number or field
    PartEnding ending = PartEnding::plain;
    Entity each = Entity::nothing;  ///< each row, record or name belongs to one of these
    Entity to = Entity::nothing;    ///< each number refers to one of these
};

struct LeafLayout {
    FourCC chunk;
    std::span<const LeafPart> parts;

    /// Returns the record at its start; nothing if it has none.
    [[nodiscard]] const RecordLayout* record() const;
};

/// Returns nothing for a container or an unknown chunk.
const LeafLayout* find_leaf(FourCC chunk);

/// A count that extends to the end of the payload.
inline constexpr std::uint64_t kTheRest = std::numeric_limits<std::uint64_t>::max();

/// The form of a part in a particular payload, which depends on the payload's record.
struct PartShape {
    bool is_there = true;                  ///< false: the condition `when` is not met
    const RecordLayout* record = nullptr;  ///< for a record and for records
    NumberType type = NumberType::u8;      ///< for numbers
    std::uint64_t count = 0;               ///< number of records, numbers or bytes; kTheRest
    std::uint64_t row = 1;                 ///< numbers per row

    /// Size in bytes of one record, one number, or one byte of text.
    [[nodiscard]] std::uint64_t unit() const { return record != nullptr ? record->size : size_of(type); }
};

/// \param payload  begins with the leaf's record; may be incomplete
/// \return nothing if the record gives a type, or a number of columns, that does not exist
std::optional<PartShape> shape_of(const LeafLayout& leaf, const LeafPart& part, Bytes payload);

/// A part in a payload. For an odd part only `offset` and `size` are meaningful.
struct LocatedPart {
    const LeafPart* part = nullptr;
    PartShape shape;           ///< its count is never kTheRest
    std::uint64_t offset = 0;  ///< bytes from the payload's start
    std::uint64_t size = 0;    ///< size in bytes without the padding
};

struct LocatedParts {
    std::vector<LocatedPart> list;
    std::uint64_t end = 0;  ///< end of the last part; any bytes after it belong to a later version, or are an error
    bool is_whole = true;   ///< false: the payload is too short for the part after the last one

    /// Returns the part with this name; nothing if it is not present.
    [[nodiscard]] const LocatedPart* find(std::string_view name) const;
};

/// Finds the parts that are present in a leaf. A part is always inside the payload, whatever the payload contains.
LocatedParts locate_parts(const LeafLayout& leaf, Bytes payload);

/// Returns the record at the start of the chunk's payload, or the element type if the payload is an array of records;
/// nothing if there is none.
const RecordLayout* layout_of(FourCC chunk);

/// Returns true if the payload is text: NAME, EXTR, EXTN, MORE, LINK.
bool is_text(FourCC chunk);

/// Returns true if the payload is a StreamRecord and its numbers.
bool is_stream(FourCC chunk);

}  // namespace bendy
