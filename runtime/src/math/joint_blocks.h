#pragma once

#include <bendy/runtime/transform.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// The joints of a pose in blocks of eight: see JointBlock.
namespace bendy {

inline JointTransform joint_in(std::span<const JointBlock> blocks, std::uint32_t joint) {
    return blocks[joint / JointBlock::kJoints].joint(joint % JointBlock::kJoints);
}

inline void set_joint_in(std::span<JointBlock> blocks, std::uint32_t joint, const JointTransform& transform) {
    blocks[joint / JointBlock::kJoints].set_joint(joint % JointBlock::kJoints, transform);
}

inline std::vector<JointBlock> to_blocks(std::span<const JointTransform> joints) {
    std::vector<JointBlock> blocks((joints.size() + JointBlock::kJoints - 1) / JointBlock::kJoints);
    for (std::uint32_t joint = 0; joint < joints.size(); ++joint) set_joint_in(blocks, joint, joints[joint]);
    return blocks;
}

}  // namespace bendy
