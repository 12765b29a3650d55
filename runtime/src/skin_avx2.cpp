#include "skin_block.h"

#if defined(__AVX2__)

#include <immintrin.h>

#define BENDY_LANES 8

// NOLINTBEGIN(portability-simd-intrinsics): that is what this file is
namespace bendy {
namespace {

constexpr std::size_t kLanes = 8;
using Lanes = float __attribute__((vector_size(32)));
using Eight = Lanes;
using Quad = float __attribute__((vector_size(16)));

inline Lanes between(Lanes lanes, Lanes least, Lanes most) {
    return _mm256_min_ps(_mm256_max_ps(lanes, least), most);
}
inline Lanes inverse_roots_of(Lanes squares) {
    const Lanes guess = _mm256_rsqrt_ps(squares);  // 12 bits; a step of Newton's method makes 23
    return guess + 0.5f * guess * (1.0f - squares * guess * guess);
}
inline void stream(float* to, Quad quad) {
    _mm_stream_ps(to, quad);
}
inline void stream(float* to, Lanes lanes) {
    _mm_stream_ps(to, _mm256_castps256_ps128(lanes));  // in halves, which need to be aligned to 16 bytes only
    _mm_stream_ps(to + 4, _mm256_extractf128_ps(lanes, 1));
}
inline void end_streams() {
    _mm_sfence();
}

#include "lanes.h"
#include "skin_lanes.h"

}  // namespace

void skin_avx2(const SkinBlock& block) {
    skin_lanes(block);
}

}  // namespace bendy
// NOLINTEND(portability-simd-intrinsics)

#endif
