#pragma once

#include <bendy/runtime.h>

#include <glm/vec3.hpp>

#include <vector>

namespace bendy::viewer {

/// A fan of directions round the joint: a cone, or the sector of an arc.
struct LimitFan {
    std::vector<glm::vec3> rim;  ///< unit vectors in the limit's frame, in order
    glm::vec3 colour{1.0f};      ///< linear
    float radius = 1.0f;         ///< as a share of the drawing's size
    bool is_closed = false;      ///< a cone; else the rim has two ends
    glm::dvec3 axis{0.0};        ///< what an arc's angle turns about; zero for cones
};

/// How a joint's constraint looks. A cone holds the directions that `pointer` may have; an arc, where a direction
/// across its axis may turn to.
struct ConstraintDrawing {
    std::uint32_t joint = 0;
    glm::vec3 pointer{1.0f, 0.0f, 0.0f};  ///< what is shown of R: R * pointer, unit, in the limit's frame
    std::vector<LimitFan> fans;
    bool is_locked = false;  ///< may not turn at all
};

/// The drawing of a constraint. Swing-twist: the cone of the twist axis X, and the arc of the twist. Hinge, Euler box:
/// an arc for each axis. Largest angle: a cone round the bone.
/// \param bone  from the joint to its child at rest, in the limit's frame, any length; zero if there is none
ConstraintDrawing make_constraint_drawing(const Constraint& constraint, const glm::vec3& bone);

}  // namespace bendy::viewer
