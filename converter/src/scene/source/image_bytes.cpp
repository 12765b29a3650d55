#include "scene/source/image_bytes.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace bendy::converter {

std::span<const ImageKind> image_kinds() {
    static constexpr std::array<ImageKind, 10> kKinds{{{"image/png", ".png"},
                                                       {"image/jpeg", ".jpg"},
                                                       {"image/ktx2", ".ktx2"},
                                                       {"image/webp", ".webp"},
                                                       {"image/avif", ".avif"},
                                                       {"image/gif", ".gif"},
                                                       {"image/bmp", ".bmp"},
                                                       {"image/vnd-ms.dds", ".dds"},
                                                       {"", ".tga"},
                                                       {"image/jpeg", ".jpeg"}}};
    return kKinds;
}

std::string media_type_of(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const auto starts = [&](std::string_view magic, std::size_t offset = 0) {
        return text.size() >= offset + magic.size() && text.substr(offset, magic.size()) == magic;
    };
    if (starts("\x89PNG\r\n\x1a\n")) return "image/png";
    if (starts("\xff\xd8\xff")) return "image/jpeg";
    if (starts("\xabKTX 20\xbb\r\n\x1a\n")) return "image/ktx2";
    if (starts("RIFF") && starts("WEBP", 8)) return "image/webp";
    if (starts("ftypavif", 4) || starts("ftypavis", 4)) return "image/avif";
    if (starts("GIF8")) return "image/gif";
    if (starts("BM")) return "image/bmp";
    if (starts("DDS ")) return "image/vnd-ms.dds";
    return {};
}

bool may_be_tga(std::span<const std::byte> bytes) {
    constexpr std::size_t kHeader = 18;
    if (bytes.size() <= kHeader) return false;
    const auto at = [&](std::size_t place) { return std::to_integer<unsigned>(bytes[place]); };
    const unsigned kind = at(2) & ~8u;  // 8: run-length encoded
    const unsigned depth = at(16);
    return at(1) <= 1 && kind >= 1 && kind <= 3 && (at(1) == 1) == (kind == 1) && at(12) + at(13) > 0 &&
           at(14) + at(15) > 0 && (depth == 8 || depth == 15 || depth == 16 || depth == 24 || depth == 32);
}

bool is_image(std::span<const std::byte> bytes) {
    return !media_type_of(bytes).empty() || may_be_tga(bytes);
}

namespace {

using Pixels = std::span<const std::byte>;

std::uint32_t byte_at(Pixels bytes, std::size_t at) {
    return std::to_integer<std::uint32_t>(bytes[at]);
}

std::uint32_t big_endian16(Pixels bytes, std::size_t at) {
    return byte_at(bytes, at) << 8U | byte_at(bytes, at + 1);
}

std::optional<std::uint32_t> png_side(Pixels bytes) {
    constexpr std::size_t kWidthAt = 16;
    if (bytes.size() < kWidthAt + 8) return std::nullopt;
    const auto number = [&](std::size_t at) { return big_endian16(bytes, at) << 16U | big_endian16(bytes, at + 2); };
    return std::max(number(kWidthAt), number(kWidthAt + 4));
}

/// Walks the segments up to the frame header.
std::optional<std::uint32_t> jpeg_side(Pixels bytes) {
    for (std::size_t at = 2; bytes.size() - at >= 9;) {
        if (byte_at(bytes, at) != 0xff) return std::nullopt;
        const std::uint32_t marker = byte_at(bytes, at + 1);
        const bool is_frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        if (is_frame) return std::max(big_endian16(bytes, at + 5), big_endian16(bytes, at + 7));
        const std::size_t length = big_endian16(bytes, at + 2);
        if (length < 2 || length + 2 > bytes.size() - at) return std::nullopt;
        at += length + 2;
    }
    return std::nullopt;
}

}  // namespace

std::optional<std::uint32_t> longer_side(const Image& image) {
    const Pixels bytes(image.bytes);
    if (bytes.size() < 16) return std::nullopt;
    if (byte_at(bytes, 0) == 0x89 && byte_at(bytes, 1) == 'P') return png_side(bytes);
    if (byte_at(bytes, 0) == 0xff && byte_at(bytes, 1) == 0xd8) return jpeg_side(bytes);
    return std::nullopt;
}

}  // namespace bendy::converter
