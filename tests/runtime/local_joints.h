#pragma once

#include <bendy/runtime/pose.h>

#include <cstddef>
#include <cstdint>
#include <vector>

// The local transforms of a pose, for tests that look at many of them or change single numbers.
namespace bendy::test {

/// A joint's transform, which goes back into the pose at the end of the expression or scope:
/// `local_of(pose, 1)->translation.x = 7.0f;`
class LocalJoint {
public:
    LocalJoint(Pose& pose, std::uint32_t joint) : pose_(pose), joint_(joint), transform_(pose.local(joint)) {}
    LocalJoint(const LocalJoint&) = delete;
    LocalJoint& operator=(const LocalJoint&) = delete;
    ~LocalJoint() { pose_.set_local(joint_, transform_); }
    JointTransform* operator->() { return &transform_; }
    JointTransform& operator*() { return transform_; }

private:
    Pose& pose_;
    std::uint32_t joint_;
    JointTransform transform_;
};

inline LocalJoint local_of(Pose& pose, std::uint32_t joint) {
    return {pose, joint};
}

inline std::vector<JointTransform> locals_of(const Pose& pose) {
    std::vector<JointTransform> locals;
    for (std::uint32_t joint = 0; joint < pose.model().joints().size(); ++joint) locals.push_back(pose.local(joint));
    return locals;
}

/// Calls change(transform) for every joint.
template <class Change>
void change_locals(Pose& pose, const Change& change) {
    for (std::uint32_t joint = 0; joint < pose.model().joints().size(); ++joint) change(*local_of(pose, joint));
}

}  // namespace bendy::test
