#include "pose_kernels.h"

#if defined(__AVX2__)

#include "lanes_avx2.h"

namespace bendy {
namespace {

#include "blend_lanes.h"
#include "pose_lanes.h"
#include "read_avx2.h"
#include "sample_lanes.h"

#include "unpack_lanes.h"

}  // namespace

const PoseKernels kPoseAvx2{pose_lanes,   palette_lanes,           sample_lanes,
                            unpack_lanes, blend_lanes<mix_joints>, blend_lanes<add_joints>};

}  // namespace bendy

#endif
