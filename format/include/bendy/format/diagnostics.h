#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/format/error.h>
#include <bendy/format/public.h>

#include <cstdint>
#include <string>
#include <string_view>

// Texts for people. The readers themselves contain no texts.
namespace BENDY_PUBLIC bendy {

/// Returns the text of an error with its numbers filled in, e.g. "the chunk's payload of 96 bytes does not fit the 48
/// bytes left in its container".
std::string describe(const Error& error);

/// Returns the path of the innermost chunk that contains `offset`, e.g. "HEAD/OBJE/SKIN/SKIN[1]/PIVO": [n] is the index
/// among siblings of the same id, counted from 0, and is left out if it is 0. Works on malformed files as far as their
/// headers are valid. Deep paths are shortened in the middle: "HEAD/OBJE/SKIN/... 9997 more .../SKIN/PIVO".
std::string chunk_path(Bytes bytes, std::uint64_t offset);

/// As chunk_path, without shortening: for programs, as find_path accepts it. Up to kMaxDepth steps long.
std::string whole_chunk_path(Bytes bytes, std::uint64_t offset);

/// Returns the chunk that a path refers to, or kNone. Accepts unshortened paths of chunk_path, and "@OFFSET" for the
/// innermost chunk at a byte offset.
std::uint32_t find_path(const ChunkTree& tree, std::string_view path);

/// Returns "describe (path, offset N)", as the command line prints it.
std::string describe_with_place(const Error& error, Bytes bytes);

}  // namespace bendy
