#include "text.h"

#include "terminal/problem.h"

#include <utf8cpp/utf8.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

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

/// Columns of the letter at `at`, which moves behind it. A byte that is not UTF-8 takes one column.
std::size_t next_columns(const char*& at, const char* end) {
    constexpr std::ptrdiff_t kLongest = 4;
    if (utf8::find_invalid(at, at + std::min(kLongest, end - at)) == at) {
        ++at;
        return 1;
    }
    return columns_of_letter(utf8::unchecked::next(at));
}

}  // namespace

std::size_t width_of(std::string_view text) {
    std::size_t columns = 0;
    const char* const end = text.data() + text.size();
    for (const char* at = text.data(); at != end;) columns += next_columns(at, end);
    return columns;
}

std::string cut_to(std::string_view text, std::size_t columns) {
    constexpr std::string_view kDots = "...";
    if (columns == 0 || text.size() <= columns || width_of(text) <= columns) return std::string(text);
    if (columns <= kDots.size()) return std::string(kDots.substr(0, columns));
    const char* const end = text.data() + text.size();
    const char* cut = text.data();
    std::size_t taken = 0;
    for (const char* at = cut; at != end; cut = at) {
        taken += next_columns(at, end);
        if (taken > columns - kDots.size()) break;
    }
    return std::string(text.data(), cut) + std::string(kDots);
}

std::string brief(float number) {
    constexpr float kNextToNothing = 5e-7f;
    constexpr int kDigits = 4;
    if (std::abs(number) < kNextToNothing) return "0";
    std::array<char, 32> digits{};
    const auto end =
        std::to_chars(digits.data(), digits.data() + digits.size(), number, std::chars_format::general, kDigits).ptr;
    return {digits.data(), end};
}

std::string brief(std::string_view text) {
    constexpr std::size_t kMost = 72;
    std::size_t cut = std::min(kMost, text.size());
    while (cut > 0 && cut < text.size() && (static_cast<unsigned char>(text[cut]) & 0xc0u) == 0x80u)
        --cut;  // not inside a character
    std::string shown = printable(text.substr(0, cut));
    if (cut < text.size()) shown += "...";
    return shown;
}

void add_part(std::string& line, std::string_view part) {
    if (!line.empty()) line += ", ";
    line += part;
}

}  // namespace bendy::cli
