#include "encoded_text.h"

#include <bendy/format/text.h>

#include <utf8cpp/utf8.h>

#include <iterator>

namespace bendy::converter::x {
namespace {

constexpr std::string_view kHex = "0123456789ABCDEF";

bool is_between(char c, char first, char last) {
    return c >= first && c <= last;
}

bool is_plain(char c) {
    constexpr std::string_view kSigns = "-_.:+ ";
    return is_between(c, 'a', 'z') || is_between(c, 'A', 'Z') || is_between(c, '0', '9') ||
           kSigns.find(c) != std::string_view::npos || (static_cast<unsigned char>(c) & 0x80u) != 0;
}

/// -1 for what is no digit.
int digit(char c) {
    if (is_between(c, '0', '9')) return c - '0';
    if (is_between(c, 'A', 'F')) return c - 'A' + 10;
    return is_between(c, 'a', 'f') ? c - 'a' + 10 : -1;
}

}  // namespace

std::string encode_text(std::string_view text) {
    std::string encoded;
    for (const char c : text) {
        if (is_plain(c)) {
            encoded += c;
        } else {
            const auto code = static_cast<unsigned char>(c);
            encoded.append({'%', kHex[code >> 4], kHex[code & 15]});
        }
    }
    return encoded;
}

std::string decode_text(std::string_view text) {
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool has_digits =
            text[i] == '%' && text.size() - i > 2 && digit(text[i + 1]) >= 0 && digit(text[i + 2]) >= 0;
        if (has_digits) {
            decoded += static_cast<char>(16 * digit(text[i + 1]) + digit(text[i + 2]));
            i += 2;
        } else {
            decoded += text[i];
        }
    }
    return to_utf8(decoded);
}

std::string to_utf8(std::string_view text) {
    if (is_utf8(text)) return std::string(text);
    std::string converted;
    for (const char c : text) utf8::unchecked::append(static_cast<unsigned char>(c), std::back_inserter(converted));
    return converted;
}

}  // namespace bendy::converter::x
