#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace bendy::converter::md2 {

/// What a Quake II model's first 68 bytes say, little-endian. Offsets count from the file's start.
struct Header {
    std::uint32_t skin_width = 0;  ///< pixels
    std::uint32_t skin_height = 0;
    std::uint32_t frame_size = 0;  ///< bytes of a frame
    std::uint32_t skins = 0;
    std::uint32_t vertices = 0;
    std::uint32_t coords = 0;
    std::uint32_t triangles = 0;
    std::uint32_t commands = 0;  ///< words of a list of strips and fans, which says nothing new
    std::uint32_t frames = 0;
    std::uint32_t skins_at = 0;
    std::uint32_t coords_at = 0;
    std::uint32_t triangles_at = 0;
    std::uint32_t frames_at = 0;
    std::uint32_t commands_at = 0;
    std::uint32_t end = 0;
};

inline constexpr std::size_t kHeaderSize = 68;
inline constexpr std::size_t kSkinSize = 64;       ///< a file name, zero at its end
inline constexpr std::size_t kCoordSize = 4;       ///< s and t in pixels, 16 bits each
inline constexpr std::size_t kTriangleSize = 12;   ///< three vertices, three texture coordinates, 16 bits each
inline constexpr std::size_t kFrameHeadSize = 40;  ///< scale, origin, a name of 16 bytes
inline constexpr std::size_t kVertexSize = 4;      ///< a byte for each axis, and a normal's number

std::string place_of(std::size_t byte);

/// Reads the header and checks that all that it says lies in the file. Fails at `byte 40`.
Header read_header(std::span<const std::byte> file);

/// Of at most 4 bytes, inside the file.
std::uint32_t read_integer(std::span<const std::byte> file, std::size_t at, std::size_t size);
/// Fails where it is not finite.
float read_float(std::span<const std::byte> file, std::size_t at);
/// A text of `size` bytes at most, up to its first zero, as UTF-8.
std::string read_name(std::span<const std::byte> file, std::size_t at, std::size_t size);

}  // namespace bendy::converter::md2
