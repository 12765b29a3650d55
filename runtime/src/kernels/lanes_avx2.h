// lanes.h for AVX2 and FMA: eight floats in a register. Each source includes it in its own namespace.

#undef BENDY_LANES
#define BENDY_LANES 8

// NOLINTBEGIN(portability-simd-intrinsics,misc-definitions-in-headers): this is the purpose of the file
#include "quad_sse4.h"

struct Lanes {
    __m256 v;

    Lanes() = default;
    // NOLINTNEXTLINE(google-explicit-constructor): what intrinsics return
    Lanes(__m256 numbers) : v(numbers) {}
    // NOLINTNEXTLINE(google-explicit-constructor): a number stands for eight, as in `0.5f * lanes`
    Lanes(float number) : v(_mm256_set1_ps(number)) {}
};

inline Lanes operator+(Lanes a, Lanes b) {
    return _mm256_add_ps(a.v, b.v);
}
inline Lanes operator-(Lanes a, Lanes b) {
    return _mm256_sub_ps(a.v, b.v);
}
inline Lanes operator*(Lanes a, Lanes b) {
    return _mm256_mul_ps(a.v, b.v);
}
inline Lanes operator/(Lanes a, Lanes b) {
    return _mm256_div_ps(a.v, b.v);
}
inline Lanes operator&(Lanes a, Lanes b) {
    return _mm256_and_ps(a.v, b.v);
}
inline Lanes operator|(Lanes a, Lanes b) {
    return _mm256_or_ps(a.v, b.v);
}
inline Lanes operator^(Lanes a, Lanes b) {
    return _mm256_xor_ps(a.v, b.v);
}
inline Lanes operator-(Lanes a) {
    return a ^ Lanes(-0.0f);
}
inline Lanes& operator+=(Lanes& a, Lanes b) {
    return a = a + b;
}

/// a * b + c, rounded once. If the source leaves the choice open, compilers fuse a sum of products inconsistently.
inline Lanes fused(Lanes a, Lanes b, Lanes c) {
    return _mm256_fmadd_ps(a.v, b.v, c.v);
}
inline Lanes fused_difference(Lanes a, Lanes b, Lanes c) {  // a * b - c
    return _mm256_fmsub_ps(a.v, b.v, c.v);
}
inline Quad fused(Quad a, Quad b, Quad c) {
    return _mm_fmadd_ps(a.v, b.v, c.v);
}
inline Lanes load_lanes(const float* from) {
    return _mm256_loadu_ps(from);
}
inline void store(float* to, Lanes lanes) {
    _mm256_storeu_ps(to, lanes.v);
}
inline void stream(float* to, Lanes lanes) {
    _mm_stream_ps(to, _mm256_castps256_ps128(lanes.v));  // in halves, which only need alignment to 16 bytes
    _mm_stream_ps(to + 4, _mm256_extractf128_ps(lanes.v, 1));
}
inline Quad low(Lanes lanes) {
    return _mm256_castps256_ps128(lanes.v);
}
inline Quad high(Lanes lanes) {
    return _mm256_extractf128_ps(lanes.v, 1);
}
inline Lanes joined(Quad low, Quad high) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(low.v), high.v, 1);
}
/// One half of x, 0 for the lower and 1 for the upper one, and one of y.
template <int of_x, int of_y>
inline Lanes halves(Lanes x, Lanes y) {
    if constexpr (of_x == 0 && of_y == 1) return _mm256_blend_ps(x.v, y.v, 0b1111'0000);
    return _mm256_permute2f128_ps(x.v, y.v, of_x | (2 + of_y) << 4);
}
/// Four numbers, repeated in the upper lanes.
inline Lanes repeat(const float* quad) {
    return _mm256_broadcast_ps(reinterpret_cast<const __m128*>(quad));
}
/// In each half: elements a and b of x, c and d of y.
template <int a, int b, int c, int d>
inline Lanes shuffle(Lanes x, Lanes y) {
    return _mm256_shuffle_ps(x.v, y.v, a | b << 2 | c << 4 | d << 6);
}
/// Broadcasts one number of each half.
template <int place>
inline Lanes everywhere(Lanes lanes) {
    return _mm256_permute_ps(lanes.v, 0b01010101 * place);
}
inline Lanes lesser(Lanes x, Lanes y) {
    return _mm256_min_ps(x.v, y.v);
}
inline Lanes negatives(Lanes lanes) {
    return _mm256_cmp_ps(lanes.v, _mm256_setzero_ps(), _CMP_LT_OQ);
}
inline Lanes load_mask(const std::uint32_t* from) {
    return _mm256_castsi256_ps(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from)));
}
/// Reads no other numbers than those of the mask; zeros elsewhere.
inline Lanes load_some(const float* from, Lanes mask) {
    return _mm256_maskload_ps(from, _mm256_castps_si256(mask.v));
}
/// a where all bits of the mask are set, b where none is.
inline Lanes chosen(Lanes mask, Lanes a, Lanes b) {
    return _mm256_blendv_ps(b.v, a.v, mask.v);
}
/// In each lane, the number of another one.
inline Lanes permuted(Lanes lanes, const std::int32_t* from) {
    return _mm256_permutevar8x32_ps(lanes.v, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from)));
}
inline Lanes roots_of(Lanes squares) {
    return _mm256_sqrt_ps(squares.v);
}
inline Lanes between(Lanes lanes, Lanes least, Lanes most) {
    return _mm256_min_ps(_mm256_max_ps(lanes.v, least.v), most.v);
}
inline Lanes inverse_roots_of(Lanes squares) {
    return 1.0f / roots_of(squares);  // not from _mm256_rsqrt_ps, which differs between processors
}
/// By Lomont, "Fast Inverse Square Root", 2003: half the bits of a float, subtracted, halve and negate its exponent.
inline Lanes guess_inverse_roots(Lanes squares) {
    const __m256i half = _mm256_srli_epi32(_mm256_castps_si256(squares.v), 1);
    return _mm256_castsi256_ps(_mm256_sub_epi32(_mm256_set1_epi32(0x5f37'5a86), half));
}

inline Lanes load_integers(const std::uint8_t* from) {
    return _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from))));
}
inline Lanes load_integers(const std::int8_t* from) {
    return _mm256_cvtepi32_ps(_mm256_cvtepi8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from))));
}
inline Lanes load_integers(const std::uint16_t* from) {
    return _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from))));
}
inline Lanes load_integers(const std::int16_t* from) {
    return _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from))));
}
inline Lanes load_integers(const std::uint32_t* from) {
    const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
    if (_mm256_movemask_ps(_mm256_castsi256_ps(all)) == 0) return _mm256_cvtepi32_ps(all);  // below 2^31: the same bits
    const Lanes upper = _mm256_cvtepi32_ps(_mm256_srli_epi32(all, 16));
    const Lanes lower = _mm256_cvtepi32_ps(_mm256_and_si256(all, _mm256_set1_epi32(0xffff)));
    return fused(upper, Lanes(65536.0f), lower);
}
inline void load_integer_pairs(const std::int16_t* from, Lanes& first, Lanes& second) {
    const __m256i both = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
    first = _mm256_cvtepi32_ps(_mm256_srai_epi32(_mm256_slli_epi32(both, 16), 16));
    second = _mm256_cvtepi32_ps(_mm256_srai_epi32(both, 16));
}
inline void load_integer_pairs(const std::int8_t* from, Lanes& first, Lanes& second) {
    const __m256i both = _mm256_cvtepi16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from)));
    first = _mm256_cvtepi32_ps(_mm256_srai_epi32(_mm256_slli_epi32(both, 24), 24));
    second = _mm256_cvtepi32_ps(_mm256_srai_epi32(both, 8));
}

#include "lanes.h"
// NOLINTEND(portability-simd-intrinsics,misc-definitions-in-headers)
