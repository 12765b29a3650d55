#include "compact/evaluate_track.h"

#include <bendy/format/trig.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace bendy::converter {
namespace {

using Value = std::array<double, 4>;

void slerp(const float* a, const float* b, double u, Value& out) {
    double dot = 0.0;
    for (std::size_t c = 0; c < 4; ++c) dot += double{a[c]} * b[c];
    const double sign = dot < 0.0 ? -1.0 : 1.0;
    const double angle = trig::acos(std::abs(dot));
    double left = 1.0 - u;
    double right = u;
    constexpr double kStraight = 1e-6;
    if (angle >= kStraight) {
        const double sine = trig::sin_cos(angle).sin;
        left = trig::sin_cos(angle * (1.0 - u)).sin / sine;
        right = trig::sin_cos(angle * u).sin / sine;
    }
    for (std::size_t c = 0; c < 4; ++c) out[c] = left * a[c] + sign * right * b[c];
}

void hermite(const float* left, const float* right, std::size_t n, double u, double length, Value& out) {
    const double u2 = u * u;
    const double u3 = u2 * u;
    for (std::size_t c = 0; c < n; ++c) {
        out[c] = (2.0 * u3 - 3.0 * u2 + 1.0) * left[n + c] + length * (u3 - 2.0 * u2 + u) * left[2 * n + c] +
                 (-2.0 * u3 + 3.0 * u2) * right[n + c] + length * (u3 - u2) * right[c];
    }
}

Value value_at(const Track& track, double seconds, double snap) {
    const std::size_t n = track.components;
    const bool cubic = track.interpolation == Interpolation::cubic;
    const std::size_t stride = cubic ? 3 * n : n;
    const auto key = [&](std::size_t k) { return track.values.data() + k * stride; };
    const auto take = [&](std::size_t k) {
        Value value{};
        for (std::size_t c = 0; c < n; ++c) value[c] = key(k)[(cubic ? n : 0) + c];
        return value;
    };
    const auto& times = track.times;
    const auto after = std::upper_bound(times.begin(), times.end(), seconds + snap);
    if (after == times.begin()) return take(0);
    const auto left = static_cast<std::size_t>(after - times.begin()) - 1;
    if (after == times.end() || track.interpolation == Interpolation::step || seconds - times[left] <= snap)
        return take(left);
    const double length = double{times[left + 1]} - times[left];
    const double u = (seconds - times[left]) / length;
    Value value{};
    if (cubic) {
        hermite(key(left), key(left + 1), n, u, length, value);
    } else if (track.path == TrackPath::rotation) {
        slerp(key(left), key(left + 1), u, value);
    } else {
        for (std::size_t c = 0; c < n; ++c) value[c] = (1.0 - u) * key(left)[c] + u * key(left + 1)[c];
    }
    return value;
}

}  // namespace

void evaluate_track(const Track& track, double seconds, double snap, Local& local) {
    const Value v = value_at(track, seconds, snap);
    switch (track.path) {
        case TrackPath::translation:
            local.translation = {v[0], v[1], v[2]};
            break;
        case TrackPath::rotation: {
            const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3]);
            if (length > 0.0) local.rotation = glm::dquat(v[3], v[0], v[1], v[2]) / length;
            break;
        }
        case TrackPath::scale:
            local.scale = {v[0], v[1], v[2]};
            break;
        case TrackPath::weights:
            break;
    }
}

}  // namespace bendy::converter
