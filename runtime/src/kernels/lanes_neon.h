// lanes.h for 64-bit ARM. Each source includes it in its own namespace.

#undef BENDY_LANES
#define BENDY_LANES 4

// NOLINTBEGIN(portability-simd-intrinsics,misc-definitions-in-headers): this is the purpose of the file
struct Quad {
    float32x4_t v;

    Quad() = default;
    // NOLINTNEXTLINE(google-explicit-constructor): what intrinsics return
    Quad(float32x4_t numbers) : v(numbers) {}
    // NOLINTNEXTLINE(google-explicit-constructor): a number stands for four, as in `0.5f * quad`
    Quad(float number) : v(vdupq_n_f32(number)) {}
    explicit Quad(uint32x4_t bits) : v(vreinterpretq_f32_u32(bits)) {}

    [[nodiscard]] uint32x4_t bits() const { return vreinterpretq_u32_f32(v); }
};

inline Quad operator+(Quad a, Quad b) {
    return vaddq_f32(a.v, b.v);
}
inline Quad operator-(Quad a, Quad b) {
    return vsubq_f32(a.v, b.v);
}
inline Quad operator*(Quad a, Quad b) {
    return vmulq_f32(a.v, b.v);
}
inline Quad operator/(Quad a, Quad b) {
    return vdivq_f32(a.v, b.v);
}
inline Quad operator&(Quad a, Quad b) {
    return Quad(vandq_u32(a.bits(), b.bits()));
}
inline Quad operator|(Quad a, Quad b) {
    return Quad(vorrq_u32(a.bits(), b.bits()));
}
inline Quad operator^(Quad a, Quad b) {
    return Quad(veorq_u32(a.bits(), b.bits()));
}
inline Quad operator-(Quad a) {
    return vnegq_f32(a.v);
}
inline Quad& operator+=(Quad& a, Quad b) {
    return a = a + b;
}
using Lanes = Quad;

/// a * b + c, rounded once. If the source leaves the choice open, compilers fuse a sum of products inconsistently.
inline Quad fused(Quad a, Quad b, Quad c) {
    return vfmaq_f32(c.v, a.v, b.v);
}
inline Quad fused_difference(Quad a, Quad b, Quad c) {  // a * b - c
    return vnegq_f32(vfmsq_f32(c.v, a.v, b.v));
}
inline Quad load_quad(const float* from) {
    return vld1q_f32(from);
}
inline void store(float* to, Quad quad) {
    vst1q_f32(to, quad.v);
}
inline void store_three_of(float* to, Quad quad) {
    vst1_f32(to, vget_low_f32(quad.v));
    vst1q_lane_f32(to + 2, quad.v, 2);
}
/// Elements a and b of x, c and d of y.
template <int a, int b, int c, int d>
inline Quad shuffle(Quad x, Quad y) {
    constexpr int kPlaces = a << 12 | b << 8 | c << 4 | d;
    if constexpr (kPlaces == 0x0202) {
        return vuzp1q_f32(x.v, y.v);
    } else if constexpr (kPlaces == 0x1313) {
        return vuzp2q_f32(x.v, y.v);
    } else if constexpr (kPlaces == 0x0101) {
        return vcombine_f32(vget_low_f32(x.v), vget_low_f32(y.v));
    } else if constexpr (kPlaces == 0x2323) {
        return vcombine_f32(vget_high_f32(x.v), vget_high_f32(y.v));
    } else {
        static constexpr std::uint8_t kBytes[16] = {
            4 * a,      4 * a + 1,  4 * a + 2,  4 * a + 3,  4 * b,      4 * b + 1,  4 * b + 2,  4 * b + 3,
            16 + 4 * c, 17 + 4 * c, 18 + 4 * c, 19 + 4 * c, 16 + 4 * d, 17 + 4 * d, 18 + 4 * d, 19 + 4 * d};
        const uint8x16x2_t both = {{vreinterpretq_u8_f32(x.v), vreinterpretq_u8_f32(y.v)}};
        return vreinterpretq_f32_u8(vqtbl2q_u8(both, vld1q_u8(kBytes)));
    }
}
inline float first_of(Quad quad) {
    return vgetq_lane_f32(quad.v, 0);
}
/// Broadcasts one number.
template <int place>
inline Quad everywhere(Quad quad) {
    return vdupq_laneq_f32(quad.v, place);
}
inline Quad from_integers(const std::int32_t (&numbers)[4]) {
    int32x4_t integers = vdupq_n_s32(numbers[0]);
    integers = vsetq_lane_s32(numbers[1], integers, 1);
    integers = vsetq_lane_s32(numbers[2], integers, 2);
    integers = vsetq_lane_s32(numbers[3], integers, 3);
    return vcvtq_f32_s32(integers);
}
/// x < y ? x : y
inline Quad lesser(Quad x, Quad y) {
    return vbslq_f32(vcltq_f32(x.v, y.v), x.v, y.v);
}
/// All bits of each number that is negative, and none of the others.
inline Quad negatives(Quad quad) {
    return Quad(vcltzq_f32(quad.v));
}
inline Quad load_mask(const std::uint32_t* from) {
    return Quad(vld1q_u32(from));
}
/// a where all bits of the mask are set, b where none is.
inline Quad chosen(Quad mask, Quad a, Quad b) {
    return vbslq_f32(mask.bits(), a.v, b.v);
}
inline Quad roots_of(Quad squares) {
    return vsqrtq_f32(squares.v);
}
inline Quad between(Quad quad, Quad least, Quad most) {
    return vminq_f32(vmaxq_f32(quad.v, least.v), most.v);
}
inline Quad inverse_roots_of(Quad squares) {
    const Quad guess = vrsqrteq_f32(squares.v);  // 8 bits; each step of Newton's method doubles them
    const Quad better = guess * Quad(vrsqrtsq_f32((squares * guess).v, guess.v));
    return better + 0.5f * better * (1.0f - squares * better * better);
}

inline Lanes load_integers(const std::uint8_t* from) {
    std::uint32_t bytes = 0;
    std::memcpy(&bytes, from, sizeof bytes);
    return vcvtq_f32_u32(vmovl_u16(vget_low_u16(vmovl_u8(vcreate_u8(bytes)))));
}
inline Lanes load_integers(const std::int8_t* from) {
    std::uint32_t bytes = 0;
    std::memcpy(&bytes, from, sizeof bytes);
    return vcvtq_f32_s32(vmovl_s16(vget_low_s16(vmovl_s8(vcreate_s8(bytes)))));
}
inline Lanes load_integers(const std::uint16_t* from) {
    return vcvtq_f32_u32(vmovl_u16(vld1_u16(from)));
}
inline Lanes load_integers(const std::int16_t* from) {
    return vcvtq_f32_s32(vmovl_s16(vld1_s16(from)));
}
inline Lanes load_integers(const std::uint32_t* from) {
    return vcvtq_f32_u32(vld1q_u32(from));
}

#include "lanes.h"
// NOLINTEND(portability-simd-intrinsics,misc-definitions-in-headers)
