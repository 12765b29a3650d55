#pragma once

#include <bendy/format/records.h>
#include <bendy/runtime/pose.h>
#include <bendy/runtime/retarget.h>

#include <cstdint>
#include <vector>

namespace bendy::motion {

/// A bone that source and target both have: from a joint to the next one of the body.
struct SharedBone {
    struct Ends {
        std::uint32_t from = kNone, to = kNone;
    };
    Ends source, target;
    double far = 0.0;  ///< radians: it points elsewhere than the source's if the two are farther apart
};

/// Returns the trunk, the neck, collarbones, arms, legs and feet of humans, and the upper bones of animals' legs, as
/// far as both bodies have them.
std::vector<SharedBone> list_shared_bones(const Retarget& retarget);

/// Returns the angle between the directions of a bone in two poses, radians; 0 if it has no length.
/// \param turn  see Retarget::turn
double angle_of(const SharedBone& bone, Pose& source, Pose& target, const glm::dquat& turn);

}  // namespace bendy::motion
