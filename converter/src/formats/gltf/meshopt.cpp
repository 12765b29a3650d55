#include "meshopt.h"

#include "scene/failure.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace bendy::converter::gltf {
namespace {

/// Nearest integer, halves away from zero; out-of-range values (of malformed elements) are clamped.
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
        const double fold = std::min(z, 0.0);  // the lower half is folded over the edges
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
        const int top = std::bit_width(element[3]);  // K: marked by the highest bit of alpha
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

namespace {

constexpr std::size_t kGroup = 16;  // elements whose deltas share one bit length
constexpr std::size_t kMaxBlock = 256;

/// The stream's bytes, read from the front.
class Cursor {
public:
    explicit Cursor(std::span<const std::byte> bytes) : bytes_(bytes) {}

    /// False if fewer than `count` remain.
    bool take(std::size_t count, std::span<const std::byte>& taken) {
        if (count > bytes_.size()) return false;
        taken = bytes_.first(count);
        bytes_ = bytes_.subspan(count);
        return true;
    }

    [[nodiscard]] std::size_t remaining() const { return bytes_.size(); }

private:
    std::span<const std::byte> bytes_;
};

std::uint8_t byte_at(std::span<const std::byte> bytes, std::size_t i) {
    return std::to_integer<std::uint8_t>(bytes[i]);
}

/// Decodes sixteen deltas of `bits` bits each (0, 1, 2, 4 or 8); all ones means that the delta follows as a whole byte.
bool decode_group(Cursor& cursor, unsigned bits, std::span<std::uint8_t> deltas) {
    std::span<const std::byte> packed;
    if (!cursor.take(kGroup * bits / 8, packed)) return false;
    if (bits == 0) {
        std::fill(deltas.begin(), deltas.end(), std::uint8_t{0});
        return true;
    }
    if (bits == 8) {
        for (std::size_t i = 0; i < kGroup; ++i) deltas[i] = byte_at(packed, i);
        return true;
    }
    const unsigned sentinel = (1u << bits) - 1;
    for (std::size_t i = 0; i < kGroup; ++i) {
        const unsigned position = static_cast<unsigned>(i) * bits % 8;
        // One-bit deltas fill a byte from its low end, others from its high end.
        const unsigned shift = bits == 1 ? position : 8 - bits - position;
        const unsigned value = byte_at(packed, i * bits / 8) >> shift & sentinel;
        if (value != sentinel) {
            deltas[i] = static_cast<std::uint8_t>(value);
            continue;
        }
        std::span<const std::byte> whole;
        if (!cursor.take(1, whole)) return false;
        deltas[i] = byte_at(whole, 0);
    }
    return true;
}

/// Decodes the deltas of one byte position for all groups of a block.
bool decode_column(Cursor& cursor, const std::array<unsigned, 4>& bit_lengths, std::span<std::uint8_t> deltas) {
    const std::size_t groups = deltas.size() / kGroup;
    std::span<const std::byte> header;
    if (!cursor.take((groups + 3) / 4, header)) return false;
    for (std::size_t g = 0; g < groups; ++g) {
        const unsigned mode = byte_at(header, g / 4) >> (g % 4 * 2) & 3u;
        if (!decode_group(cursor, bit_lengths[mode], deltas.subspan(g * kGroup, kGroup))) return false;
    }
    return true;
}

/// Applies a delta to the previous four bytes (little-endian), by the channel's mode.
std::uint32_t apply_delta(std::uint32_t before, std::uint32_t delta, unsigned mode, int rotation) {
    if (mode == 2) return before ^ std::rotr(delta, rotation);
    std::uint32_t value = 0;
    const unsigned width = mode == 0 ? 8 : 16;
    for (unsigned shift = 0; shift < 32; shift += width) {
        const std::uint32_t mask = (1u << width) - 1;
        const std::uint32_t part = delta >> shift & mask;
        const std::uint32_t step = (part & 1u) != 0 ? ~(part >> 1) : part >> 1;
        value |= (((before >> shift) + step) & mask) << shift;
    }
    return value;
}

}  // namespace

bool decode_meshopt_vertices(std::span<const std::byte> stream, std::size_t stride, std::span<std::byte> out) {
    assert(stride > 0 && stride % 4 == 0 && stride <= 256 && out.size() % stride == 0);
    if (stream.empty()) return false;
    const unsigned header = byte_at(stream, 0);
    if (header != 0xa0 && header != 0xa1) return false;
    const bool has_modes = header == 0xa1;
    const std::size_t channels = stride / 4;

    // The stream ends with the element before the first one and, in version 1, the channels' modes.
    const std::size_t tail = stride + (has_modes ? channels : 0);
    const std::size_t padded_tail = std::max<std::size_t>(tail, has_modes ? 24 : 32);
    if (stream.size() - 1 < padded_tail) return false;
    const auto baseline = stream.subspan(stream.size() - tail, stride);
    std::vector<std::uint32_t> last(channels);
    std::vector<std::uint8_t> modes(channels);
    for (std::size_t c = 0; c < channels; ++c) {
        for (unsigned b = 0; b < 4; ++b) last[c] |= std::uint32_t{byte_at(baseline, c * 4 + b)} << (8 * b);
        if (has_modes) modes[c] = byte_at(stream, stream.size() - channels + c);
        const unsigned mode = modes[c] & 0xfu;
        if (mode > 2 || (mode < 2 && modes[c] > 0xf)) return false;
    }

    Cursor cursor(stream.subspan(1, stream.size() - 1 - padded_tail));
    const std::size_t block_limit = std::min(8192 / stride / kGroup * kGroup, kMaxBlock);
    std::vector<std::uint8_t> deltas(stride * kMaxBlock);  // column by column
    for (std::size_t remaining = out.size() / stride; remaining > 0;) {
        const std::size_t block = std::min(remaining, block_limit);
        const std::size_t rounded = (block + kGroup - 1) / kGroup * kGroup;
        std::span<const std::byte> control;
        if (has_modes && !cursor.take(channels, control)) return false;
        for (std::size_t k = 0; k < stride; ++k) {
            const auto column = std::span(deltas).subspan(k * kMaxBlock, rounded);
            const unsigned mode = has_modes ? byte_at(control, k / 4) >> (k % 4 * 2) & 3u : 4;
            if (mode == 2) {
                std::fill(column.begin(), column.end(), std::uint8_t{0});
            } else if (mode == 3) {
                std::span<const std::byte> literal;
                if (!cursor.take(block, literal)) return false;
                for (std::size_t i = 0; i < block; ++i) column[i] = byte_at(literal, i);
            } else {
                constexpr std::array<std::array<unsigned, 4>, 5> kBitLengths = {
                    {{0, 1, 2, 4}, {1, 2, 4, 8}, {}, {}, {0, 2, 4, 8}}};
                if (!decode_column(cursor, kBitLengths[mode], column)) return false;
            }
        }
        for (std::size_t i = 0; i < block; ++i) {
            for (std::size_t c = 0; c < channels; ++c) {
                std::uint32_t delta = 0;
                for (unsigned b = 0; b < 4; ++b) {
                    delta |= std::uint32_t{deltas[(c * 4 + b) * kMaxBlock + i]} << (8 * b);
                }
                last[c] = apply_delta(last[c], delta, modes[c] & 0xfu, modes[c] >> 4);
                for (unsigned b = 0; b < 4; ++b) {
                    out[i * stride + c * 4 + b] = static_cast<std::byte>(last[c] >> (8 * b) & 0xffu);
                }
            }
        }
        out = out.subspan(block * stride);
        remaining -= block;
    }
    return cursor.remaining() == 0;
}

namespace {

// Upper limit on decoded bytes per encoded byte: the vertex codec spends as little as 2 bits on a run of 256 equal
// bytes (4 bytes in version 0), the index codecs one byte on a triangle (12 bytes) or an index (4).
constexpr std::uint64_t kMaxRatio = 1024;

void decode_attributes(const CompressedView& view, std::span<const std::byte> source, std::vector<std::byte>& out) {
    if (view.stride % 4 != 0) fail(view.place + ".byteStride", "mode ATTRIBUTES demands a multiple of 4");
    const bool is_four_or_eight = view.stride == 4 || view.stride == 8;
    if (!decode_meshopt_vertices(source, view.stride, out)) {
        fail(view.place, "the compressed attribute data is malformed");
    }
    if (view.filter == "OCTAHEDRAL") {
        if (!is_four_or_eight) fail(view.place, "filter OCTAHEDRAL demands a byteStride of 4 or 8");
        decode_octahedral(out, view.stride);
    } else if (view.filter == "QUATERNION") {
        if (view.stride != 8) fail(view.place, "filter QUATERNION demands a byteStride of 8");
        decode_quaternion(out);
    } else if (view.filter == "EXPONENTIAL") {
        decode_exponential(out);
    } else if (view.filter == "COLOR") {
        if (!is_four_or_eight) fail(view.place, "filter COLOR demands a byteStride of 4 or 8");
        decode_colour(out, view.stride);
    }
}

void decode_indices(const CompressedView& view, std::span<const std::byte> source, std::vector<std::byte>& out) {
    if (view.stride != 2 && view.stride != 4) fail(view.place + ".byteStride", "indices have 2 or 4 bytes");
    if (view.filter != "NONE") fail(view.place + ".filter", "filters are for mode ATTRIBUTES");
    const auto* bytes = reinterpret_cast<const unsigned char*>(source.data());
    int status = 0;
    if (view.mode == "TRIANGLES") {
        if (view.count % 3 != 0) fail(view.place + ".count", "mode TRIANGLES demands a multiple of 3");
        status = meshopt_decodeIndexBuffer(out.data(), view.count, view.stride, bytes, source.size());
    } else {
        status = meshopt_decodeIndexSequence(out.data(), view.count, view.stride, bytes, source.size());
    }
    if (status != 0) fail(view.place, "the compressed index data is malformed");
}

}  // namespace

std::vector<std::byte> decode_meshopt(const CompressedView& view, std::span<const std::byte> source, Budget& budget) {
    const std::uint64_t size = std::uint64_t{view.count} * view.stride;
    if (size / kMaxRatio > source.size()) {
        fail(view.place, std::to_string(source.size()) + " compressed bytes cannot hold " + std::to_string(size));
    }
    budget.take(size, 1, view.place);
    std::vector<std::byte> out(static_cast<std::size_t>(size));
    if (view.mode == "ATTRIBUTES") {
        decode_attributes(view, source, out);
    } else {
        decode_indices(view, source, out);
    }
    return out;
}

}  // namespace bendy::converter::gltf
