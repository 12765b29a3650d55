// lanes.h for WebAssembly SIMD, and what else the kernels need from that instruction set. Each source includes it in
// its own namespace.

#undef BENDY_LANES
#define BENDY_LANES 4

// NOLINTBEGIN(portability-simd-intrinsics,misc-definitions-in-headers): this is the purpose of the file
#include "lane_types.h"

inline Lanes roots_of(Lanes squares) {
    return reinterpret_cast<Lanes>(wasm_f32x4_sqrt(reinterpret_cast<v128_t>(squares)));
}
inline v128_t as_v128(Lanes lanes) {
    return reinterpret_cast<v128_t>(lanes);
}
inline Lanes between(Lanes lanes, Lanes least, Lanes most) {
    return reinterpret_cast<Lanes>(wasm_f32x4_pmin(as_v128(most), wasm_f32x4_pmax(as_v128(least), as_v128(lanes))));
}
inline Lanes inverse_roots_of(Lanes squares) {
    return 1.0f / reinterpret_cast<Lanes>(wasm_f32x4_sqrt(as_v128(squares)));
}
inline void stream(float* to, Quad quad) {
    __builtin_memcpy(to, &quad, sizeof quad);
}
inline void end_streams() {}

#include "lanes.h"
// NOLINTEND(portability-simd-intrinsics,misc-definitions-in-headers)
