// Four floats in a register of SSE, with the operators of the built-in types. Included by lanes_sse4.h and
// lanes_avx2.h.

// NOLINTBEGIN(portability-simd-intrinsics,misc-definitions-in-headers): this is the purpose of the file
#undef BENDY_LANES_OF_X86
#define BENDY_LANES_OF_X86  // there are stream, prefetch and guess_inverse_roots

struct Quad {
    __m128 v;

    Quad() = default;
    // NOLINTNEXTLINE(google-explicit-constructor): what intrinsics return
    Quad(__m128 numbers) : v(numbers) {}
    // NOLINTNEXTLINE(google-explicit-constructor): a number stands for four, as in `0.5f * quad`
    Quad(float number) : v(_mm_set1_ps(number)) {}
};

inline Quad operator+(Quad a, Quad b) {
    return _mm_add_ps(a.v, b.v);
}
inline Quad operator-(Quad a, Quad b) {
    return _mm_sub_ps(a.v, b.v);
}
inline Quad operator*(Quad a, Quad b) {
    return _mm_mul_ps(a.v, b.v);
}
inline Quad operator/(Quad a, Quad b) {
    return _mm_div_ps(a.v, b.v);
}
inline Quad operator&(Quad a, Quad b) {
    return _mm_and_ps(a.v, b.v);
}
inline Quad operator|(Quad a, Quad b) {
    return _mm_or_ps(a.v, b.v);
}
inline Quad operator^(Quad a, Quad b) {
    return _mm_xor_ps(a.v, b.v);
}
inline Quad operator-(Quad a) {
    return a ^ Quad(-0.0f);
}
inline Quad& operator+=(Quad& a, Quad b) {
    return a = a + b;
}

inline Quad load_quad(const float* from) {
    return _mm_loadu_ps(from);
}
inline void store(float* to, Quad quad) {
    _mm_storeu_ps(to, quad.v);
}
inline void store_three_of(float* to, Quad quad) {
    _mm_storel_pi(reinterpret_cast<__m64*>(to), quad.v);
    _mm_store_ss(to + 2, _mm_movehl_ps(quad.v, quad.v));
}
inline void stream(float* to, Quad quad) {
    _mm_stream_ps(to, quad.v);
}
inline void end_streams() {
    _mm_sfence();
}
inline void prefetch(const float* from) {
    _mm_prefetch(reinterpret_cast<const char*>(from), _MM_HINT_T0);
}

/// Elements a and b of x, c and d of y.
template <int a, int b, int c, int d>
inline Quad shuffle(Quad x, Quad y) {
    return _mm_shuffle_ps(x.v, y.v, a | b << 2 | c << 4 | d << 6);
}
inline float first_of(Quad quad) {
    return _mm_cvtss_f32(quad.v);
}
/// Broadcasts one number.
template <int place>
inline Quad everywhere(Quad quad) {
    return _mm_shuffle_ps(quad.v, quad.v, 0b01010101 * place);
}
/// x < y ? x : y
inline Quad lesser(Quad x, Quad y) {
    return _mm_min_ps(x.v, y.v);
}
/// All bits of each number that is negative, and none of the others.
inline Quad negatives(Quad quad) {
    return _mm_cmplt_ps(quad.v, _mm_setzero_ps());
}
// NOLINTEND(portability-simd-intrinsics,misc-definitions-in-headers)
