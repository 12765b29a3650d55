#pragma once

#include <bendy/runtime/model.h>

#include <glm/gtc/quaternion.hpp>

#include <cstdint>
#include <vector>

namespace bendy {

/// A joint that the standing pose turns, and its rotation relative to its parent.
struct StandingJoint {
    std::uint32_t joint = 0;
    glm::quat rotation{1, 0, 0, 0};
};

/// Returns the joints that the model's standing pose turns, ascending; none if it has no standing pose.
std::vector<StandingJoint> standing_rotations(const Model& model);

}  // namespace bendy
