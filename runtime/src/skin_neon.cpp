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

inline Lanes between(Lanes lanes, Lanes least, Lanes most) {
    return vminq_f32(vmaxq_f32(lanes, least), most);
}
inline Lanes inverse_roots_of(Lanes squares) {
    const Lanes guess = vrsqrteq_f32(squares);  // 8 bits; each step of Newton's method doubles them
    const Lanes better = guess * vrsqrtsq_f32(squares * guess, guess);
    return better + 0.5f * better * (1.0f - squares * better * better);
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
