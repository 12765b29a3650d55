#include "unpack_plain.h"

#include "joint_blocks.h"
#include "unpack_plan.h"

#include <array>
#include <cstddef>

namespace bendy {
namespace {

std::array<double, 3> numbers_of(const std::array<std::array<float, kPackedGroup>, 3>& numbers, std::uint32_t track) {
    return {numbers[0][track], numbers[1][track], numbers[2][track]};
}

}  // namespace

void set_unpacked(const PackedGroup& group, std::uint32_t track, double u, JointTransform& joint) {
    const std::array<double, 3> left = numbers_of(group.left, track);
    const std::array<double, 3> right = numbers_of(group.right, track);
    if (group.kind.path == TrackPath::rotation) {
        const glm::quat& rest = joint.rotation;
        const auto q = blend_packed_rotations({rest.x, rest.y, rest.z, rest.w}, left, right, u);
        joint.rotation = glm::quat(static_cast<float>(q[3]), static_cast<float>(q[0]), static_cast<float>(q[1]),
                                   static_cast<float>(q[2]));
        return;
    }
    glm::vec3& vector = group.kind.path == TrackPath::translation ? joint.translation : joint.scale;
    for (int c = 0; c < 3; ++c) {
        const auto at = static_cast<std::size_t>(c);
        vector[c] = static_cast<float>(vector[c] + (1.0 - u) * left[at] + u * right[at]);
    }
}

void unpack_plain(const UnpackPlan& plan, float seconds, std::size_t joints, std::span<JointBlock> local) {
    const PackedView& packed = *plan.packed;
    if (packed.record.joints > joints) return;
    const PackedMoment moment = packed_moment(packed, seconds);
    PackedGroupReader reader(packed, moment.frame);
    for (PackedGroup group; reader.next(group);) {
        for (std::uint32_t track = 0; track < group.count; ++track) {
            JointTransform joint = joint_in(local, group.joints[track]);
            set_unpacked(group, track, moment.fraction, joint);
            set_joint_in(local, group.joints[track], joint);
        }
    }
}

}  // namespace bendy
