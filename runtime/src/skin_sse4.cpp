#include "skin_block.h"

#if defined(__SSE4_1__)

#include <immintrin.h>

#define BENDY_LANES 4

// NOLINTBEGIN(portability-simd-intrinsics): that is what this file is
namespace bendy {
namespace {

constexpr std::size_t kLanes = 4;
using Lanes = float __attribute__((vector_size(16)));
using Quad = Lanes;

inline Lanes between(Lanes lanes, Lanes least, Lanes most) {
    return _mm_min_ps(_mm_max_ps(lanes, least), most);
}
inline Lanes inverse_roots_of(Lanes squares) {
    const Lanes guess = _mm_rsqrt_ps(squares);  // 12 bits; a step of Newton's method makes 23
    return guess + 0.5f * guess * (1.0f - squares * guess * guess);
}
inline void stream(float* to, Quad quad) {
    _mm_stream_ps(to, quad);
}
inline void end_streams() {
    _mm_sfence();
}

#include "lanes.h"
#include "skin_lanes.h"

}  // namespace

void skin_sse4(const SkinBlock& block) {
    skin_lanes(block);
}

}  // namespace bendy
// NOLINTEND(portability-simd-intrinsics)

#endif
