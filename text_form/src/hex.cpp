#include "hex.h"

namespace bendy::text_form {
namespace {

constexpr unsigned kNoDigit = 16;

unsigned digit_of(char c) {
    if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
    if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a') + 10;
    if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A') + 10;
    return kNoDigit;
}

}  // namespace

void append_hex(std::string& out, Bytes bytes) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    for (const std::byte byte : bytes) {
        const auto value = std::to_integer<unsigned>(byte);
        out += kDigits[value >> 4];
        out += kDigits[value & 15u];
    }
}

bool parse_hex(std::string_view text, std::vector<std::byte>& out) {
    if (text.size() % 2 != 0) return false;
    for (std::size_t k = 0; k < text.size(); k += 2) {
        const unsigned high = digit_of(text[k]);
        const unsigned low = digit_of(text[k + 1]);
        if (high == kNoDigit || low == kNoDigit) return false;
        out.push_back(static_cast<std::byte>(high << 4 | low));
    }
    return true;
}

}  // namespace bendy::text_form
