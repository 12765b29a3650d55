// lanes.h for SSE 4.1, and what else the kernels need from that instruction set. Each source includes it in its own
// namespace.

#undef BENDY_LANES
#define BENDY_LANES 4

// NOLINTBEGIN(portability-simd-intrinsics,misc-definitions-in-headers): this is the purpose of the file
#include "lane_types.h"

inline Lanes roots_of(Lanes squares) {
    return _mm_sqrt_ps(squares);
}
inline Lanes between(Lanes lanes, Lanes least, Lanes most) {
    return _mm_min_ps(_mm_max_ps(lanes, least), most);
}
inline Lanes inverse_roots_of(Lanes squares) {
    const Lanes guess = _mm_rsqrt_ps(squares);  // 12 bits; one step of Newton's method gives 23
    return guess + 0.5f * guess * (1.0f - squares * guess * guess);
}
inline void stream(float* to, Quad quad) {
    _mm_stream_ps(to, quad);
}
inline void end_streams() {
    _mm_sfence();
}

#include "lanes.h"
// NOLINTEND(portability-simd-intrinsics,misc-definitions-in-headers)
