#include "meshopt_vertices.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdint>
#include <vector>

namespace bendy::converter::gltf {
namespace {

constexpr std::size_t kGroup = 16;  // elements whose deltas are stored with one bit length
constexpr std::size_t kMaxBlock = 256;

/// Bytes of the stream, read from the front.
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

/// Sixteen deltas of `bits` bits each (0, 1, 2, 4 or 8); all ones means that the delta follows as a whole byte.
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
        // One-bit deltas fill a byte from its low end, the others from its high end.
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

/// The deltas of one byte position for all groups of a block.
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

/// What a delta makes of the four bytes before it (little-endian), by the channel's mode.
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

    // The stream ends with the element before the first, and in version 1 the channels' modes.
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

}  // namespace bendy::converter::gltf
