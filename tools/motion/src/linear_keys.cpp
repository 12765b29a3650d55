#include "linear_keys.h"

#include <bendy/format/slerp.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace bendy::motion {
namespace {

/// Samples that a key may stand for, which bounds the work for each of them.
constexpr std::size_t kFarthest = 64;

using Rotation = std::array<double, 4>;

double dot(const Rotation& a, const Rotation& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

Rotation rotation_at(const Samples& samples, std::size_t k) {
    const auto value = samples.at(k);
    Rotation rotation{value[0], value[1], value[2], value[3]};
    const double length = std::sqrt(dot(rotation, rotation));
    for (double& number : rotation) number /= length;
    return rotation;
}

/// Accurate for small angles too.
double angle_between(const Rotation& a, const Rotation& b) {
    const double sign = dot(a, b) < 0.0 ? -1.0 : 1.0;
    double chord = 0.0;
    for (std::size_t c = 0; c < a.size(); ++c) chord += (a[c] - sign * b[c]) * (a[c] - sign * b[c]);
    return 4.0 * std::asin(std::min(1.0, 0.5 * std::sqrt(chord)));
}

/// Returns how far sample k is from what lies between two others at its time.
double off_line(const Samples& samples, std::span<const float> times, std::size_t from, std::size_t to, std::size_t k) {
    const double share = from == to ? 0.0 : (double{times[k]} - times[from]) / (double{times[to]} - times[from]);
    if (samples.is_rotation) {
        const Rotation a = rotation_at(samples, from);
        const Rotation b = rotation_at(samples, to);
        const auto [first, second] = slerp_weights(std::clamp(dot(a, b), -1.0, 1.0), share);
        Rotation between{};
        for (std::size_t c = 0; c < between.size(); ++c) between[c] = first * a[c] + second * b[c];
        return angle_between(between, rotation_at(samples, k));
    }
    double most = 0.0;
    for (std::size_t c = 0; c < samples.components; ++c) {
        const double a = samples.at(from)[c];
        const double b = samples.at(to)[c];
        most = std::max(most, std::abs(a + share * (b - a) - samples.at(k)[c]));
    }
    return most;
}

bool is_line(const Samples& samples, std::span<const float> times, std::size_t from, std::size_t to, double bound) {
    for (std::size_t k = to; k-- > from + 1;) {  // the last ones are the likeliest to be off
        if (!(off_line(samples, times, from, to, k) <= bound)) return false;
    }
    return true;
}

}  // namespace

std::vector<std::size_t> linear_keys(const Samples& samples, std::span<const float> times, double bound) {
    std::vector<std::size_t> keys{0};
    const std::size_t count = samples.count();
    const auto is_at_first = [&](std::size_t k) { return off_line(samples, times, 0, 0, k) <= bound; };
    std::size_t constant = 1;
    while (constant < count && is_at_first(constant)) ++constant;
    if (constant == count) return keys;
    while (keys.back() + 1 < count) {
        const std::size_t from = keys.back();
        const std::size_t last = std::min(count - 1, from + kFarthest);
        std::size_t to = from + 1;
        while (to < last && is_line(samples, times, from, to + 1, bound)) ++to;
        keys.push_back(to);
    }
    return keys;
}

}  // namespace bendy::motion
