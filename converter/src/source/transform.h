#pragma once

#include <bendy/converter/scene.h>

#include <array>

namespace bendy::converter {

/// Turns an affine column-major matrix into T * R * U (see Transform), computed in double. A mirrored matrix gets a
/// negative first row of U. Works for matrices without volume.
Transform decompose(const std::array<double, 16>& matrix);

/// x y z w of length 1. A quaternion that is one already, but for float rounding, keeps its bits; zero has no direction
/// and gives the identity.
struct UnitQuaternion {
    glm::vec4 value{0.0f, 0.0f, 0.0f, 1.0f};
    double length = 1.0;  ///< before
};
UnitQuaternion make_unit(const std::array<double, 4>& quaternion);

/// Lengths further from 1 than this are the source's fault, not rounding, and worth a warning.
inline constexpr double kUnitTolerance = 1e-3;

}  // namespace bendy::converter
