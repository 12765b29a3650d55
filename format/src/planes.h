#pragma once

#include <bendy/format/byte_reader.h>

#include <algorithm>
#include <cstddef>
#include <span>

namespace bendy {

/// Splits numbers of `stride` bytes into byte planes: all first bytes, then all second ones; the remainder at the end
/// is unchanged.
inline void to_planes(Bytes numbers, std::size_t stride, std::span<std::byte> planes) {
    const std::size_t count = numbers.size() / stride;
    for (std::size_t n = 0; n < count; ++n) {
        for (std::size_t b = 0; b < stride; ++b) planes[b * count + n] = numbers[n * stride + b];
    }
    std::copy(numbers.begin() + static_cast<std::ptrdiff_t>(count * stride), numbers.end(),
              planes.begin() + static_cast<std::ptrdiff_t>(count * stride));
}

/// Restores numbers from planes. The width is a compile-time constant, so the compiler can use shuffles.
template <std::size_t Stride>
void interleave(const std::byte* planes, std::size_t count, std::byte* numbers) {
    for (std::size_t n = 0; n < count; ++n) {
        for (std::size_t b = 0; b < Stride; ++b) numbers[n * Stride + b] = planes[b * count + n];
    }
}

inline void from_planes(Bytes planes, std::size_t stride, std::span<std::byte> numbers) {
    const std::size_t count = numbers.size() / stride;
    if (stride == 2) {
        interleave<2>(planes.data(), count, numbers.data());
    } else if (stride == 4) {
        interleave<4>(planes.data(), count, numbers.data());
    } else if (stride == 8) {
        interleave<8>(planes.data(), count, numbers.data());
    } else {
        for (std::size_t n = 0; n < count; ++n) {
            for (std::size_t b = 0; b < stride; ++b) numbers[n * stride + b] = planes[b * count + n];
        }
    }
    std::copy(planes.begin() + static_cast<std::ptrdiff_t>(count * stride), planes.end(),
              numbers.begin() + static_cast<std::ptrdiff_t>(count * stride));
}

}  // namespace bendy
