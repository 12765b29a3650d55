// lanes.h for 64-bit ARM, and what else the kernels need from that instruction set. Each source includes it in its own
// namespace.

#undef BENDY_LANES
#define BENDY_LANES 4

// NOLINTBEGIN(portability-simd-intrinsics,misc-definitions-in-headers): this is the purpose of the file
#include "lane_types.h"

inline Lanes roots_of(Lanes squares) {
    return vsqrtq_f32(squares);
}
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
// NOLINTEND(portability-simd-intrinsics,misc-definitions-in-headers)
