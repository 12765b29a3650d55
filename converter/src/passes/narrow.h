#pragma once

#include <bendy/format/records.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bendy::converter {

/// Numbers in the type in which they will be stored.
struct StoredNumbers {
    ComponentType type = ComponentType::f32;
    bool normalised = false;
    std::vector<std::byte> bytes;
};

/// The narrowest of u8 and u16 (normalised, 0 to 1) that gives back every one of these floats to the bit; else f32.
StoredNumbers narrow_fractions(std::span<const float> values);

/// Indices as u8, if `count` of them need no more and `allow_bytes`, else u16 or u32.
StoredNumbers narrow_indices(std::span<const std::uint32_t> values, std::uint64_t count, bool allow_bytes);

}  // namespace bendy::converter
