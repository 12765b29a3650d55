#include "media_type.h"

#include <string_view>

namespace bendy::converter {

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

}  // namespace bendy::converter
