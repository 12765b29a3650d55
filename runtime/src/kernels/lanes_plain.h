// lanes.h in portable C++: the reference, which rounds in the same way on every machine. Each source includes it in its
// own namespace.

#undef BENDY_LANES
#undef BENDY_LANES_OF_X86
#define BENDY_LANES 4

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace
struct Quad {
    float of[4];

    Quad() = default;
    // NOLINTNEXTLINE(google-explicit-constructor): a number stands for four, as in `0.5f * quad`
    BENDY_ALWAYS_INLINE Quad(float number) : Quad(number, number, number, number) {}
    BENDY_ALWAYS_INLINE Quad(float a, float b, float c, float d) : of{a, b, c, d} {}
};

/// Applies a function of two numbers lane by lane.
template <float (*function)(float, float)>
BENDY_ALWAYS_INLINE Quad by_lane(Quad a, Quad b) {
    return {function(a.of[0], b.of[0]), function(a.of[1], b.of[1]), function(a.of[2], b.of[2]),
            function(a.of[3], b.of[3])};
}

BENDY_ALWAYS_INLINE std::uint32_t bits_of(float number) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &number, sizeof bits);
    return bits;
}
BENDY_ALWAYS_INLINE float of_bits(std::uint32_t bits) {
    float number = 0.0f;
    std::memcpy(&number, &bits, sizeof number);
    return number;
}
BENDY_ALWAYS_INLINE float common_bits(float x, float y) {
    return of_bits(bits_of(x) & bits_of(y));
}
BENDY_ALWAYS_INLINE float all_bits(float x, float y) {
    return of_bits(bits_of(x) | bits_of(y));
}
BENDY_ALWAYS_INLINE float other_bits(float x, float y) {
    return of_bits(bits_of(x) ^ bits_of(y));
}
/// x < y ? x : y
BENDY_ALWAYS_INLINE float lesser_of(float x, float y) {
    return x < y ? x : y;
}
/// y < x ? x : y
BENDY_ALWAYS_INLINE float greater_of(float x, float y) {
    return y < x ? x : y;
}

BENDY_ALWAYS_INLINE Quad operator+(Quad a, Quad b) {
    return {a.of[0] + b.of[0], a.of[1] + b.of[1], a.of[2] + b.of[2], a.of[3] + b.of[3]};
}
BENDY_ALWAYS_INLINE Quad operator-(Quad a, Quad b) {
    return {a.of[0] - b.of[0], a.of[1] - b.of[1], a.of[2] - b.of[2], a.of[3] - b.of[3]};
}
BENDY_ALWAYS_INLINE Quad operator*(Quad a, Quad b) {
    return {a.of[0] * b.of[0], a.of[1] * b.of[1], a.of[2] * b.of[2], a.of[3] * b.of[3]};
}
BENDY_ALWAYS_INLINE Quad operator/(Quad a, Quad b) {
    return {a.of[0] / b.of[0], a.of[1] / b.of[1], a.of[2] / b.of[2], a.of[3] / b.of[3]};
}
BENDY_ALWAYS_INLINE Quad operator&(Quad a, Quad b) {
    return by_lane<common_bits>(a, b);
}
BENDY_ALWAYS_INLINE Quad operator|(Quad a, Quad b) {
    return by_lane<all_bits>(a, b);
}
BENDY_ALWAYS_INLINE Quad operator^(Quad a, Quad b) {
    return by_lane<other_bits>(a, b);
}
BENDY_ALWAYS_INLINE Quad operator-(Quad a) {
    return {-a.of[0], -a.of[1], -a.of[2], -a.of[3]};
}
BENDY_ALWAYS_INLINE Quad& operator+=(Quad& a, Quad b) {
    return a = a + b;
}
using Lanes = Quad;

/// a * b + c, rounded twice.
BENDY_ALWAYS_INLINE Quad fused(Quad a, Quad b, Quad c) {
    return a * b + c;
}
BENDY_ALWAYS_INLINE Quad fused_difference(Quad a, Quad b, Quad c) {
    return a * b - c;
}
BENDY_ALWAYS_INLINE Quad load_quad(const float* from) {
    return {from[0], from[1], from[2], from[3]};
}
BENDY_ALWAYS_INLINE void store_three_of(float* to, Quad quad) {
    for (std::size_t k = 0; k < 3; ++k) to[k] = quad.of[k];
}
BENDY_ALWAYS_INLINE void store(float* to, Quad quad) {
    std::memcpy(to, quad.of, sizeof quad.of);
}
/// Elements a and b of x, c and d of y.
template <int a, int b, int c, int d>
BENDY_ALWAYS_INLINE Quad shuffle(Quad x, Quad y) {
    return {x.of[a], x.of[b], y.of[c], y.of[d]};
}
BENDY_ALWAYS_INLINE float first_of(Quad quad) {
    return quad.of[0];
}
/// Broadcasts one number.
template <int place>
BENDY_ALWAYS_INLINE Quad everywhere(Quad quad) {
    return quad.of[place];
}
/// x < y ? x : y
BENDY_ALWAYS_INLINE Quad lesser(Quad x, Quad y) {
    return by_lane<lesser_of>(x, y);
}
/// All bits of each number that is negative, and none of the others.
BENDY_ALWAYS_INLINE Quad negatives(Quad quad) {
    const auto mask = [&](std::size_t k) { return of_bits(quad.of[k] < 0.0f ? kAllBits : 0); };
    return {mask(0), mask(1), mask(2), mask(3)};
}
/// Every lane of a mask has all bits or none.
BENDY_ALWAYS_INLINE Quad load_mask(const std::uint32_t* from) {
    return {of_bits(from[0]), of_bits(from[1]), of_bits(from[2]), of_bits(from[3])};
}
/// a where all bits of the mask are set, b where none is.
BENDY_ALWAYS_INLINE Quad chosen(Quad mask, Quad a, Quad b) {
    const auto pick = [&](std::size_t k) { return bits_of(mask.of[k]) != 0 ? a.of[k] : b.of[k]; };
    return {pick(0), pick(1), pick(2), pick(3)};
}
BENDY_ALWAYS_INLINE Quad roots_of(Quad squares) {
    return {std::sqrt(squares.of[0]), std::sqrt(squares.of[1]), std::sqrt(squares.of[2]), std::sqrt(squares.of[3])};
}
BENDY_ALWAYS_INLINE Quad between(Quad quad, Quad least, Quad most) {
    return lesser(by_lane<greater_of>(quad, least), most);
}
BENDY_ALWAYS_INLINE Quad inverse_roots_of(Quad squares) {
    return 1.0f / roots_of(squares);
}

/// Four integers.
template <class T>
BENDY_ALWAYS_INLINE Quad load_integers(const T* from) {
    return {static_cast<float>(from[0]), static_cast<float>(from[1]), static_cast<float>(from[2]),
            static_cast<float>(from[3])};
}
BENDY_ALWAYS_INLINE Quad from_integers(const std::int32_t (&numbers)[4]) {
    return load_integers(numbers);
}

#include "lanes.h"
// NOLINTEND(misc-definitions-in-headers)
