#pragma once

#include "fields.h"
#include "joint_key.h"
#include "rest_frames.h"

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

/// The axes of a bone at rest when its limits were written.
struct BoneAxes {
    Rotation in_file;      ///< model space
    Rotation in_armature;  ///< the space of the node above the bones
};

/// The constraints that node.extras.rig_joint gives a bone in Blender's terms (spec/rig.md), in the axes of that time:
/// at most one of each scope, the rest pose perhaps outside. What cannot be held as it is gets the flag and is named in
/// `report`. Fails at the JSON path of what is wrong.
std::vector<ConstraintRecord> read_blender_limits(Fields& fields, const BoneAxes& bone, Report& report);

/// The skeleton that Blender's chains are read against.
struct BlenderRig {
    const Scene& scene;
    const JointIndex& index;
    const RestFrames& rest;
    std::vector<Rotation> axes;  ///< by joint: its axes in model space when the rig was written
    std::vector<float> stretch;  ///< by joint: how readily the bone grows for IK; 0 not at all
};

/// A chain of rig_ik as Blender has it (spec/rig.md). \param node  the joint whose extras these are, the armature;
/// kNone: the scene. What the records cannot hold is flagged and named in `report`. Fails at the JSON path of what is
/// wrong.
Chain read_blender_chain(Fields& fields, std::uint32_t node, const BlenderRig& rig, WorkBudget& budget, Report& report);

}  // namespace bendy::converter
