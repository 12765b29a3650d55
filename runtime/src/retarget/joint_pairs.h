#pragma once

#include "body.h"

#include <glm/gtc/quaternion.hpp>

#include <cstdint>
#include <vector>

namespace bendy {

/// What turns a joint of the target.
struct JointPair {
    std::uint32_t a = kNone;  ///< joint of the source; kNone: nothing does
    std::uint32_t b = kNone;  ///< of a mixed turn: the second joint
    double share = 0.0;       ///< of b
    bool is_prop = false;     ///< paired by its name
    /// In the target's model space: from its rest pose to the source's.
    glm::dquat align{1.0, 0.0, 0.0, 0.0};

    [[nodiscard]] std::uint32_t nearer() const { return share > 0.5 ? b : a; }
};

/// Returns a pair for each joint of the target: by roles, then by names for joints without one.
/// \param turn  from the source's model space to the target's
std::vector<JointPair> pair_joints(const Body& source, const Body& target, const glm::dquat& turn,
                                   RestPoses rest_poses);

}  // namespace bendy
