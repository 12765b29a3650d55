#include "pose_kernels.h"

#if defined(__AVX2__)

#include <immintrin.h>

#define BENDY_LANES 8

// NOLINTBEGIN(portability-simd-intrinsics): that is what this file is
namespace bendy {
namespace {

constexpr std::size_t kLanes = 8;
using Lanes = float __attribute__((vector_size(32)));
using Quad = float __attribute__((vector_size(16)));

inline Lanes roots_of(Lanes squares) {
    return _mm256_sqrt_ps(squares);
}
inline Lanes repeat(const float* quad) {
    return _mm256_broadcast_ps(reinterpret_cast<const __m128*>(quad));
}

#include "lanes.h"

#include "blend_lanes.h"
#include "pose_lanes.h"
#include "read_avx2.h"
#include "sample_lanes.h"

#include "unpack_lanes.h"

}  // namespace

const PoseKernels kPoseAvx2{pose_lanes,   palette_lanes,           sample_lanes,
                            unpack_lanes, blend_lanes<mix_joints>, blend_lanes<add_joints>};

}  // namespace bendy
// NOLINTEND(portability-simd-intrinsics)

#endif
