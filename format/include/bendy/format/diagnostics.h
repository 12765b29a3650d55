#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/format/error.h>
#include <bendy/format/public.h>

#include <cstdint>
#include <string>
#include <string_view>

// Words for people. The readers themselves carry no text.
namespace BENDY_PUBLIC bendy {

/// The fault's text with its numbers filled in, e.g. "the chunk's payload of 96 bytes does not fit the 48 bytes left in
/// its container".
std::string describe(const Error& error);

/// The path of the innermost chunk that holds `offset`, e.g. "HEAD/OBJE/SKIN/SKIN[1]/PIVO": [n] is the place among
/// siblings of the same id, counted from 0, and is left out where it is 0. Works on malformed files as far as their
/// headers can be trusted. Deep paths are shortened in the middle: "HEAD/OBJE/SKIN/... 9997 more .../SKIN/PIVO".
std::string chunk_path(Bytes bytes, std::uint64_t offset);

/// The same, with nothing left out: for programs, as find_path takes it. Up to kMaxDepth steps long.
std::string whole_chunk_path(Bytes bytes, std::uint64_t offset);

/// The chunk that a path names, or kNone. Accepts what chunk_path writes in full, and "@OFFSET" for the innermost chunk
/// at a byte offset.
std::uint32_t find_path(const ChunkTree& tree, std::string_view path);

/// "describe (path, offset N)", as the command line prints it.
std::string describe_with_place(const Error& error, Bytes bytes);

}  // namespace bendy
