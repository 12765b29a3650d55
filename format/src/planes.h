#pragma once

#include <bendy/format/byte_reader.h>

#include <algorithm>
#include <cstddef>
#include <span>

namespace bendy {

/// Bytes of numbers of `stride` bytes, plane by plane: all first bytes, then all second ones; what is left over at the
/// end stays as it is.
inline void to_planes(Bytes numbers, std::size_t stride, std::span<std::byte> planes) {
    const std::size_t count = numbers.size() / stride;
    for (std::size_t n = 0; n < count; ++n) {
        for (std::size_t b = 0; b < stride; ++b) planes[b * count + n] = numbers[n * stride + b];
    }
    std::copy(numbers.begin() + static_cast<std::ptrdiff_t>(count * stride), numbers.end(),
              planes.begin() + static_cast<std::ptrdiff_t>(count * stride));
}

inline void from_planes(Bytes planes, std::size_t stride, std::span<std::byte> numbers) {
    const std::size_t count = numbers.size() / stride;
    for (std::size_t b = 0; b < stride; ++b) {
        for (std::size_t n = 0; n < count; ++n) numbers[n * stride + b] = planes[b * count + n];
    }
    std::copy(planes.begin() + static_cast<std::ptrdiff_t>(count * stride), planes.end(),
              numbers.begin() + static_cast<std::ptrdiff_t>(count * stride));
}

}  // namespace bendy
