#include "text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace bendy::converter::x_out {
namespace {

/// Deeper objects are not moved further to the right: a long chain of frames would take its length squared.
constexpr std::size_t kDeepest = 20;

template <class Number>
void append(std::string& text, Number number) {
    constexpr auto kHandy = Number(1e15);
    std::array<char, 400> digits{};
    char* const end = digits.data() + digits.size();
    const bool is_huge = std::abs(number) >= kHandy;
    const auto written = is_huge ? std::to_chars(digits.data(), end, number)
                                 : std::to_chars(digits.data(), end, number, std::chars_format::fixed);
    const std::string_view shortest(digits.data(), static_cast<std::size_t>(written.ptr - digits.data()));
    text += shortest;
    if (shortest.find_first_of(".e") == std::string_view::npos) text += ".0";
}

}  // namespace

void Text::begin_line() {
    text_.append(std::min(depth_, kDeepest), ' ');
}

void Text::line(std::string_view text) {
    begin_line();
    add(text);
    end_line();
}

void Text::open(std::string_view type, std::string_view name) {
    begin_line();
    add(type).add(" ");
    if (!name.empty()) add(name).add(" ");
    add("{");
    end_line();
    ++depth_;
}

void Text::close() {
    --depth_;
    line("}");
}

Text& Text::add(float number) {
    append(text_, number);
    return *this;
}

Text& Text::add(double number) {
    append(text_, number);
    return *this;
}

template <class Number>
void Text::write_matrix(const std::array<Number, 16>& matrix) {
    for (std::size_t row = 0; row < 4; ++row) {
        begin_line();
        for (std::size_t i = 0; i < 4; ++i) add(matrix[4 * row + i]).add(row < 3 || i < 3 ? "," : ";;");
        end_line();
    }
}

void Text::matrix(const std::array<double, 16>& matrix) {
    write_matrix(matrix);
}

void Text::matrix(const std::array<float, 16>& matrix) {
    write_matrix(matrix);
}

}  // namespace bendy::converter::x_out
