#pragma once

#include "retarget_plan.h"

#include <bendy/runtime/retarget.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <array>

namespace bendy {

struct PoseState;

/// A foot of the target in one frame, model space.
struct Foot {
    glm::dvec3 ankle{0.0};    ///< as the joints have it
    glm::dvec3 to_toes{0.0};  ///< from the ankle
};

/// Where an ankle is to be.
struct Standing {
    glm::dvec3 ankle{0.0};
    double weight = 0.0;  ///< how far that is decided by the ground: 0 to 1
};

/// The weights of a foot's two points of contact.
struct FootContact {
    float heel = 0.0f, toes = 0.0f;
};

/// Returns 1 up to one number and 0 from another one on, smoothly.
float eased(double number, double low, double high);

/// Finds by the height of the source's heel and toes how firmly they stand. Toes touch the ground on their own only
/// after the whole foot has: a foot that swings forward may be low too.
FootContact find_contact(const RetargetPlan& plan, const FootPlan& foot, PoseState& source, float last_toes);

/// Finds how firmly a body sits, lies or kneels by its lowest point, in leg lengths above the ground and above the
/// feet.
float body_contact(double height, double above_feet);

/// Returns where the ankle is to be. Where a point of the foot begins to stand, its distance from the place that the
/// source's would have is remembered; as long as it stands it moves as that does.
Standing stand(const RetargetPlan& plan, const FootPlan& plan_of_foot, PoseState& source, const Foot& foot,
               const FootContact& contact, RetargetState::Stand& heel, RetargetState::Stand& toes);

}  // namespace bendy
