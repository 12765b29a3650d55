#pragma once

#include <bendy/format/public.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

// The only place where bytes become numbers. Files are little-endian, as are all supported machines; a port to a
// big-endian machine would swap bytes here and nowhere else.
namespace BENDY_PUBLIC bendy {

static_assert(std::endian::native == std::endian::little,
              "bendy files are used in place, which needs a little-endian machine");

using Bytes = std::span<const std::byte>;

/// Copies a number or a standard-layout record from `offset`. If `bytes` ends early, the rest of `value` is unchanged,
/// so that fields which an older writer did not know keep their defaults.
template <class T>
requires std::is_trivially_copyable_v<T>
void copy_at(Bytes bytes, std::uint64_t offset, T& value) {
    if (offset >= bytes.size()) return;
    const std::uint64_t left = bytes.size() - offset;
    if (left >= sizeof(T)) {
        std::memcpy(&value, bytes.data() + offset, sizeof(T));  // of a fixed size: one instruction
    } else {
        std::memcpy(&value, bytes.data() + offset, static_cast<std::size_t>(left));
    }
}

/// Returns `count` values of T at `offset` in place, or an empty span if they do not fit: the result is always inside
/// `bytes`. The bytes must be aligned for T, as every payload of an aligned file is.
template <class T>
requires std::is_trivially_copyable_v<T> std::span<const T> view_at(Bytes bytes, std::uint64_t offset,
                                                                    std::uint64_t count) {
    if (offset > bytes.size() || count > (bytes.size() - offset) / sizeof(T)) return {};
    return {reinterpret_cast<const T*>(bytes.data() + offset),
            static_cast<std::size_t>(count)};  // NOLINT(*-reinterpret-cast)
}

/// Returns the bytes as characters.
inline std::string_view as_text(Bytes bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};  // NOLINT(*-reinterpret-cast)
}

/// Returns the characters as bytes.
inline Bytes as_byte_span(std::string_view text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

}  // namespace bendy
