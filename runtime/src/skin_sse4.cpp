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

inline Lanes roots_of(Lanes squares) {
    return _mm_sqrt_ps(squares);
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
