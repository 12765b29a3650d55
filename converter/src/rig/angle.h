#pragma once

#include <numbers>

namespace bendy::converter {

/// In what unit a source gives angles: rig files for people in degrees, extras in radians.
enum class AngleUnit : bool { radians, degrees };

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

/// Both readers and writers of degrees use this, so that what was written comes back to the bit.
constexpr double to_radians(double degrees) {
    return degrees * kRadiansPerDegree;
}

}  // namespace bendy::converter
