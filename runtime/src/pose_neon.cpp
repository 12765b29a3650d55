#include "pose_kernels.h"

#if defined(__aarch64__)

#include "lanes_neon.h"

namespace bendy {
namespace {

#include "blend_lanes.h"
#include "pose_lanes.h"
#include "read_lanes.h"
#include "sample_lanes.h"

#include "unpack_lanes.h"

}  // namespace

const PoseKernels kPoseNeon{pose_lanes,   palette_lanes,           sample_lanes,
                            unpack_lanes, blend_lanes<mix_joints>, blend_lanes<add_joints>};

}  // namespace bendy

#endif
