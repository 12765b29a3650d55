#pragma once

#include <bendy.h>
#include <bendy/runtime/transform.h>

namespace bendy::capi {

inline bendy_transform to_c(const JointTransform& from) {
    return {{from.rotation.x, from.rotation.y, from.rotation.z, from.rotation.w},
            {from.translation.x, from.translation.y, from.translation.z},
            {from.scale.x, from.scale.y, from.scale.z}};
}

inline JointTransform from_c(const bendy_transform& from) {
    return {glm::quat(from.rotation[3], from.rotation[0], from.rotation[1], from.rotation[2]),
            {from.translation[0], from.translation[1], from.translation[2]},
            {from.scale[0], from.scale[1], from.scale[2]}};
}

}  // namespace bendy::capi
