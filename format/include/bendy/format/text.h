#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/format/faults.h>
#include <bendy/format/public.h>

#include <string_view>

namespace BENDY_PUBLIC bendy {

/// True for well-formed UTF-8 (Unicode 15, table 3-7): no overlong forms, no surrogates, nothing past U+10FFFF.
bool is_utf8(std::string_view text);

/// The text of the leaf with this id among a container's children: NAME, EXTR, EXTN, MORE. Empty if there is none; text
/// that is not UTF-8 is a fault, and comes back empty too.
std::string_view read_text(const ChunkTree& tree, std::uint32_t container, FourCC id, Faults& faults);

}  // namespace bendy
