#include "meshopt_filters.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace bendy::converter::gltf {
namespace {

/// Nearest integer, halves away from zero; what does not fit (a malformed element) goes to the nearest end.
template <class T>
T to_integer(double value) {
    const double low = std::numeric_limits<T>::min();
    const double high = std::numeric_limits<T>::max();
    return std::isnan(value) ? T{0} : static_cast<T>(std::clamp(std::round(value), low, high));
}

template <class T, class Decode>
void for_each_element(std::span<std::byte> bytes, const Decode& decode) {
    std::array<T, 4> element{};
    for (std::size_t at = 0; at + sizeof element <= bytes.size(); at += sizeof element) {
        std::memcpy(element.data(), bytes.data() + at, sizeof element);
        decode(element);
        std::memcpy(bytes.data() + at, element.data(), sizeof element);
    }
}

template <class T>
void decode_octahedral_as(std::span<std::byte> bytes) {
    for_each_element<T>(bytes, [](std::array<T, 4>& element) {
        const double one = element[2];
        double x = element[0] / one;
        double y = element[1] / one;
        double z = 1.0 - std::abs(x) - std::abs(y);
        const double fold = std::min(z, 0.0);  // the lower half is folded over the diamond's edges
        x -= std::copysign(fold, x);
        y -= std::copysign(fold, y);
        const double scale = std::numeric_limits<T>::max() / std::sqrt(x * x + y * y + z * z);
        element[0] = to_integer<T>(x * scale);
        element[1] = to_integer<T>(y * scale);
        element[2] = to_integer<T>(z * scale);
    });
}

template <class T>
void decode_colour_as(std::span<std::byte> bytes) {
    const auto as_signed = [](T value) {
        constexpr int kHalf = 1 << (8 * sizeof(T) - 1);
        return (int{value} ^ kHalf) - kHalf;
    };
    for_each_element<T>(bytes, [&](std::array<T, 4>& element) {
        const int top = std::bit_width(element[3]);  // K: the highest bit of alpha marks it
        const int range = (1 << top) - 1;
        const int luma = element[0];
        const int orange = as_signed(element[1]);
        const int green = as_signed(element[2]);
        int alpha = element[3] & (range >> 1);
        alpha = alpha << 1 | (alpha & 1);
        const double scale = std::numeric_limits<T>::max() / static_cast<double>(range);
        element = {to_integer<T>((luma + orange - green) * scale), to_integer<T>((luma + green) * scale),
                   to_integer<T>((luma - orange - green) * scale), to_integer<T>(alpha * scale)};
    });
}

}  // namespace

void decode_octahedral(std::span<std::byte> bytes, std::size_t stride) {
    stride == 4 ? decode_octahedral_as<std::int8_t>(bytes) : decode_octahedral_as<std::int16_t>(bytes);
}

void decode_quaternion(std::span<std::byte> bytes) {
    for_each_element<std::int16_t>(bytes, [](std::array<std::int16_t, 4>& element) {
        const double one = element[3] | 3;
        const auto largest = static_cast<std::size_t>(element[3] & 3);
        const double range = std::sqrt(0.5) / one;
        const double x = element[0] * range;
        const double y = element[1] * range;
        const double z = element[2] * range;
        const double w = std::sqrt(std::max(0.0, 1.0 - x * x - y * y - z * z));
        element[(largest + 1) % 4] = to_integer<std::int16_t>(x * 32767.0);
        element[(largest + 2) % 4] = to_integer<std::int16_t>(y * 32767.0);
        element[(largest + 3) % 4] = to_integer<std::int16_t>(z * 32767.0);
        element[largest] = to_integer<std::int16_t>(w * 32767.0);
    });
}

void decode_exponential(std::span<std::byte> bytes) {
    for (std::size_t at = 0; at + 4 <= bytes.size(); at += 4) {
        std::int32_t word = 0;
        std::memcpy(&word, bytes.data() + at, sizeof word);
        const int exponent = word >> 24;
        const std::int32_t mantissa = static_cast<std::int32_t>(static_cast<std::uint32_t>(word) << 8) >> 8;
        const auto value = static_cast<float>(std::ldexp(static_cast<double>(mantissa), exponent));
        std::memcpy(bytes.data() + at, &value, sizeof value);
    }
}

void decode_colour(std::span<std::byte> bytes, std::size_t stride) {
    stride == 4 ? decode_colour_as<std::uint8_t>(bytes) : decode_colour_as<std::uint16_t>(bytes);
}

}  // namespace bendy::converter::gltf
