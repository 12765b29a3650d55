#pragma once

#include "effort.h"
#include "fields.h"
#include "joint_index.h"
#include "rest_frames.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <cstdint>
#include <vector>

namespace bendy::converter {

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
Chain read_blender_chain(Fields& fields, std::uint32_t node, const BlenderRig& rig, Effort& effort, Report& report);

}  // namespace bendy::converter
