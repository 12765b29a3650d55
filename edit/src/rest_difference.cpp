#include "rest_difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <numbers>

namespace bendy::edit {

bool RestDifference::is_noticeable() const {
    return metres > 1e-5 || degrees > 0.01 || scale > 1e-4;
}

RestDifference rest_difference(const RestRecord& a, const RestRecord& b) {
    RestDifference difference;
    double square = 0.0;
    double dot = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
        const double moved = double{a.translation[c]} - b.translation[c];
        square += moved * moved;
        const double larger = std::max(std::abs(double{a.scale[c]}), std::abs(double{b.scale[c]}));
        if (larger > 0.0)
            difference.scale = std::max(difference.scale, std::abs(double{a.scale[c]} - b.scale[c]) / larger);
    }
    std::array<double, 4> apart{};
    for (std::size_t c = 0; c < 4; ++c) dot += double{a.rotation[c]} * b.rotation[c];
    for (std::size_t c = 0; c < 4; ++c) apart[c] = a.rotation[c] - (dot < 0.0 ? -1.0 : 1.0) * b.rotation[c];
    double chord = 0.0;
    for (const double number : apart) chord += number * number;
    difference.metres = std::sqrt(square);
    difference.degrees = 4.0 * std::asin(std::min(1.0, std::sqrt(chord) / 2.0)) * 180.0 / std::numbers::pi;
    return difference;
}

std::string describe(const RestDifference& difference) {
    std::string text;
    const auto add = [&](bool is_there, const char* format, double number) {
        if (!is_there) return;
        std::array<char, 64> part{};
        std::snprintf(part.data(), part.size(), format, number);
        text += (text.empty() ? "" : ", ") + std::string(part.data());
    };
    add(difference.metres > 1e-5, "moved by %.3g mm", difference.metres * 1e3);
    add(difference.degrees > 0.01, "turned by %.3g degrees", difference.degrees);
    add(difference.scale > 1e-4, "scaled by %.3g %%", difference.scale * 100.0);
    return text;
}

}  // namespace bendy::edit
