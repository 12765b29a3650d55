#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/records.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace bendy::converter {

/// Numbers in the type in which they will be stored. Those that stay as they are are not copied: their source must live
/// as long as this.
struct StoredNumbers {
    StoredNumbers(ComponentType stored_as, bool fractions, Bytes as_they_are)
        : type(stored_as), normalised(fractions), bytes(as_they_are) {}
    StoredNumbers(ComponentType stored_as, bool fractions, std::vector<std::byte> made)
        : type(stored_as), normalised(fractions), own(std::move(made)), bytes(own) {}
    StoredNumbers(StoredNumbers&&) = default;  // a vector that moves keeps its bytes in their place
    StoredNumbers& operator=(StoredNumbers&&) = default;
    StoredNumbers(const StoredNumbers&) = delete;
    StoredNumbers& operator=(const StoredNumbers&) = delete;
    ~StoredNumbers() = default;

    ComponentType type;
    bool normalised;
    std::vector<std::byte> own;  ///< empty where they stay as they are
    Bytes bytes;
};

/// The narrowest of u8 and u16 (normalised, 0 to 1) that gives back every one of these floats to the bit; else f32.
StoredNumbers narrow_fractions(std::span<const float> values);

/// Indices as u8, if `count` of them need no more and `allow_bytes`, else u16 or u32.
StoredNumbers narrow_indices(std::span<const std::uint32_t> values, std::uint64_t count, bool allow_bytes);

}  // namespace bendy::converter
