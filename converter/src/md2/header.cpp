#include "header.h"

#include "failure.h"
#include "x/encoded_text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string_view>

namespace bendy::converter::md2 {
namespace {

constexpr std::uint32_t kVersion = 8;

/// A list that the header speaks of.
struct List {
    const char* what;
    std::uint32_t count;
    std::size_t size;      ///< bytes of an element
    std::uint32_t begin;   ///< byte
    std::size_t count_at;  ///< byte of the header's field
    std::size_t begin_at;
};

void check(const List& list, std::size_t file_size) {
    if (list.begin > file_size) {
        fail(place_of(list.begin_at), std::string("offset of ") + list.what + ": " + std::to_string(list.begin) +
                                          " is past the end of the file");
    }
    if (list.count > (file_size - list.begin) / list.size) {
        fail(place_of(list.count_at), "number of " + std::string(list.what) + ": " + std::to_string(list.count) +
                                          " do not fit between byte " + std::to_string(list.begin) +
                                          " and the end of the file");
    }
}

}  // namespace

std::string place_of(std::size_t byte) {
    return "byte " + std::to_string(byte);
}

std::uint32_t read_integer(std::span<const std::byte> file, std::size_t at, std::size_t size) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value |= std::to_integer<std::uint32_t>(file[at + i]) << (8 * i);
    return value;
}

float read_float(std::span<const std::byte> file, std::size_t at) {
    const auto value = std::bit_cast<float>(read_integer(file, at, 4));
    if (!std::isfinite(value)) fail(place_of(at), "the number is not finite");
    return value;
}

std::string read_name(std::span<const std::byte> file, std::size_t at, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(file.data()) + at, size);
    return x::to_utf8(text.substr(0, text.find('\0')));
}

Header read_header(std::span<const std::byte> file) {
    if (file.size() < 4 || read_integer(file, 0, 4) != 0x32504449)  // "IDP2"
        fail(place_of(0), "this is no Quake II model: it does not begin with 'IDP2'");
    if (file.size() < kHeaderSize) fail(place_of(file.size()), "the header is truncated: 68 bytes are due");
    if (const std::uint32_t version = read_integer(file, 4, 4); version != kVersion)
        fail(place_of(4), "version " + std::to_string(version) + " is not known, only version 8 (Quake II)");
    Header header;
    const std::array fields{&header.skin_width, &header.skin_height, &header.frame_size, &header.skins,
                            &header.vertices,   &header.coords,      &header.triangles,  &header.commands,
                            &header.frames,     &header.skins_at,    &header.coords_at,  &header.triangles_at,
                            &header.frames_at,  &header.commands_at, &header.end};
    for (std::size_t i = 0; i < fields.size(); ++i) *fields[i] = read_integer(file, 8 + 4 * i, 4);

    if (header.end > file.size()) {
        fail(place_of(64), "the file is truncated: its header says " + std::to_string(header.end) + " bytes, it has " +
                               std::to_string(file.size()));
    }
    const std::uint64_t frame_size = kFrameHeadSize + std::uint64_t{header.vertices} * kVertexSize;
    if (header.frame_size < frame_size) {
        fail(place_of(16), "a frame of " + std::to_string(header.vertices) + " vertices takes " +
                               std::to_string(frame_size) + " bytes, the header says " +
                               std::to_string(header.frame_size));
    }
    for (const List& list : {List{"skins", header.skins, kSkinSize, header.skins_at, 20, 44},
                             List{"texture coordinates", header.coords, kCoordSize, header.coords_at, 28, 48},
                             List{"triangles", header.triangles, kTriangleSize, header.triangles_at, 32, 52},
                             List{"frames", header.frames, header.frame_size, header.frames_at, 40, 56},
                             List{"GL commands", header.commands, 4, header.commands_at, 36, 60}})
        check(list, file.size());
    if (header.frames == 0) fail(place_of(40), "there are no frames");
    if (header.triangles == 0) fail(place_of(32), "there are no triangles");
    if (header.skin_width == 0 || header.skin_height == 0)
        fail(place_of(header.skin_width == 0 ? 8 : 12), "the skin has no size: texture coordinates mean nothing");
    return header;
}

}  // namespace bendy::converter::md2
