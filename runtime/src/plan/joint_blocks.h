#pragma once

#include <bendy/format/document.h>
#include <bendy/runtime/transform.h>

#include "sample_block.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// The joints of a pose in blocks of eight: see JointBlock.
namespace bendy {

static_assert(JointBlock::kJoints == kBlockJoints && sizeof(JointBlock) == kBlockFloats * sizeof(float) &&
              offsetof(JointBlock, translation) == kTranslation * sizeof(float) &&
              offsetof(JointBlock, scale) == kScale * sizeof(float));

/// Returns the offset in floats from the first block to the first number of a joint's property.
inline std::uint32_t place_of(std::uint32_t joint, TrackPath path) {
    const std::uint32_t property = path == TrackPath::rotation      ? kRotation
                                   : path == TrackPath::translation ? kTranslation
                                                                    : kScale;
    return joint / kBlockJoints * kBlockFloats + property + joint % kBlockJoints;
}

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
