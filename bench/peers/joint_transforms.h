#pragma once

#include <bendy/runtime.h>

#include <algorithm>
#include <cstdint>

// All that the harness does with the local transforms of our poses.
namespace bendy::bench {

inline JointTransform local_of(const Pose& pose, std::uint32_t joint) {
    return pose.local(joint);
}

inline void set_local(Pose& pose, std::uint32_t joint, const JointTransform& transform) {
    pose.set_local(joint, transform);
}

/// Has the pose compute its matrices again, as if a joint had moved.
inline void mark_changed(Pose& pose) {
    (void)pose.change_local_blocks();
}

inline void copy_locals(const Pose& from, Pose& to) {
    std::ranges::copy(from.local_blocks(), to.change_local_blocks().begin());
}

}  // namespace bendy::bench
