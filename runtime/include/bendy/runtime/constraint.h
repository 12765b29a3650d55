#pragma once

#include <bendy/format/constraint.h>
#include <bendy/format/public.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>

#include <array>
#include <cstdint>

namespace BENDY_PUBLIC bendy {

/// An interval of angles on the circle.
struct AngleRange {
    double middle = 0.0;  ///< radians: centre of the interval
    double half = 0.0;    ///< radians: half its width, 0 to pi; pi: all angles
    // The same as rotations: cosine and sine of half the angle.
    glm::dvec2 middle_turn{1, 0};
    glm::dvec2 low_turn{1, 0};
    glm::dvec2 high_turn{1, 0};
    double sine_half = 0.0;  ///< sin(half / 2)
};

/// The range that a constraint allows, preprocessed.
struct LimitShape {
    std::array<AngleRange, 3> angles;  ///< hinge and twist: [0]; Euler box: X, Y, Z
    std::array<double, 2> swing_low{
        1, 1};  ///< sin(|limit| / 2) of the swing about Y and Z in the negative direction: 0 to below 1; infinity: free
    std::array<double, 2> swing_high{1, 1};  ///< the same in the positive direction
    double largest = 0.0;                    ///< radians: largest angle
};

/// A joint's constraint. R below is the joint's rotation relative to rest, in the constraint's frame C: q = q_rest * C
/// * R * conj(C). Beside the file's record, its numbers as solvers use them.
struct Constraint : ConstraintView {
    bool limits_translation = false;
    glm::dquat frame{1, 0, 0, 0};  ///< C
    LimitShape shape = {};
    bool has_soft_zone = false;
    LimitShape inner = {};    ///< the shape without its soft zone
    glm::dvec3 stiffness{0};  ///< 0 to 1 about the frame's axes
};

/// Preprocesses a constraint. Impossible numbers (a file may contain any) are replaced by the nearest possible ones.
[[nodiscard]] Constraint make_constraint(const ConstraintView& view);

}  // namespace bendy
