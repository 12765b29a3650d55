#pragma once

#include <bendy/format/public.h>
#include <bendy/format/trig.h>

#include <cmath>

namespace BENDY_PUBLIC bendy {

/// The weights of two rotations in a slerp along the shorter arc, which is first * a + second * b.
struct SlerpWeights {
    double first, second;
};

/// \param dot    of the unit quaternions a and b; the sum of the four products
/// \param share  of the way from a to b, 0 to 1
inline SlerpWeights slerp_weights(double dot, double share) {
    const double sign = dot < 0.0 ? -1.0 : 1.0;
    const double angle = trig::acos(std::abs(dot));
    constexpr double kStraight = 1e-6;  // below it sin(angle) is angle and slerp is linear
    if (angle < kStraight) return {1.0 - share, sign * share};
    const double sine = trig::sin_cos(angle).sin;
    return {trig::sin_cos(angle * (1.0 - share)).sin / sine, sign * (trig::sin_cos(angle * share).sin / sine)};
}

}  // namespace bendy
