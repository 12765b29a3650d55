#include "number_text.h"

#include <bendy/format/charconv.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <system_error>

namespace bendy::text_form {
namespace {

constexpr std::string_view kNotANumber = "nan:0x";

template <class T>
void append_as(std::string& out, Bytes bytes, std::uint64_t at) {
    T value{};
    copy_at(bytes, at, value);
    std::array<char, 24> digits{};
    const auto end = to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    out.append(digits.data(), end);
}

void append_float(std::string& out, Bytes bytes, std::uint64_t at) {
    float value = 0.0f;
    copy_at(bytes, at, value);
    if (value == 0.0f && std::signbit(value)) {
        out += "-0.0";  // many JSON readers take -0 for an integer, which has no sign
    } else if (std::isfinite(value)) {
        append_as<float>(out, bytes, at);
    } else if (std::isinf(value)) {
        out += value < 0.0f ? "\"-inf\"" : "\"inf\"";
    } else {
        std::array<char, 8> digits{};
        const auto bits = bit_cast<std::uint32_t>(value);
        const auto end = to_chars(digits.data(), digits.data() + digits.size(), bits, 16).ptr;
        out.append(1, '"').append(kNotANumber).append(digits.data(), end).append(1, '"');
    }
}

template <class T>
void append_bytes(std::vector<std::byte>& out, const T& value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    out.insert(out.end(), bytes.begin(), bytes.end());
}

template <class T>
NumberFault parse_as(std::string_view token, std::vector<std::byte>& out) {
    T value{};
    const char* const last = token.data() + token.size();
    // JSON's "-0" is an integer, even for an unsigned type.
    if (token.starts_with("-0")) token.remove_prefix(1);
    const auto [end, failure] = from_chars(token.data(), last, value);
    const bool is_whole = end == last || (*end != '.' && *end != 'e' && *end != 'E');
    if (failure == std::errc::invalid_argument)
        return token.starts_with('-') ? NumberFault::out_of_range : NumberFault::no_number;
    if (!is_whole) return NumberFault::not_whole;
    if (failure == std::errc::result_out_of_range) return NumberFault::out_of_range;
    append_bytes(out, value);
    return NumberFault::none;
}

NumberFault parse_float(std::string_view token, std::vector<std::byte>& out) {
    float value = 0.0f;
    const auto [end, failure] = from_chars(token.data(), token.data() + token.size(), value);
    if (failure == std::errc::invalid_argument) return NumberFault::no_number;
    if (failure == std::errc::result_out_of_range) return NumberFault::out_of_range;
    append_bytes(out, value);
    return NumberFault::none;
}

constexpr unsigned kNoDigit = 16;

unsigned digit_of(char c) {
    if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
    if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a') + 10;
    if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A') + 10;
    return kNoDigit;
}

}  // namespace

void append_number(std::string& out, NumberType type, Bytes bytes, std::uint64_t at) {
    switch (type) {
        case NumberType::u8:
            return append_as<std::uint8_t>(out, bytes, at);
        case NumberType::i8:
            return append_as<std::int8_t>(out, bytes, at);
        case NumberType::u16:
            return append_as<std::uint16_t>(out, bytes, at);
        case NumberType::i16:
            return append_as<std::int16_t>(out, bytes, at);
        case NumberType::u32:
            return append_as<std::uint32_t>(out, bytes, at);
        case NumberType::i32:
            return append_as<std::int32_t>(out, bytes, at);
        case NumberType::u64:
            return append_as<std::uint64_t>(out, bytes, at);
        case NumberType::f32:
            return append_float(out, bytes, at);
    }
}

NumberFault parse_number(std::string_view token, NumberType type, std::vector<std::byte>& out) {
    switch (type) {
        case NumberType::u8:
            return parse_as<std::uint8_t>(token, out);
        case NumberType::i8:
            return parse_as<std::int8_t>(token, out);
        case NumberType::u16:
            return parse_as<std::uint16_t>(token, out);
        case NumberType::i16:
            return parse_as<std::int16_t>(token, out);
        case NumberType::u32:
            return parse_as<std::uint32_t>(token, out);
        case NumberType::i32:
            return parse_as<std::int32_t>(token, out);
        case NumberType::u64:
            return parse_as<std::uint64_t>(token, out);
        case NumberType::f32:
            return parse_float(token, out);
    }
    return NumberFault::no_number;
}

NumberFault parse_special(std::string_view text, std::vector<std::byte>& out) {
    if (text == "inf" || text == "-inf") {
        const auto infinity = std::numeric_limits<float>::infinity();
        append_bytes(out, std::copysign(infinity, text.front() == '-' ? -1.0f : 1.0f));
        return NumberFault::none;
    }
    if (!text.starts_with(kNotANumber)) return NumberFault::no_number;
    text.remove_prefix(kNotANumber.size());
    std::uint32_t bits = 0;
    const char* const last = text.data() + text.size();
    const auto [end, failure] = from_chars(text.data(), last, bits, 16);
    if (failure != std::errc() || end != last || !std::isnan(bit_cast<float>(bits))) return NumberFault::no_number;
    append_bytes(out, bits);
    return NumberFault::none;
}

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
