#pragma once

#include <bendy/format/document.h>
#include <bendy/runtime/palette_matrix.h>
#include <bendy/runtime/transform.h>

#include <glm/mat4x4.hpp>

#include "blocks.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// How the joints of a pose and the entries of a palette lie in memory.
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

/// Returns the upper three rows of a matrix, as floats.
inline PaletteMatrix to_rows(const glm::dmat4& matrix) {
    PaletteMatrix entry{};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) entry.rows[row][column] = static_cast<float>(matrix[column][row]);
    }
    return entry;
}

}  // namespace bendy
