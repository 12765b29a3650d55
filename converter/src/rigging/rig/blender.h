#pragma once

#include "fields.h"
#include "joint_key.h"
#include "scene/rest_frames.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/records.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace bendy::converter {

/// Angles about X, Y, Z, radians, with rotation = R(last axis) * R(middle) * R(first); the middle one within +-pi/2.
std::array<double, 3> to_euler(const Rotation& rotation, EulerOrder order);

/// A bone's rest axes at the time its limits were written.
struct BoneAxes {
    Rotation in_file;      ///< model space
    Rotation in_armature;  ///< in the space of the node above the bones
};

/// Reads the constraints that node.extras.rig_joint gives a bone in Blender's terms (spec/rig.md), in the axes of that
/// time: at most one of each scope; the rest pose may be outside. Approximations are flagged and named in `report`.
/// Fails at the JSON path of an error.
std::vector<ConstraintRecord> read_blender_limits(Fields& fields, const BoneAxes& bone, Report& report);

/// The skeleton to which Blender's chains refer.
struct BlenderRig {
    const Scene& scene;
    const JointIndex& index;
    const RestFrames& rest;
    std::vector<Rotation> axes;  ///< by joint: its axes in model space when the rig was written
    std::vector<float> stretch;  ///< by joint: how readily the bone stretches for IK; 0 not at all
};

/// Reads a chain of rig_ik as Blender writes it (spec/rig.md). Approximations are flagged and named in `report`. Fails
/// at the JSON path of an error.
/// \param node  the joint with these extras, the armature; kNone: the scene
Chain read_blender_chain(Fields& fields, std::uint32_t node, const BlenderRig& rig, WorkBudget& budget, Report& report);

}  // namespace bendy::converter
