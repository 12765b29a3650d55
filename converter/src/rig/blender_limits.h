#pragma once

#include "fields.h"
#include "rest_frames.h"

#include <bendy/converter/report.h>
#include <bendy/format/records.h>

#include <string>
#include <vector>

namespace bendy::converter {

/// The axes of a bone at rest when its limits were written.
struct BoneAxes {
    Rotation in_file;      ///< model space
    Rotation in_armature;  ///< the space of the node above the bones
};

/// The constraints that node.extras.rig_joint gives a bone in Blender's terms (spec/rig.md), in the axes of that time:
/// at most one of each scope, the rest pose perhaps outside. What cannot be held as it is gets the flag and is named in
/// `report`. Fails at the JSON path of what is wrong.
std::vector<LimitRecord> read_blender_limits(Fields& fields, const BoneAxes& bone, Report& report);

}  // namespace bendy::converter
