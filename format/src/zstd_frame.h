#pragma once

#include <bendy/format/byte_reader.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace bendy {

/// Appends the bytes as one zstd frame that states their size.
bool put_zstd(Bytes bytes, std::vector<std::byte>& out);

/// Decompresses; returns false unless the bytes are one zstd frame of exactly out.size() bytes.
bool take_zstd(Bytes bytes, std::span<std::byte> out);

/// Returns the size that the frame claims to have; it may be wrong.
std::optional<std::uint64_t> zstd_size(Bytes bytes);

}  // namespace bendy
