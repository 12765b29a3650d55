#include "failure.h"

#include <algorithm>

namespace bendy::converter {

std::string key(const std::string& name) {
    const bool plain = !name.empty() && name.size() < 80 && std::all_of(name.begin(), name.end(), [](char c) {
        return c == '_' || (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    });
    return plain ? name : quote(name);
}

std::string quote(std::string_view name) {
    constexpr std::size_t kMaxBytes = 80;
    constexpr std::string_view kHex = "0123456789abcdef";
    std::string text = "'";
    for (std::size_t i = 0; i < name.size(); ++i) {
        const auto byte = static_cast<unsigned char>(name[i]);
        const bool starts_character = (byte & 0xc0u) != 0x80u;  // never cut inside a UTF-8 sequence
        if (i >= kMaxBytes && starts_character) {
            text += "...";
            break;
        }
        if (byte < 0x20 || byte == 0x7f) {
            text += "\\x";
            text += kHex[byte >> 4];
            text += kHex[byte & 0xfu];
        } else {
            text += name[i];
        }
    }
    return text + '\'';
}

}  // namespace bendy::converter
