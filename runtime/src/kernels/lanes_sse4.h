// lanes.h for SSE 4.1. Each source includes it in its own namespace.

#undef BENDY_LANES
#define BENDY_LANES 4

// NOLINTBEGIN(portability-simd-intrinsics,misc-definitions-in-headers): this is the purpose of the file
#include "quad_sse4.h"

using Lanes = Quad;

/// a * b + c
inline Quad fused(Quad a, Quad b, Quad c) {
    return a * b + c;
}
inline Quad fused_difference(Quad a, Quad b, Quad c) {
    return a * b - c;
}
inline Lanes from_integers(const std::int32_t (&numbers)[4]) {
    return _mm_cvtepi32_ps(_mm_setr_epi32(numbers[0], numbers[1], numbers[2], numbers[3]));
}
inline Lanes load_mask(const std::uint32_t* from) {
    return _mm_castsi128_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from)));
}
/// a where all bits of the mask are set, b where none is.
inline Lanes chosen(Lanes mask, Lanes a, Lanes b) {
    return _mm_blendv_ps(b.v, a.v, mask.v);
}
inline Lanes roots_of(Lanes squares) {
    return _mm_sqrt_ps(squares.v);
}
inline Lanes between(Lanes lanes, Lanes least, Lanes most) {
    return _mm_min_ps(_mm_max_ps(lanes.v, least.v), most.v);
}
inline Lanes inverse_roots_of(Lanes squares) {
    return 1.0f / roots_of(squares);  // not from _mm_rsqrt_ps, which differs between processors
}
/// By Lomont, "Fast Inverse Square Root", 2003: half the bits of a float, subtracted, halve and negate its exponent.
inline Lanes guess_inverse_roots(Lanes squares) {
    const __m128i half = _mm_srli_epi32(_mm_castps_si128(squares.v), 1);
    return _mm_castsi128_ps(_mm_sub_epi32(_mm_set1_epi32(0x5f37'5a86), half));
}

/// Four integers of one byte.
inline __m128i load_four_bytes(const void* from) {
    std::int32_t bytes = 0;
    std::memcpy(&bytes, from, sizeof bytes);
    return _mm_cvtsi32_si128(bytes);
}
inline Lanes load_integers(const std::uint8_t* from) {
    return _mm_cvtepi32_ps(_mm_cvtepu8_epi32(load_four_bytes(from)));
}
inline Lanes load_integers(const std::int8_t* from) {
    return _mm_cvtepi32_ps(_mm_cvtepi8_epi32(load_four_bytes(from)));
}
inline Lanes load_integers(const std::uint16_t* from) {
    return _mm_cvtepi32_ps(_mm_cvtepu16_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from))));
}
inline Lanes load_integers(const std::int16_t* from) {
    return _mm_cvtepi32_ps(_mm_cvtepi16_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from))));
}
inline Lanes load_integers(const std::uint32_t* from) {
    const __m128i all = _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
    const Lanes upper = _mm_cvtepi32_ps(_mm_srli_epi32(all, 16));
    const Lanes lower = _mm_cvtepi32_ps(_mm_and_si128(all, _mm_set1_epi32(0xffff)));
    return fused(upper, Lanes(65536.0f), lower);
}

#include "lanes.h"
// NOLINTEND(portability-simd-intrinsics,misc-definitions-in-headers)
