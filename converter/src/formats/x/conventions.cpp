#include "conventions.h"

#include "scene/source/source_file.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

/// The value of a hexadecimal digit, or -1.
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

namespace {

/// The root of a number above 0 by Newton's method: from above, it converges with every step until rounding stops it.
double root(double number, int degree) {
    double guess = number > 1.0 ? number : 1.0;
    for (;;) {
        double power = 1.0;
        for (int k = 1; k < degree; ++k) power *= guess;
        const double next = guess - (guess - number / power) / degree;
        if (!(next < guess)) return guess;
        guess = next;
    }
}

}  // namespace

float to_light(float display) {
    if (!(display > 0.04045f) || !std::isfinite(display)) return display < 0.0f ? display : display / 12.92f;
    const double base = (static_cast<double>(display) + 0.055) / 1.055;
    const double square = base * base;
    const double light = square * root(square, 5);  // to the power of 2.4
    return static_cast<float>(std::min(light, double{std::numeric_limits<float>::max()}));
}

float to_display(float light) {
    if (!(light > 0.0031308f) || !std::isfinite(light)) return light < 0.0f ? light : light * 12.92f;
    const double third = root(light, 3);
    const double twelfth = std::sqrt(std::sqrt(third));
    const double fifth_power = third * twelfth;  // 4/12 + 1/12
    return static_cast<float>(1.055 * fifth_power - 0.055);
}

glm::vec3 to_light(const glm::vec3& display) {
    return {to_light(display.x), to_light(display.y), to_light(display.z)};
}

glm::vec3 to_display(const glm::vec3& light) {
    return {to_display(light.x), to_display(light.y), to_display(light.z)};
}

glm::vec4 to_light(const glm::vec4& display) {
    return {to_light(glm::vec3(display)), display.w};
}

glm::vec4 to_display(const glm::vec4& light) {
    return {to_display(glm::vec3(light)), light.w};
}

}  // namespace bendy::converter::x
