#include "skin_block.h"

#if defined(__wasm_simd128__)

#include <wasm_simd128.h>

#define BENDY_LANES 4

// NOLINTBEGIN(portability-simd-intrinsics): that is what this file is
namespace bendy {
namespace {

constexpr std::size_t kLanes = 4;
using Lanes = float __attribute__((vector_size(16)));
using Quad = Lanes;

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
#include "skin_lanes.h"

}  // namespace

void skin_wasm(const SkinBlock& block) {
    skin_lanes(block);
}

}  // namespace bendy
// NOLINTEND(portability-simd-intrinsics)

#endif
