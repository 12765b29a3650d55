#include <bendy/format/text.h>

#include <bendy/format/byte_reader.h>

#include <cstdint>

namespace bendy {
namespace {

/// Returns a number of leading characters that are ASCII, eight at a time: most names are.
std::size_t skip_ascii(std::string_view text) {
    constexpr std::uint64_t kUpperBits = 0x8080808080808080u;
    std::size_t at = 0;
    for (std::uint64_t eight = 0; text.size() - at >= sizeof eight; at += sizeof eight) {
        copy_at(as_byte_span(text), at, eight);
        if ((eight & kUpperBits) != 0) break;
    }
    return at;
}

}  // namespace

bool is_utf8(std::string_view text) {
    const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(text[at]); };
    for (std::size_t at = skip_ascii(text); at < text.size();) {
        const unsigned lead = byte(at++);
        if (lead < 0x80) continue;
        // Length, and the range of the second byte, which excludes overlong forms, surrogates and anything above
        // U+10FFFF.
        std::size_t more = 0;
        unsigned low = 0x80;
        unsigned high = 0xbf;
        if (lead >= 0xc2 && lead <= 0xdf) {
            more = 1;
        } else if (lead >= 0xe0 && lead <= 0xef) {
            more = 2;
            if (lead == 0xe0) low = 0xa0;
            if (lead == 0xed) high = 0x9f;
        } else if (lead >= 0xf0 && lead <= 0xf4) {
            more = 3;
            if (lead == 0xf0) low = 0x90;
            if (lead == 0xf4) high = 0x8f;
        } else {
            return false;
        }
        if (more > text.size() - at) return false;
        if (byte(at) < low || byte(at) > high) return false;
        for (std::size_t k = 1; k < more; ++k) {
            if (byte(at + k) < 0x80 || byte(at + k) > 0xbf) return false;
        }
        at += more;
    }
    return true;
}

std::size_t find_control(std::string_view text) {
    const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(text[at]); };
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (byte(at) < 0x20 || byte(at) == 0x7f) return at;
        // U+0080 to U+009F take two bytes.
        if (byte(at) == 0xc2 && text.size() - at > 1 && byte(at + 1) < 0xa0) return at;
    }
    return std::string_view::npos;
}

std::string_view read_text(const ChunkTree& tree, std::uint32_t container, FourCC id, Faults& faults) {
    const std::uint32_t number = tree.find(container, id);
    if (number == kNone) return {};
    const Chunk& chunk = tree[number];
    if (chunk.is_container()) return {};  // check_grammar reports it
    if (const auto fault = tree.encoding_fault(number)) {
        faults.add(*fault);
        return {};
    }
    const std::string_view text = as_text(tree.payload(number));
    if (!is_utf8(text)) {
        faults.add({ErrorCode::kNotUtf8, chunk.offset});
        return {};
    }
    return text;
}

}  // namespace bendy
