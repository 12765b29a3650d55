#include "skin_block.h"

#if defined(__AVX512F__) && defined(__AVX512VL__) && defined(__AVX512DQ__)

#include <immintrin.h>

// NOLINTBEGIN(portability-simd-intrinsics): that is what this file is
#undef BENDY_LANES
#define BENDY_LANES 16

namespace bendy {
namespace skin_with_avx512 {
namespace {

#include "lane_types.h"

constexpr __mmask16 kAll = 0xffff;  // g++ 12 warns of its own header where there is no mask

inline Lanes between(Lanes lanes, Lanes least, Lanes most) {
    return _mm512_maskz_min_ps(kAll, _mm512_maskz_max_ps(kAll, lanes, least), most);
}
inline Lanes inverse_roots_of(Lanes squares) {
    const Lanes guess = _mm512_maskz_rsqrt14_ps(kAll, squares);  // 14 bits; a step of Newton's method makes 24
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

#include "dual_lanes.h"

}  // namespace
}  // namespace skin_with_avx512

void skin_avx512(const SkinBlock& block) {
    skin_with_avx512::skin_lanes(block);
}

void dual_avx512(const DualBlock& block) {
    skin_with_avx512::dual_lanes(block);
}

}  // namespace bendy
// NOLINTEND(portability-simd-intrinsics)

#endif
