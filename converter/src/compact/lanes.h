#pragma once

#include <bendy/format/packed_clip.h>
#include <bendy/format/trig.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

// Arithmetic that is written once, as templates, for a double and for several of them side by side. Each lane gives
// the bits that a double gives: the operations are the same ones in the same order, and where a function branches, both
// branches are computed and one is selected.

namespace bendy::converter {

#ifdef __GNUC__

/// Four numbers.
struct Lanes {
    using Pair = double __attribute__((vector_size(16)));

    Pair low, high;

    Lanes() = default;
    // NOLINTNEXTLINE(google-explicit-constructor): GLM writes numbers as T(1) and adds plain ones
    Lanes(double number) : low{number, number}, high{number, number} {}
    Lanes(Pair first, Pair second) : low(first), high(second) {}

    [[nodiscard]] double operator[](std::size_t lane) const { return lane < 2 ? low[lane] : high[lane - 2]; }
    void set(std::size_t lane, double number) { (lane < 2 ? low : high)[lane % 2] = number; }

    Lanes operator-() const { return {-low, -high}; }
    Lanes operator+() const { return *this; }
    friend Lanes operator+(const Lanes& a, const Lanes& b) { return {a.low + b.low, a.high + b.high}; }
    friend Lanes operator-(const Lanes& a, const Lanes& b) { return {a.low - b.low, a.high - b.high}; }
    friend Lanes operator*(const Lanes& a, const Lanes& b) { return {a.low * b.low, a.high * b.high}; }
    friend Lanes operator/(const Lanes& a, const Lanes& b) { return {a.low / b.low, a.high / b.high}; }
    Lanes& operator+=(const Lanes& b) { return *this = *this + b; }
    Lanes& operator-=(const Lanes& b) { return *this = *this - b; }
    Lanes& operator*=(const Lanes& b) { return *this = *this * b; }
    Lanes& operator/=(const Lanes& b) { return *this = *this / b; }
};

/// What a comparison of Lanes says of each.
struct LaneMask {
    using Pair = decltype(Lanes::Pair{} < Lanes::Pair{});

    Pair low, high;

    [[nodiscard]] bool operator[](std::size_t lane) const { return (lane < 2 ? low[lane] : high[lane - 2]) != 0; }
};

inline LaneMask operator<(const Lanes& a, const Lanes& b) {
    return {a.low < b.low, a.high < b.high};
}
inline LaneMask operator<=(const Lanes& a, const Lanes& b) {
    return {a.low <= b.low, a.high <= b.high};
}
inline LaneMask operator>(const Lanes& a, const Lanes& b) {
    return b < a;
}

inline Lanes select(const LaneMask& mask, const Lanes& yes, const Lanes& no) {
    return {mask.low ? yes.low : no.low, mask.high ? yes.high : no.high};
}

inline Lanes sqrt(const Lanes& a) {
    return {Lanes::Pair{std::sqrt(a.low[0]), std::sqrt(a.low[1])},
            Lanes::Pair{std::sqrt(a.high[0]), std::sqrt(a.high[1])}};
}

/// trig::sin_cos of angles of 0 to 3.9 radians; of NaN it gives that of 0.
inline void sin_cos(const Lanes& radians, Lanes& sin, Lanes& cos) {
    constexpr double kLargest = 1e6;
    const Lanes angle = select(radians <= kLargest, radians, 0.0);
    constexpr double kShift = 6755399441055744.0;
    const Lanes turns = (angle * (2.0 / trig::kPi) + kShift) - kShift;
    constexpr double kHigh = 1.57079632673412561417;
    constexpr double kLow = 6.07710050650619224932e-11;
    const Lanes x = (angle - turns * kHigh) - turns * kLow;
    const Lanes s = x * x;
    const Lanes sine =
        x + x * s *
                (-1.0 / 6 +
                 s * (1.0 / 120 +
                      s * (-1.0 / 5040 + s * (1.0 / 362880 + s * (-1.0 / 39916800 +
                                                                  s * (1.0 / 6227020800.0 - s / 1307674368000.0))))));
    const Lanes cosine =
        1.0 +
        s * (-0.5 + s * (1.0 / 24 + s * (-1.0 / 720 +
                                         s * (1.0 / 40320 + s * (-1.0 / 3628800 + s * (1.0 / 479001600.0 -
                                                                                       s * (1.0 / 87178291200.0 -
                                                                                            s / 20922789888000.0)))))));
    const LaneMask turned = turns > 0.5;
    const LaneMask twice = turns > 1.5;
    sin = select(twice, -sine, select(turned, cosine, sine));
    cos = select(twice, -cosine, select(turned, -sine, cosine));
}

/// trig::atan_unit.
inline Lanes atan_unit(const Lanes& x) {
    const LaneMask is_high = x > 0.66;
    const Lanes t = select(is_high, (x - 1.0) / (x + 1.0), x);
    const Lanes s = t * t;
    const Lanes above =
        (((-8.750608600031904122785e-1 * s - 1.615753718733365076637e1) * s - 7.500855792314704667340e1) * s -
         1.228866684490136173410e2) *
            s -
        6.485021904942025371773e1;
    const Lanes below =
        ((((s + 2.485846490142306297962e1) * s + 1.650270098316988542046e2) * s + 4.328810604912902668951e2) * s +
         4.853903996359136964868e2) *
            s +
        1.945506571482613964425e2;
    const Lanes angle = t + t * (s * above / below);
    return select(is_high, trig::kPi / 4 + angle, angle);
}

/// trig::atan2 of numbers that are not negative, and not both 0.
inline Lanes atan2(const Lanes& y, const Lanes& x) {
    const LaneMask is_flat = y <= x;
    const Lanes angle = atan_unit(select(is_flat, y, x) / select(is_flat, x, y));
    return select(is_flat, angle, trig::kPi / 2 - angle);
}

/// packed_rotation.
inline glm::qua<Lanes> packed_turn(const glm::vec<3, Lanes>& vector) {
    const Lanes square = (vector.x * vector.x + vector.y * vector.y + vector.z * vector.z) / 4.0;
    const Lanes half = sqrt(select(square > kMaxHalfTurnSquare, kMaxHalfTurnSquare, square));
    Lanes sin;
    Lanes cos;
    sin_cos(half, sin, cos);
    const Lanes factor = select(half < 1e-8, 0.5, sin / (2.0 * half));
    const glm::vec<3, Lanes> part = vector * factor;
    const Lanes length_square = part.x * part.x + part.y * part.y + part.z * part.z + cos * cos;
    const Lanes length = sqrt(length_square);
    const LaneMask has_length = length_square > 0.0;
    return {select(has_length, cos / length, 1.0), select(has_length, part.x / length, 0.0),
            select(has_length, part.y / length, 0.0), select(has_length, part.z / length, 0.0)};
}

/// Whole numbers in steps, rounded to even ones, and held within 2e9 to either side.
inline Lanes whole(const Lanes& number) {
    constexpr double kMost = 2e9;
    constexpr double kShift = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to an integer
    const Lanes held = select(number < -kMost, -kMost, select(number > kMost, kMost, number));
    return (held + kShift) - kShift;
}

/// As many numbers as are worked on at once.
using Several = Lanes;
inline constexpr std::size_t kSeveral = 4;

inline double lane(const Lanes& numbers, std::size_t at) {
    return numbers[at];
}
inline void set_lane(Lanes& numbers, std::size_t at, double number) {
    numbers.set(at, number);
}
inline bool lane(const LaneMask& mask, std::size_t at) {
    return mask[at];
}

#else

using Several = double;
inline constexpr std::size_t kSeveral = 1;

inline double lane(double number, std::size_t) {
    return number;
}
inline void set_lane(double& numbers, std::size_t, double number) {
    numbers = number;
}
inline bool lane(bool mask, std::size_t) {
    return mask;
}

#endif

inline double select(bool mask, double yes, double no) {
    return mask ? yes : no;
}
inline double atan2(double y, double x) {
    return trig::atan2(y, x);
}
inline glm::dquat packed_turn(const glm::dvec3& vector) {
    const auto q = packed_rotation({vector.x, vector.y, vector.z});
    return {q[3], q[0], q[1], q[2]};
}
inline double whole(double number) {
    constexpr double kMost = 2e9;
    return static_cast<double>(static_cast<std::int32_t>(std::clamp(std::nearbyint(number), -kMost, kMost)));
}

template <class Mask, class T>
glm::vec<3, T> select(const Mask& mask, const glm::vec<3, T>& yes, const glm::vec<3, T>& no) {
    return {select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z)};
}
template <class Mask, class T>
glm::qua<T> select(const Mask& mask, const glm::qua<T>& yes, const glm::qua<T>& no) {
    return {select(mask, yes.w, no.w), select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z)};
}

}  // namespace bendy::converter

#ifdef __GNUC__
/// GLM asks whether its numbers are floating-point ones.
template <>
struct std::numeric_limits<bendy::converter::Lanes> : std::numeric_limits<double> {};
#endif
