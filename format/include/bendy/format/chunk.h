#pragma once

#include <bendy/format/public.h>

#include <array>
#include <cstdint>

// The grammar of the format: a chunk is a 16-byte header and a payload, and starts on a 16-byte boundary.
//
//     u32 id         four letters, in reading order
//     u32 sum        CRC-32C: see chunk_reader.h
//     u64 size+flags low 48 bits: size of the payload in bytes, including children and their padding, but not the
//                    chunk's own padding; high 16 bits: flags
namespace BENDY_PUBLIC bendy {

/// A chunk id: four capital letters or digits, stored in reading order (the first letter is the first byte in the
/// file).
struct FourCC {
    std::uint32_t value = 0;

    constexpr FourCC() = default;
    constexpr explicit FourCC(std::uint32_t raw) : value(raw) {}
    consteval explicit FourCC(const char (&letters)[5])
        : value(static_cast<std::uint32_t>(letters[0]) | static_cast<std::uint32_t>(letters[1]) << 8 |
                static_cast<std::uint32_t>(letters[2]) << 16 | static_cast<std::uint32_t>(letters[3]) << 24) {}

    friend constexpr bool operator==(FourCC, FourCC) = default;

    /// Returns true if all four bytes are 'A'..'Z' or '0'..'9'.
    [[nodiscard]] constexpr bool is_readable() const {
        for (unsigned shift = 0; shift < 32; shift += 8) {
            const std::uint32_t letter = value >> shift & 0xffu;
            if (!((letter >= 'A' && letter <= 'Z') || (letter >= '0' && letter <= '9'))) return false;
        }
        return true;
    }

    /// Returns the letters, zero-terminated; bytes that are not printable ASCII become '?'.
    [[nodiscard]] constexpr std::array<char, 5> letters() const {
        std::array<char, 5> text{};
        for (unsigned i = 0; i < 4; ++i) {
            const std::uint32_t letter = value >> (8 * i) & 0xffu;
            text[i] = letter > 0x20 && letter < 0x7f ? static_cast<char>(letter) : '?';
        }
        return text;
    }
};

inline constexpr std::uint64_t kChunkHeaderSize = 16;
inline constexpr std::uint64_t kChunkAlignment = 16;

/// The high 16 bits of size+flags.
enum ChunkFlag : std::uint16_t {
    kContainerFlag = 1u << 0,  ///< the payload consists of chunks only
    kRequiredFlag = 1u << 1,   ///< a reader that does not know this id must reject the file
    kReservedFlags = 0x00fcu,  ///< must be zero
    kCodecMask = 0xff00u,      ///< encoding of a leaf's payload: see codec.h
};

/// A chunk's header and its position in the tree.
struct Chunk {
    FourCC id;
    std::uint32_t sum = 0;
    std::uint64_t offset = 0;  ///< of the header: bytes from the start of the file
    std::uint64_t size = 0;    ///< payload bytes
    std::uint32_t parent = 0;  ///< number of the containing chunk; for the root its own
    std::uint32_t end = 0;     ///< number of the first chunk after the subtree
    std::uint16_t flags = 0;

    [[nodiscard]] bool is_container() const { return (flags & kContainerFlag) != 0; }
    [[nodiscard]] bool is_required() const { return (flags & kRequiredFlag) != 0; }
    [[nodiscard]] unsigned codec() const { return static_cast<unsigned>(flags & kCodecMask) >> 8; }
    [[nodiscard]] std::uint64_t payload_offset() const { return offset + kChunkHeaderSize; }
};

inline constexpr std::uint64_t kChunkSumAt = 4;   ///< offset in a header
inline constexpr std::uint64_t kChunkSizeAt = 8;  ///< offset of size and flags in a header

/// Returns `size` rounded up to the next chunk boundary. size <= 2^48, so this cannot overflow.
constexpr std::uint64_t padded(std::uint64_t size) {
    return (size + (kChunkAlignment - 1)) & ~(kChunkAlignment - 1);
}

/// Returns the third field of a header.
constexpr std::uint64_t pack_size_and_flags(std::uint64_t size, std::uint16_t flags) {
    return size | static_cast<std::uint64_t>(flags) << 48;
}

}  // namespace bendy
