#include "skin_block.h"

#if defined(__aarch64__)

#include <arm_neon.h>

#define BENDY_LANES 4

// NOLINTBEGIN(portability-simd-intrinsics): that is what this file is
namespace bendy {
namespace {

constexpr std::size_t kLanes = 4;
using Lanes = float __attribute__((vector_size(16)));
using Quad = Lanes;

inline Lanes roots_of(Lanes squares) {
    return vsqrtq_f32(squares);
}
inline void stream(float* to, Quad quad) {
    vst1q_f32(to, quad);
}
inline void end_streams() {}

#include "lanes.h"
#include "skin_lanes.h"

}  // namespace

void skin_neon(const SkinBlock& block) {
    skin_lanes(block);
}

}  // namespace bendy
// NOLINTEND(portability-simd-intrinsics)

#endif
