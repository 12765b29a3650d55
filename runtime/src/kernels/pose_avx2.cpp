#include "pose_kernels.h"

#include <bendy/format/processor.h>

#if defined(BENDY_X86_64)

#include <bendy/format/public.h>

#include <cstdint>
#include <cstring>

#include <immintrin.h>

namespace bendy {
namespace pose_with_avx2 {
namespace {

#include "lanes_avx2.h"

#include "joint_lanes.h"
#include "store_lanes.h"

#include "blend_lanes.h"
#include "decode_lanes.h"
#include "pose_lanes.h"
#include "poses_lanes.h"
#include "read_avx2.h"
#include "sample_lanes.h"

#include "unpack_lanes.h"

}  // namespace
}  // namespace pose_with_avx2

const PoseKernels kPoseAvx2{pose_with_avx2::pose_lanes,
                            pose_with_avx2::pose_subtree_lanes,
                            pose_with_avx2::palette_lanes,
                            pose_with_avx2::poses_lanes,
                            pose_with_avx2::palettes_lanes,
                            pose_with_avx2::sample_lanes,
                            pose_with_avx2::sample_cubic_lanes,
                            pose_with_avx2::unpack_lanes,
                            pose_with_avx2::decode_boxed_lanes,
                            pose_with_avx2::decode_directions_lanes,
                            pose_with_avx2::blend_lanes<pose_with_avx2::mix_joints>,
                            pose_with_avx2::blend_lanes<pose_with_avx2::add_joints>,
                            two_bones_avx2};

}  // namespace bendy

#endif
