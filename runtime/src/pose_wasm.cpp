#include "pose_kernels.h"

#if defined(__wasm_simd128__)

#include <wasm_simd128.h>

#define BENDY_LANES 4

// NOLINTBEGIN(portability-simd-intrinsics): that is what this file is
namespace bendy {
namespace {

constexpr std::size_t kLanes = 4;
using Lanes = float __attribute__((vector_size(16)));
using Quad = Lanes;

inline Lanes roots_of(Lanes squares) {
    return reinterpret_cast<Lanes>(wasm_f32x4_sqrt(reinterpret_cast<v128_t>(squares)));
}
inline Lanes repeat(const float* quad) {
    Lanes lanes;
    __builtin_memcpy(&lanes, quad, sizeof lanes);
    return lanes;
}

#include "lanes.h"

#include "blend_lanes.h"
#include "pose_lanes.h"
#include "read_lanes.h"
#include "sample_lanes.h"

#include "unpack_lanes.h"

}  // namespace

const PoseKernels kPoseWasm{pose_lanes,   palette_lanes,           sample_lanes,
                            unpack_lanes, blend_lanes<mix_joints>, blend_lanes<add_joints>};

}  // namespace bendy
// NOLINTEND(portability-simd-intrinsics)

#endif
