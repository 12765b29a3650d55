#pragma once

#include <cmath>
#include <cstdint>

// Sine, cosine, arc tangent and cube root that use only IEEE addition, multiplication, division and square root.
// Mathematical libraries round these functions differently, but two machines must solve a chain alike and convert to
// the same bytes. Accurate to 2e-16 relative to the larger of the result and 1; faster than most libraries.
namespace bendy::trig {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kDegree = kPi / 180.0;  ///< radians

struct SinCos {
    double sin, cos;
};

/// \param angle  radians; beyond 1e6, and for NaN and infinity, the result is some point on the circle
inline SinCos sin_cos(double angle) {
    constexpr double kLargest = 1e6;
    if (!(std::abs(angle) <= kLargest)) angle = std::isfinite(angle) ? std::remainder(angle, 2.0 * kPi) : 0.0;
    // angle = turns * pi/2 + x, |x| <= pi/4; the product is in two parts so that no precision is lost.
    constexpr double kShift = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to an integer
    const double turns = (angle * (2.0 / kPi) + kShift) - kShift;
    constexpr double kHigh = 1.57079632673412561417;     // the first 33 bits of pi/2
    constexpr double kLow = 6.07710050650619224932e-11;  // the remainder
    const double x = (angle - turns * kHigh) - turns * kLow;
    const double s = x * x;
    // Taylor series; the next terms are below 1e-18 at pi/4.
    const double sine =
        x + x * s *
                (-1.0 / 6 +
                 s * (1.0 / 120 +
                      s * (-1.0 / 5040 + s * (1.0 / 362880 + s * (-1.0 / 39916800 +
                                                                  s * (1.0 / 6227020800.0 - s / 1307674368000.0))))));
    const double cosine =
        1.0 +
        s * (-0.5 + s * (1.0 / 24 + s * (-1.0 / 720 +
                                         s * (1.0 / 40320 + s * (-1.0 / 3628800 + s * (1.0 / 479001600.0 -
                                                                                       s * (1.0 / 87178291200.0 -
                                                                                            s / 20922789888000.0)))))));
    switch (static_cast<std::int64_t>(turns) & 3) {
        case 0:
            return {sine, cosine};
        case 1:
            return {cosine, -sine};
        case 2:
            return {-sine, -cosine};
        default:
            return {-cosine, sine};
    }
}

/// Arc tangent of x in [0, 1], in radians.
inline double atan_unit(double x) {
    // Above 0.66, atan(x) = pi/4 + atan((x - 1) / (x + 1)); then a rational function (Moshier, Cephes, atan.c).
    const bool is_high = x > 0.66;
    const double t = is_high ? (x - 1.0) / (x + 1.0) : x;
    const double s = t * t;
    const double above =
        (((-8.750608600031904122785e-1 * s - 1.615753718733365076637e1) * s - 7.500855792314704667340e1) * s -
         1.228866684490136173410e2) *
            s -
        6.485021904942025371773e1;
    const double below =
        ((((s + 2.485846490142306297962e1) * s + 1.650270098316988542046e2) * s + 4.328810604912902668951e2) * s +
         4.853903996359136964868e2) *
            s +
        1.945506571482613964425e2;
    const double angle = t + t * (s * above / below);
    return is_high ? kPi / 4 + angle : angle;
}

/// The angle of (x, y), radians, -pi to pi; 0 for (0, 0).
inline double atan2(double y, double x) {
    const double ay = std::abs(y);
    const double ax = std::abs(x);
    if (ax == 0.0 && ay == 0.0) return 0.0;
    double angle = ay <= ax ? atan_unit(ay / ax) : kPi / 2 - atan_unit(ax / ay);
    if (x < 0.0) angle = kPi - angle;
    return y < 0.0 ? -angle : angle;
}

/// \param x  clamped to -1 ... 1
inline double acos(double x) {
    if (x >= 1.0) return 0.0;
    if (x <= -1.0) return kPi;
    return atan2(std::sqrt((1.0 - x) * (1.0 + x)), x);
}

/// The real cube root, with the sign of x; x itself if it is 0 or not finite.
inline double cube_root(double x) {
    if (x == 0.0 || !std::isfinite(x)) return x;
    int exponent = 0;
    double mantissa = std::frexp(std::abs(x), &exponent);  // [0.5, 1)
    while (exponent % 3 != 0) {
        mantissa *= 0.5;
        ++exponent;
    }
    double root = 0.4 + mantissa * (0.95 - 0.35 * mantissa);  // within 4 % of the root, from 0.125 to 1
    for (int step = 0; step < 4; ++step) root -= (root - mantissa / (root * root)) / 3.0;
    return std::copysign(std::ldexp(root, exponent / 3), x);
}

}  // namespace bendy::trig
