#pragma once

#include <nlohmann/json.hpp>

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <string>

// JSON that the program writes, whatever the names in a file hold.
namespace bendy::cli {

/// JSON with the letters escaped that JSON leaves alone and that a terminal, or a reader of lines, takes for more than
/// text: they stand in strings only.
std::string without_controls(std::string json);

/// \param indentation  -1: all on one line
template <class Json>
std::string json_text(const Json& json, int indentation = -1) {
    return without_controls(json.dump(indentation, ' ', false, Json::error_handler_t::replace));
}

/// To standard output, with the end of the line.
template <class Json>
void print_report(const Json& report, int indentation = -1) {
    std::cout << json_text(report, indentation) << '\n';
}

/// A number with six significant digits, so that JSON has it short; null if it is not finite.
inline nlohmann::ordered_json short_number(float number) {
    constexpr int kDigits = 6;
    if (!std::isfinite(number)) return nullptr;
    std::array<char, 32> digits{};
    const auto end =
        std::to_chars(digits.data(), digits.data() + digits.size(), number, std::chars_format::general, kDigits).ptr;
    double rounded = 0.0;
    std::from_chars(digits.data(), end, rounded);
    return rounded;
}

template <std::size_t N>
nlohmann::ordered_json short_numbers(const std::array<float, N>& numbers) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const float number : numbers) list.push_back(short_number(number));
    return list;
}

}  // namespace bendy::cli
