// lanes.h for WebAssembly SIMD. Each source includes it in its own namespace.

#undef BENDY_LANES
#define BENDY_LANES 4

// NOLINTBEGIN(portability-simd-intrinsics,misc-definitions-in-headers): this is the purpose of the file
struct Quad {
    v128_t v;

    Quad() = default;
    // NOLINTNEXTLINE(google-explicit-constructor): what intrinsics return
    BENDY_ALWAYS_INLINE Quad(v128_t numbers) : v(numbers) {}
    // NOLINTNEXTLINE(google-explicit-constructor): a number stands for four, as in `0.5f * quad`
    BENDY_ALWAYS_INLINE Quad(float number) : v(wasm_f32x4_splat(number)) {}
};

BENDY_ALWAYS_INLINE Quad operator+(Quad a, Quad b) {
    return wasm_f32x4_add(a.v, b.v);
}
BENDY_ALWAYS_INLINE Quad operator-(Quad a, Quad b) {
    return wasm_f32x4_sub(a.v, b.v);
}
BENDY_ALWAYS_INLINE Quad operator*(Quad a, Quad b) {
    return wasm_f32x4_mul(a.v, b.v);
}
BENDY_ALWAYS_INLINE Quad operator/(Quad a, Quad b) {
    return wasm_f32x4_div(a.v, b.v);
}
BENDY_ALWAYS_INLINE Quad operator&(Quad a, Quad b) {
    return wasm_v128_and(a.v, b.v);
}
BENDY_ALWAYS_INLINE Quad operator|(Quad a, Quad b) {
    return wasm_v128_or(a.v, b.v);
}
BENDY_ALWAYS_INLINE Quad operator^(Quad a, Quad b) {
    return wasm_v128_xor(a.v, b.v);
}
BENDY_ALWAYS_INLINE Quad operator-(Quad a) {
    return wasm_f32x4_neg(a.v);
}
BENDY_ALWAYS_INLINE Quad& operator+=(Quad& a, Quad b) {
    return a = a + b;
}
using Lanes = Quad;

/// a * b + c
BENDY_ALWAYS_INLINE Quad fused(Quad a, Quad b, Quad c) {
    return a * b + c;
}
BENDY_ALWAYS_INLINE Quad fused_difference(Quad a, Quad b, Quad c) {
    return a * b - c;
}
BENDY_ALWAYS_INLINE Quad load_quad(const float* from) {
    return wasm_v128_load(from);
}
BENDY_ALWAYS_INLINE void store(float* to, Quad quad) {
    wasm_v128_store(to, quad.v);
}
BENDY_ALWAYS_INLINE void store_three_of(float* to, Quad quad) {
    wasm_v128_store64_lane(to, quad.v, 0);
    wasm_v128_store32_lane(to + 2, quad.v, 2);
}
/// Elements a and b of x, c and d of y.
template <int a, int b, int c, int d>
BENDY_ALWAYS_INLINE Quad shuffle(Quad x, Quad y) {
    return wasm_i32x4_shuffle(x.v, y.v, a, b, 4 + c, 4 + d);
}
BENDY_ALWAYS_INLINE float first_of(Quad quad) {
    return wasm_f32x4_extract_lane(quad.v, 0);
}
/// Broadcasts one number.
template <int place>
BENDY_ALWAYS_INLINE Quad everywhere(Quad quad) {
    return wasm_i32x4_shuffle(quad.v, quad.v, place, place, place, place);
}
BENDY_ALWAYS_INLINE Quad from_integers(const std::int32_t (&numbers)[4]) {
    return wasm_f32x4_convert_i32x4(wasm_i32x4_make(numbers[0], numbers[1], numbers[2], numbers[3]));
}
/// x < y ? x : y
BENDY_ALWAYS_INLINE Quad lesser(Quad x, Quad y) {
    return wasm_f32x4_pmin(y.v, x.v);
}
/// All bits of each number that is negative, and none of the others.
BENDY_ALWAYS_INLINE Quad negatives(Quad quad) {
    return wasm_f32x4_lt(quad.v, wasm_f32x4_splat(0.0f));
}
BENDY_ALWAYS_INLINE Quad load_mask(const std::uint32_t* from) {
    return wasm_v128_load(from);
}
/// a where all bits of the mask are set, b where none is.
BENDY_ALWAYS_INLINE Quad chosen(Quad mask, Quad a, Quad b) {
    return wasm_v128_bitselect(a.v, b.v, mask.v);
}
BENDY_ALWAYS_INLINE Quad roots_of(Quad squares) {
    return wasm_f32x4_sqrt(squares.v);
}
BENDY_ALWAYS_INLINE Quad between(Quad quad, Quad least, Quad most) {
    return wasm_f32x4_pmin(most.v, wasm_f32x4_pmax(least.v, quad.v));
}
BENDY_ALWAYS_INLINE Quad inverse_roots_of(Quad squares) {
    return 1.0f / Quad(wasm_f32x4_sqrt(squares.v));
}

BENDY_ALWAYS_INLINE Lanes load_integers(const std::uint8_t* from) {
    return wasm_f32x4_convert_u32x4(
        wasm_u32x4_extend_low_u16x8(wasm_u16x8_extend_low_u8x16(wasm_v128_load32_zero(from))));
}
BENDY_ALWAYS_INLINE Lanes load_integers(const std::int8_t* from) {
    return wasm_f32x4_convert_i32x4(
        wasm_i32x4_extend_low_i16x8(wasm_i16x8_extend_low_i8x16(wasm_v128_load32_zero(from))));
}
BENDY_ALWAYS_INLINE Lanes load_integers(const std::uint16_t* from) {
    return wasm_f32x4_convert_u32x4(wasm_u32x4_load16x4(from));
}
BENDY_ALWAYS_INLINE Lanes load_integers(const std::int16_t* from) {
    return wasm_f32x4_convert_i32x4(wasm_i32x4_load16x4(from));
}
BENDY_ALWAYS_INLINE Lanes load_integers(const std::uint32_t* from) {
    return wasm_f32x4_convert_u32x4(wasm_v128_load(from));
}

#include "lanes.h"
// NOLINTEND(portability-simd-intrinsics,misc-definitions-in-headers)
