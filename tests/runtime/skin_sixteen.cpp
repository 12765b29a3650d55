// The body of the kernel of sixteen lanes for a machine of eight: the compiler splits the vectors. Tests run it where
// there is no AVX-512.

#include "skin_block.h"

#if defined(__AVX2__)

#include <immintrin.h>

#define BENDY_LANES 16

// NOLINTBEGIN(portability-simd-intrinsics): as in skin_avx512.cpp
namespace bendy {
namespace {

#include "lane_types.h"

inline Lanes between(Lanes lanes, Lanes least, Lanes most) {
    for (std::size_t k = 0; k < kLanes; ++k) {
        lanes[k] = lanes[k] < least[k] ? least[k] : lanes[k];
        lanes[k] = lanes[k] > most[k] ? most[k] : lanes[k];
    }
    return lanes;
}
inline Lanes inverse_roots_of(Lanes squares) {
    for (std::size_t k = 0; k < kLanes; ++k) squares[k] = 1.0f / __builtin_sqrtf(squares[k]);
    return squares;
}
inline void stream(float* to, Quad quad) {
    _mm_stream_ps(to, quad);
}
inline void end_streams() {
    _mm_sfence();
}

#include "lanes.h"
#include "skin_lanes.h"

#include "dual_lanes.h"

}  // namespace

void skin_sixteen(const SkinBlock& block);
void skin_sixteen(const SkinBlock& block) {
    skin_lanes(block);
}

void dual_sixteen(const DualBlock& block);
void dual_sixteen(const DualBlock& block) {
    dual_lanes(block);
}

}  // namespace bendy
// NOLINTEND(portability-simd-intrinsics)

#endif
