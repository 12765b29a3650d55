#include "passes/narrow.h"

#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace bendy::converter {
namespace {

template <class T>
void append(std::vector<std::byte>& bytes, T value) {
    const auto pieces = std::bit_cast<std::array<std::byte, sizeof(T)>>(value);
    bytes.insert(bytes.end(), pieces.begin(), pieces.end());
}

template <class T>
std::vector<std::byte> as_integers(std::span<const std::uint32_t> values) {
    std::vector<std::byte> bytes;
    bytes.reserve(values.size() * sizeof(T));
    for (const std::uint32_t value : values) append(bytes, static_cast<T>(value));
    return bytes;
}

/// Fills `bytes` and is true if every value is a whole number of 1 / largest(T).
template <class T>
bool as_fractions(std::span<const float> values, std::vector<std::byte>& bytes) {
    constexpr float kLargest = std::numeric_limits<T>::max();
    bytes.clear();
    bytes.reserve(values.size() * sizeof(T));
    for (const float value : values) {
        if (!(value >= 0.0f && value <= 1.0f)) return false;
        const auto steps = static_cast<T>(std::lround(value * kLargest));
        if (std::bit_cast<std::uint32_t>(static_cast<float>(steps) / kLargest) != std::bit_cast<std::uint32_t>(value))
            return false;
        append(bytes, steps);
    }
    return true;
}

}  // namespace

StoredNumbers narrow_fractions(std::span<const float> values) {
    std::vector<std::byte> bytes;
    if (as_fractions<std::uint8_t>(values, bytes)) return {ComponentType::u8, true, std::move(bytes)};
    if (as_fractions<std::uint16_t>(values, bytes)) return {ComponentType::u16, true, std::move(bytes)};
    return {ComponentType::f32, false, std::as_bytes(values)};
}

StoredNumbers narrow_indices(std::span<const std::uint32_t> values, std::uint64_t count, bool allow_bytes) {
    if (allow_bytes && count <= 0x100) return {ComponentType::u8, false, as_integers<std::uint8_t>(values)};
    if (count <= 0x10000) return {ComponentType::u16, false, as_integers<std::uint16_t>(values)};
    return {ComponentType::u32, false, std::as_bytes(values)};
}

}  // namespace bendy::converter
