#include "brief.h"

#include "problem.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace bendy::cli {

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
