#pragma once

#include <bendy/runtime.h>

#include <glm/vec3.hpp>

#include <vector>

namespace bendy::viewer {

/// A fan of directions around the joint: a cone, or a circular sector.
struct LimitFan {
    std::vector<glm::vec3> rim;  ///< unit vectors in the constraint's frame, in order
    glm::vec3 colour{1.0f};      ///< linear
    float radius = 1.0f;         ///< as a share of the drawing's size
    bool is_closed = false;      ///< true for a cone; otherwise the rim has two ends
    glm::dvec3 axis{0.0};        ///< the axis of an arc's angle; zero for cones
};

/// The drawing of a joint's constraint. A cone contains the directions that `pointer` may have; an arc shows how far a
/// direction perpendicular to its axis may turn.
struct ConstraintDrawing {
    std::uint32_t joint = 0;
    glm::vec3 pointer{1.0f, 0.0f, 0.0f};  ///< drawn as R * pointer; unit vector in the constraint's frame
    std::vector<LimitFan> fans;
    bool is_locked = false;  ///< the joint may not turn at all
};

/// Makes the drawing of a constraint. Swing-twist: a cone for the twist axis X, and an arc for the twist. Hinge, Euler
/// box: an arc for each axis. Largest angle: a cone around the bone.
/// \param bone  from the joint to its child at rest, in the constraint's frame, any length; zero if there is none
ConstraintDrawing make_constraint_drawing(const Constraint& constraint, const glm::vec3& bone);

}  // namespace bendy::viewer
