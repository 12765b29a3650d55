#pragma once

#include <nlohmann/json.hpp>

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>

namespace bendy::cli {

/// A number with six significant digits, so that JSON has it short; null if it is not finite.
inline nlohmann::ordered_json page_number(float number) {
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
nlohmann::ordered_json page_numbers(const std::array<float, N>& numbers) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const float number : numbers) list.push_back(page_number(number));
    return list;
}

}  // namespace bendy::cli
