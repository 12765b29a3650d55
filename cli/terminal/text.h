#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

// Numbers and texts from a file, made short for a line.
namespace bendy::cli {

/// How many columns UTF-8 text takes on a terminal: two for a letter of East Asian scripts, none for a combining mark.
std::size_t width_of(std::string_view text);

/// The text so that it fits into so many columns, with "..." where something was cut off; 0: all of it.
std::string cut_to(std::string_view text, std::size_t columns);

/// A number with up to four significant digits; what is next to nothing is 0, as in a rest pose's rounding errors.
std::string brief(float number);

/// Numbers with spaces between them.
template <std::size_t N>
std::string brief(const std::array<float, N>& numbers) {
    std::string text;
    for (const float number : numbers) {
        if (!text.empty()) text += ' ';
        text += brief(number);
    }
    return text;
}

/// The text up to 72 bytes, printable; "..." where it was cut.
std::string brief(std::string_view text);

/// Adds a part to a line, after ", " if it is not the first.
void add_part(std::string& line, std::string_view part);

}  // namespace bendy::cli
