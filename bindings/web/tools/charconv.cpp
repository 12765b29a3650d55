#include <bendy/format/charconv.h>

#include <double-conversion/double-conversion.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>

namespace bendy {
namespace {

using Digits = double_conversion::DoubleToStringConverter;

template <class Number>
constexpr Digits::DtoaMode kShortest = std::is_same_v<Number, float> ? Digits::SHORTEST_SINGLE : Digits::SHORTEST;

/// The shortest digits of a finite number, and the power of ten of their point: 0.DIGITS * 10^point.
struct Decimal {
    template <class Number>
    explicit Decimal(Number value) {
        std::array<char, Digits::kBase10MaximalLength + 1> buffer{};
        int length = 0;
        Digits::DoubleToAscii(double{value}, kShortest<Number>, 0, buffer.data(), int{buffer.size()}, &is_negative,
                              &length, &point);
        digits.assign(buffer.data(), static_cast<std::size_t>(length));
    }
    bool is_negative = false;
    int point = 0;
    std::string digits;
};

std::to_chars_result put(char* first, char* last, std::string_view text) {
    if (static_cast<std::size_t>(last - first) < text.size()) return {last, std::errc::value_too_large};
    return {std::copy(text.begin(), text.end(), first), std::errc()};
}

template <class... Arguments>
std::string printed(const char* format, Arguments... arguments) {
    std::array<char, 400> text{};
    const int length = std::snprintf(text.data(), text.size(), format, arguments...);
    return {text.data(), static_cast<std::size_t>(length)};
}

std::string scientific(const Decimal& number) {
    std::string text = number.is_negative ? "-" : "";
    text += number.digits[0];
    if (number.digits.size() > 1) text.append(1, '.').append(number.digits, 1);
    return text + printed("e%+03d", number.digits == "0" ? 0 : number.point - 1);
}

/// An integer that is longer than its shortest digits is printed in full.
std::string fixed(const Decimal& number, double value) {
    std::string text = number.is_negative ? "-" : "";
    const auto length = static_cast<int>(number.digits.size());
    if (number.point > length) return printed("%.0f", value);
    if (number.point <= 0)
        return text.append("0.").append(static_cast<std::size_t>(-number.point), '0') + number.digits;
    const auto whole = static_cast<std::size_t>(number.point);
    text.append(number.digits, 0, whole);
    if (number.point < length) text.append(1, '.').append(number.digits, whole);
    return text;
}

/// Empty for a finite number.
std::string_view special(double value) {
    if (std::isnan(value)) return std::signbit(value) ? "-nan" : "nan";
    if (std::isinf(value)) return value < 0 ? "-inf" : "inf";
    return {};
}

template <class Number>
std::to_chars_result shortest(char* first, char* last, Number value) {
    if (const std::string_view text = special(value); !text.empty()) return put(first, last, text);
    const Decimal number(value);
    const std::string with_exponent = scientific(number);
    // All zeros count as digits, leading ones too.
    const auto length = static_cast<int>(number.digits.size());
    const int fixed_length = number.point <= 0 ? 2 - number.point + length
                                               : std::max(number.point, length + (number.point < length ? 1 : 0));
    const bool is_fixed =
        value == 0 || fixed_length + (number.is_negative ? 1 : 0) <= static_cast<int>(with_exponent.size());
    return put(first, last,
               value == 0 ? (number.is_negative ? "-0" : "0")
               : is_fixed ? fixed(number, double{value})
                          : with_exponent);
}

template <class Number>
std::to_chars_result shortest_fixed(char* first, char* last, Number value) {
    if (const std::string_view text = special(value); !text.empty()) return put(first, last, text);
    if (value == 0) return put(first, last, std::signbit(value) ? "-0" : "0");
    return put(first, last, fixed(Decimal(value), double{value}));
}

std::to_chars_result precise(char* first, char* last, double value, std::chars_format format, int precision) {
    return put(first, last, printed(format == std::chars_format::general ? "%.*g" : "%.*e", precision, value));
}

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// Returns the end of a number in decimal notation; `text` itself if there is none.
const char* end_of_number(const char* text, const char* last) {
    const char* at = text;
    const auto skip_digits = [&] {
        const char* const start = at;
        while (at != last && is_digit(*at)) ++at;
        return at - start;
    };
    if (at != last && *at == '-') ++at;
    auto digits = skip_digits();
    if (at != last && *at == '.') {
        ++at;
        digits += skip_digits();
    }
    if (digits == 0) return text;
    if (at != last && (*at == 'e' || *at == 'E')) {
        const char* const end = at;
        ++at;
        if (at != last && (*at == '+' || *at == '-')) ++at;
        if (skip_digits() == 0) at = end;
    }
    return at;
}

bool starts_with(const char* at, const char* last, std::string_view word) {
    return static_cast<std::size_t>(last - at) >= word.size() &&
           std::equal(word.begin(), word.end(), at,
                      [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? b + ('a' - 'A') : b); });
}

template <class Number>
std::from_chars_result read_special(const char* first, const char* last, Number& value) {
    const bool is_negative = first != last && *first == '-';
    const char* const word = first + (is_negative ? 1 : 0);
    const Number sign = is_negative ? Number(-1) : Number(1);
    for (const std::string_view infinity : {"infinity", "inf"}) {
        if (!starts_with(word, last, infinity)) continue;
        value = std::copysign(std::numeric_limits<Number>::infinity(), sign);
        return {word + infinity.size(), std::errc()};
    }
    if (!starts_with(word, last, "nan")) return {first, std::errc::invalid_argument};
    value = std::copysign(std::numeric_limits<Number>::quiet_NaN(), sign);
    return {word + 3, std::errc()};
}

template <class Number>
std::from_chars_result read(const char* first, const char* last, Number& value) {
    const char* const end = end_of_number(first, last);
    if (end == first) return read_special(first, last, value);
    static const double_conversion::StringToDoubleConverter converter(0, 0.0, 0.0, nullptr, nullptr);
    int used = 0;
    const auto length = static_cast<int>(end - first);
    Number number = 0;
    if constexpr (std::is_same_v<Number, float>) {
        number = converter.StringToFloat(first, length, &used);
    } else {
        number = converter.StringToDouble(first, length, &used);
    }
    const char* const exponent = std::find_if(first, end, [](char c) { return c == 'e' || c == 'E'; });
    const bool is_zero = std::none_of(first, exponent, [](char c) { return c >= '1' && c <= '9'; });
    if (std::isinf(number) || (number == 0 && !is_zero)) return {end, std::errc::result_out_of_range};
    value = number;
    return {end, std::errc()};
}

}  // namespace

std::to_chars_result to_chars(char* first, char* last, float value) {
    return shortest(first, last, value);
}

std::to_chars_result to_chars(char* first, char* last, double value) {
    return shortest(first, last, value);
}

std::to_chars_result to_chars(char* first, char* last, float value, std::chars_format /*fixed*/) {
    return shortest_fixed(first, last, value);
}

std::to_chars_result to_chars(char* first, char* last, double value, std::chars_format /*fixed*/) {
    return shortest_fixed(first, last, value);
}

std::to_chars_result to_chars(char* first, char* last, float value, std::chars_format format, int precision) {
    return precise(first, last, double{value}, format, precision);
}

std::to_chars_result to_chars(char* first, char* last, double value, std::chars_format format, int precision) {
    return precise(first, last, value, format, precision);
}

std::from_chars_result from_chars(const char* first, const char* last, float& value) {
    return read(first, last, value);
}

std::from_chars_result from_chars(const char* first, const char* last, double& value) {
    return read(first, last, value);
}

}  // namespace bendy
