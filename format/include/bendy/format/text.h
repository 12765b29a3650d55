#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/format/error.h>
#include <bendy/format/public.h>

#include <cstddef>
#include <string_view>

namespace BENDY_PUBLIC bendy {

/// Returns true for well-formed UTF-8 (Unicode 15, table 3-7): no overlong forms, no surrogates, nothing above
/// U+10FFFF.
bool is_utf8(std::string_view text);

/// Returns the position of the first control character (U+0000 to U+001F, U+007F to U+009F) in UTF-8; npos if there is
/// none.
std::size_t find_control(std::string_view text);

/// Returns the text of a container's child leaf with this id: NAME, EXTR, EXTN, MORE. Empty if there is none; for text
/// that is not UTF-8, adds a fault and returns an empty text.
std::string_view read_text(const ChunkTree& tree, std::uint32_t container, FourCC id, Faults& faults);

}  // namespace bendy
