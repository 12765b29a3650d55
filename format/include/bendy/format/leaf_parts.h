#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/fourcc.h>
#include <bendy/format/public.h>
#include <bendy/format/record_table.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

// The table leaf_parts.def as data: what a leaf holds, part after part, and where the parts lie in a payload.
namespace BENDY_PUBLIC bendy {

enum class PartKind : std::uint8_t { record, records, numbers, text, names, bytes, odd };
enum class PartEnding : std::uint8_t { plain, padded };

/// A row of the table. The strings are as the table has them.
struct LeafPart {
    PartKind kind = PartKind::record;
    std::string_view name;
    std::string_view type;   ///< struct, number type, or field that says which
    std::string_view count;  ///< "2 * components", "rest"
    std::string_view when;   ///< "packed == 1", or empty
    std::string_view row;    ///< number or field
    PartEnding ending = PartEnding::plain;
    Entity each = Entity::nothing;  ///< a row, record or name belongs to each of these
    Entity to = Entity::nothing;    ///< each number refers to one of these
};

struct LeafLayout {
    FourCC chunk;
    std::span<const LeafPart> parts;

    /// The record at its start; nothing if it has none.
    [[nodiscard]] const RecordLayout* record() const;
};

/// Nothing for a container or an unknown chunk.
const LeafLayout* find_leaf(FourCC chunk);

/// Up to the payload's end.
inline constexpr std::uint64_t kTheRest = std::numeric_limits<std::uint64_t>::max();

/// What a part is in one payload, by the fields of the payload's record.
struct PartShape {
    bool is_there = true;                  ///< false: what the part's `when` asks for does not hold
    const RecordLayout* record = nullptr;  ///< of a record and of records
    NumberType type = NumberType::u8;      ///< of numbers
    std::uint64_t count = 0;               ///< records, numbers or bytes; kTheRest
    std::uint64_t row = 1;                 ///< numbers that belong together

    /// Bytes of one record, number, or byte of text.
    [[nodiscard]] std::uint64_t unit() const { return record != nullptr ? record->size : size_of(type); }
};

/// \param payload  begins with the leaf's record; all of it need not be there yet
/// \return nothing where the record says a type, or numbers per row, that do not exist
std::optional<PartShape> shape_of(const LeafLayout& leaf, const LeafPart& part, Bytes payload);

/// A part in a payload. Of an odd part only `offset` and `size` mean something.
struct LocatedPart {
    const LeafPart* part = nullptr;
    PartShape shape;           ///< its count is never kTheRest
    std::uint64_t offset = 0;  ///< bytes from the payload's start
    std::uint64_t size = 0;    ///< bytes, without those of the ending
};

struct LocatedParts {
    std::vector<LocatedPart> list;
    std::uint64_t end = 0;  ///< of the last one; later bytes are a later version's, or wrong
    bool is_whole = true;   ///< false: the payload is too short for the part behind the last one

    /// The part of this name; nothing if it is not there.
    [[nodiscard]] const LocatedPart* find(std::string_view name) const;
};

/// Where the parts of a leaf lie that are there. No payload, whatever it holds, gives a part outside it.
LocatedParts locate_parts(const LeafLayout& leaf, Bytes payload);

/// The record at the start of the chunk's payload, or of which the payload is an array; nothing if it has none.
const RecordLayout* layout_of(FourCC chunk);

/// The payload is text: NAME, EXTR, EXTN, MORE, LINK.
bool is_text(FourCC chunk);

/// The payload is a StreamRecord and its numbers.
bool is_stream(FourCC chunk);

}  // namespace bendy
