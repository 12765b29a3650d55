#include "pose_kernels.h"

#include <bendy/format/processor.h>

#if defined(BENDY_WASM_SIMD)

#include <bendy/format/public.h>

#include <cstdint>
#include <cstring>

#include <wasm_simd128.h>

namespace bendy {
namespace pose_with_wasm {
namespace {

#include "lanes_wasm.h"

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
}  // namespace pose_with_wasm

const PoseKernels kPoseWasm{pose_with_wasm::pose_lanes,
                            pose_with_wasm::pose_subtree_lanes,
                            pose_with_wasm::palette_lanes,
                            pose_with_wasm::poses_lanes,
                            pose_with_wasm::palettes_lanes,
                            pose_with_wasm::sample_lanes,
                            pose_with_wasm::sample_cubic_lanes,
                            pose_with_wasm::unpack_lanes,
                            pose_with_wasm::decode_boxed_lanes,
                            pose_with_wasm::decode_directions_lanes,
                            pose_with_wasm::blend_lanes<pose_with_wasm::mix_joints>,
                            pose_with_wasm::blend_lanes<pose_with_wasm::add_joints>,
                            nullptr};

}  // namespace bendy

#endif
