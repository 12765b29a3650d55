#include "pose_kernels.h"

#include <bendy/format/processor.h>

#if defined(BENDY_ARM64)

#include <bendy/format/public.h>

#include <cstdint>
#include <cstring>

#include <arm_neon.h>

namespace bendy {
namespace pose_with_neon {
namespace {

#include "lanes_neon.h"

#include "joint_lanes.h"
#include "store_lanes.h"

#include "blend_lanes.h"
#include "decode_lanes.h"
#include "pose_lanes.h"
#include "poses_lanes.h"
#include "read_lanes.h"
#include "sample_lanes.h"

#include "unpack_lanes.h"

}  // namespace
}  // namespace pose_with_neon

const PoseKernels kPoseNeon{pose_with_neon::pose_lanes,
                            pose_with_neon::pose_subtree_lanes,
                            pose_with_neon::palette_lanes,
                            pose_with_neon::poses_lanes,
                            pose_with_neon::palettes_lanes,
                            pose_with_neon::sample_lanes,
                            pose_with_neon::sample_cubic_lanes,
                            pose_with_neon::unpack_lanes,
                            pose_with_neon::decode_boxed_lanes,
                            pose_with_neon::decode_directions_lanes,
                            pose_with_neon::blend_lanes<pose_with_neon::mix_joints>,
                            pose_with_neon::blend_lanes<pose_with_neon::add_joints>,
                            nullptr};

}  // namespace bendy

#endif
