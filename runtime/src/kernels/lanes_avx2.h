// lanes.h for AVX2 and FMA, and what else the kernels need from that instruction set. Each source includes it in its
// own namespace.

#undef BENDY_LANES
#define BENDY_LANES 8

// NOLINTBEGIN(portability-simd-intrinsics,misc-definitions-in-headers): this is the purpose of the file
#include "lane_types.h"

inline Lanes roots_of(Lanes squares) {
    return _mm256_sqrt_ps(squares);
}
inline Lanes repeat(const float* quad) {
    return _mm256_broadcast_ps(reinterpret_cast<const __m128*>(quad));
}
inline Lanes between(Lanes lanes, Lanes least, Lanes most) {
    return _mm256_min_ps(_mm256_max_ps(lanes, least), most);
}
inline Lanes inverse_roots_of(Lanes squares) {
    const Lanes guess = _mm256_rsqrt_ps(squares);  // 12 bits; one step of Newton's method gives 23
    return guess + 0.5f * guess * (1.0f - squares * guess * guess);
}
/// Lane k: lane places[k] of `lanes`.
inline Lanes permuted(Lanes lanes, Integers places) {
    return _mm256_permutevar8x32_ps(lanes, reinterpret_cast<__m256i>(places));
}
inline void stream(float* to, Quad quad) {
    _mm_stream_ps(to, quad);
}
inline void stream(float* to, Lanes lanes) {
    _mm_stream_ps(to, _mm256_castps256_ps128(lanes));  // in halves, which only need alignment to 16 bytes
    _mm_stream_ps(to + 4, _mm256_extractf128_ps(lanes, 1));
}
inline void end_streams() {
    _mm_sfence();
}

#include "lanes.h"
// NOLINTEND(portability-simd-intrinsics,misc-definitions-in-headers)
