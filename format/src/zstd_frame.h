#pragma once

#include <bendy/format/byte_reader.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace bendy {

/// Appends the bytes as one zstd frame that states their number.
bool put_zstd(Bytes bytes, std::vector<std::byte>& out);

/// True if the bytes are one zstd frame of exactly out.size() bytes.
bool take_zstd(Bytes bytes, std::span<std::byte> out);

/// The number of bytes that the frame claims to hold; it may lie.
std::optional<std::uint64_t> zstd_size(Bytes bytes);

}  // namespace bendy
