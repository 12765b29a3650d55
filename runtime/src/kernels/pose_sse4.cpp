#include "pose_kernels.h"

#include <bendy/format/processor.h>

#if defined(BENDY_X86_64)

#include <bendy/format/public.h>

#include <cstdint>
#include <cstring>

#include <immintrin.h>

namespace bendy {
namespace pose_with_sse4 {
namespace {

#include "lanes_sse4.h"

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
}  // namespace pose_with_sse4

const PoseKernels kPoseSse4{pose_with_sse4::pose_lanes,
                            pose_with_sse4::pose_subtree_lanes,
                            pose_with_sse4::palette_lanes,
                            pose_with_sse4::poses_lanes,
                            pose_with_sse4::palettes_lanes,
                            pose_with_sse4::sample_lanes,
                            pose_with_sse4::sample_cubic_lanes,
                            pose_with_sse4::unpack_lanes,
                            pose_with_sse4::decode_boxed_lanes,
                            pose_with_sse4::decode_directions_lanes,
                            pose_with_sse4::blend_lanes<pose_with_sse4::mix_joints>,
                            pose_with_sse4::blend_lanes<pose_with_sse4::add_joints>,
                            nullptr};

}  // namespace bendy

#endif
