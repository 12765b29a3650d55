#pragma once

#include <bendy/format/charconv.h>
#include <bendy/json/json.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <string>

// JSON that the program writes, safe whatever the names in a file hold.
namespace bendy::tools {

/// Escapes characters that JSON allows but that a terminal, or a reader of lines, does not treat as plain text; they
/// occur only in strings.
std::string without_controls(std::string json);

/// \param indentation  -1: all on one line
template <class Json>
std::string json_text(const Json& json, int indentation = -1) {
    return without_controls(json.dump(indentation, false, Json::InvalidText::replaced));
}

/// Prints to standard output, with a line break.
template <class Json>
void print_report(const Json& report, int indentation = -1) {
    std::cout << json_text(report, indentation) << '\n';
}

/// Rounds a number to six significant digits, to keep the JSON short; null if it is not finite.
inline OrderedJson short_number(float number) {
    constexpr int kDigits = 6;
    if (!std::isfinite(number)) return nullptr;
    std::array<char, 32> digits{};
    const auto end =
        to_chars(digits.data(), digits.data() + digits.size(), number, std::chars_format::general, kDigits).ptr;
    double rounded = 0.0;
    from_chars(digits.data(), end, rounded);
    return rounded;
}

template <std::size_t N>
OrderedJson short_numbers(const std::array<float, N>& numbers) {
    OrderedJson list = OrderedJson::array();
    for (const float number : numbers) list.push_back(short_number(number));
    return list;
}

}  // namespace bendy::tools
