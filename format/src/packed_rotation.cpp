#include <bendy/format/packed_clip.h>

#include <bendy/format/trig.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace bendy {
namespace {

using Quaternion = std::array<double, 4>;

Quaternion normalised(const Quaternion& q) {
    double square = 0.0;
    for (const double c : q) square += c * c;
    if (!(square > 0.0)) return {0.0, 0.0, 0.0, 1.0};
    const double length = std::sqrt(square);
    return {q[0] / length, q[1] / length, q[2] / length, q[3] / length};
}

Quaternion product(const Quaternion& a, const Quaternion& b) {
    return {
        a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1], a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
        a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3], a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

Quaternion slerp(const Quaternion& a, const Quaternion& b, double u) {
    double dot = 0.0;
    for (std::size_t c = 0; c < 4; ++c) dot += a[c] * b[c];
    const double sign = dot < 0.0 ? -1.0 : 1.0;
    const double angle = trig::acos(std::abs(dot));
    double weight_a = 1.0 - u;
    double weight_b = u;
    constexpr double kStraight = 1e-6;  // below it sin(angle) is angle and slerp is linear
    if (angle >= kStraight) {
        const double sine = trig::sin_cos(angle).sin;
        weight_a = trig::sin_cos(angle * (1.0 - u)).sin / sine;
        weight_b = trig::sin_cos(angle * u).sin / sine;
    }
    Quaternion q;
    for (std::size_t c = 0; c < 4; ++c) q[c] = weight_a * a[c] + sign * weight_b * b[c];
    return normalised(q);
}

}  // namespace

std::array<double, 4> packed_rotation(const std::array<double, 3>& vector) {
    const double square = (vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2]) / 4;
    const double half = std::sqrt(std::min(square, kMaxHalfTurnSquare));
    const trig::SinCos of = trig::sin_cos(half);
    const double factor = half < 1e-8 ? 0.5 : of.sin / (2.0 * half);
    return normalised({vector[0] * factor, vector[1] * factor, vector[2] * factor, of.cos});
}

std::array<double, 4> blend_packed_rotations(const std::array<float, 4>& rest, const std::array<double, 3>& left,
                                             const std::array<double, 3>& right, double fraction) {
    const Quaternion base = normalised({rest[0], rest[1], rest[2], rest[3]});
    Quaternion between = packed_rotation(left);
    if (fraction > 0.0) between = slerp(between, packed_rotation(right), fraction);
    return normalised(product(base, between));
}

}  // namespace bendy
