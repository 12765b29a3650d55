#include "terminal_text.h"

#include <algorithm>
#include <array>

namespace bendy::cli {
namespace {

struct Range {
    char32_t first, last;
};

bool is_in(char32_t letter, const Range* begin, const Range* end) {
    return std::any_of(begin, end, [letter](const Range& r) { return letter >= r.first && letter <= r.last; });
}

/// Unicode's East Asian wide and fullwidth letters, in large blocks.
std::size_t columns_of_letter(char32_t letter) {
    constexpr std::array kWide{Range{0x1100, 0x115f}, Range{0x2e80, 0xa4cf},   Range{0xac00, 0xd7a3},
                               Range{0xf900, 0xfaff}, Range{0xfe30, 0xfe6f},   Range{0xff00, 0xff60},
                               Range{0xffe0, 0xffe6}, Range{0x1f300, 0x1faff}, Range{0x20000, 0x3fffd}};
    constexpr std::array kNone{Range{0x300, 0x36f}, Range{0x200b, 0x200f}, Range{0x20d0, 0x20ff},
                               Range{0xfe00, 0xfe0f}};
    if (is_in(letter, kNone.data(), kNone.data() + kNone.size())) return 0;
    return is_in(letter, kWide.data(), kWide.data() + kWide.size()) ? 2 : 1;
}

struct Letter {
    std::size_t bytes = 1;
    std::size_t columns = 1;
};

/// What is no UTF-8 is one column a byte.
Letter letter_at(std::string_view text, std::size_t at) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[at + k]); };
    const std::size_t bytes = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : byte(0) >= 0xc0 ? 2 : 1;
    if (bytes == 1 || at + bytes > text.size()) return {};
    char32_t letter = byte(0) & (0xffu >> (bytes + 1));
    for (std::size_t k = 1; k < bytes; ++k) {
        if ((byte(k) & 0xc0u) != 0x80u) return {};
        letter = letter << 6u | (byte(k) & 0x3fu);
    }
    return {bytes, columns_of_letter(letter)};
}

}  // namespace

std::size_t width_of(std::string_view text) {
    std::size_t columns = 0;
    for (std::size_t at = 0; at < text.size();) {
        const Letter letter = letter_at(text, at);
        columns += letter.columns;
        at += letter.bytes;
    }
    return columns;
}

std::string cut_to(std::string_view text, std::size_t columns) {
    constexpr std::string_view kDots = "...";
    if (columns == 0 || text.size() <= columns || width_of(text) <= columns) return std::string(text);
    if (columns <= kDots.size()) return std::string(kDots.substr(0, columns));
    std::size_t at = 0;
    for (std::size_t taken = 0; at < text.size();) {
        const Letter letter = letter_at(text, at);
        taken += letter.columns;
        if (taken > columns - kDots.size()) break;
        at += letter.bytes;
    }
    return std::string(text.substr(0, at)) + std::string(kDots);
}

}  // namespace bendy::cli
