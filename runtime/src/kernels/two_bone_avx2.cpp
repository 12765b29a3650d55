#include "kernel_table.h"

#include <bendy/format/processor.h>

#if defined(BENDY_X86_64)

#include <bendy/format/public.h>

#include <cstddef>

#include <immintrin.h>

// NOLINTBEGIN(portability-simd-intrinsics): this is the purpose of the file
namespace bendy {
namespace two_bone_with_avx2 {
namespace {

// Numbers for two_bone.h: four limbs.
constexpr std::size_t kLimbs = TwoBoneBlock::kLimbs;

struct Number {
    __m256d v;

    Number() = default;
    // NOLINTNEXTLINE(google-explicit-constructor): what intrinsics return
    Number(__m256d numbers) : v(numbers) {}
    // NOLINTNEXTLINE(google-explicit-constructor): a number stands for four, as in `0.5 * number`
    Number(double number) : v(_mm256_set1_pd(number)) {}
};

struct Mask {
    __m256d v;
};

BENDY_ALWAYS_INLINE Number operator+(Number a, Number b) {
    return _mm256_add_pd(a.v, b.v);
}
BENDY_ALWAYS_INLINE Number operator-(Number a, Number b) {
    return _mm256_sub_pd(a.v, b.v);
}
BENDY_ALWAYS_INLINE Number operator*(Number a, Number b) {
    return _mm256_mul_pd(a.v, b.v);
}
BENDY_ALWAYS_INLINE Number operator/(Number a, Number b) {
    return _mm256_div_pd(a.v, b.v);
}
BENDY_ALWAYS_INLINE Number operator-(Number a) {
    return _mm256_xor_pd(a.v, _mm256_set1_pd(-0.0));
}
BENDY_ALWAYS_INLINE Number root(Number number) {
    return _mm256_sqrt_pd(number.v);
}
BENDY_ALWAYS_INLINE Number absolute(Number number) {
    return _mm256_andnot_pd(_mm256_set1_pd(-0.0), number.v);
}
BENDY_ALWAYS_INLINE Number greater(Number a, Number b) {
    return _mm256_max_pd(a.v, b.v);  // a > b ? a : b
}
BENDY_ALWAYS_INLINE Mask operator<(Number a, Number b) {
    return {_mm256_cmp_pd(a.v, b.v, _CMP_LT_OQ)};
}
BENDY_ALWAYS_INLINE Mask operator>(Number a, Number b) {
    return {_mm256_cmp_pd(a.v, b.v, _CMP_GT_OQ)};
}
BENDY_ALWAYS_INLINE Mask operator<=(Number a, Number b) {
    return {_mm256_cmp_pd(a.v, b.v, _CMP_LE_OQ)};
}
BENDY_ALWAYS_INLINE Number chosen(Mask mask, Number a, Number b) {
    return _mm256_blendv_pd(b.v, a.v, mask.v);
}
BENDY_ALWAYS_INLINE Mask chosen(Mask mask, Mask a, Mask b) {
    return {_mm256_blendv_pd(b.v, a.v, mask.v)};
}
BENDY_ALWAYS_INLINE Mask both(Mask a, Mask b) {
    return {_mm256_and_pd(a.v, b.v)};
}
BENDY_ALWAYS_INLINE Mask either(Mask a, Mask b) {
    return {_mm256_or_pd(a.v, b.v)};
}
BENDY_ALWAYS_INLINE Mask opposite(Mask mask) {
    return {_mm256_xor_pd(mask.v, _mm256_cmp_pd(mask.v, mask.v, _CMP_TRUE_UQ))};
}
BENDY_ALWAYS_INLINE bool is_any(Mask mask) {
    return _mm256_movemask_pd(mask.v) != 0;
}
BENDY_ALWAYS_INLINE bool is_every(Mask mask) {
    return _mm256_movemask_pd(mask.v) == 0b1111;
}
BENDY_ALWAYS_INLINE Number loaded(const double* from) {
    return _mm256_load_pd(from);
}

#include "two_bone.h"

inline void store(const Rotation& rotation, double (&to)[4][kLimbs]) {
    _mm256_storeu_pd(to[0], rotation.x.v);
    _mm256_storeu_pd(to[1], rotation.y.v);
    _mm256_storeu_pd(to[2], rotation.z.v);
    _mm256_storeu_pd(to[3], rotation.w.v);
}

inline void solve(TwoBoneBlock& block) {
    const Limbs& limb = block.limbs;
    const Mask is_fixed = load_flag(limb.is_fixed);
    Reaching reach;
    Bend bend{};
    Turn turns[2];
    const Mask are_plain = begin(limb, reach, bend);
    const Rotation before = reach.lower;
    const Mask can_bend = find_bend(reach, is_fixed, bend);
    find_turns(bend, is_fixed, load_flag(limb.prefers_back), turns);
    const Mask is_turned = turn_middle(bend, turns[0], before, reach.lower);
    const Number distance = finish(limb, bend, turns[0], reach);
    const Mask is_far = is_out_of_reach(limb, bend, reach);
    _mm256_storeu_pd(block.out_of_reach, chosen(is_far, Number(1.0), Number(0.0)).v);
    store(reach.upper, block.upper);
    store(reach.lower, block.lower);
    _mm256_storeu_pd(block.distance, chosen(both(are_plain, both(can_bend, is_turned)), distance, -1.0).v);
}

}  // namespace
}  // namespace two_bone_with_avx2

void two_bones_avx2(TwoBoneBlock& block) {
    two_bone_with_avx2::solve(block);
}

}  // namespace bendy
// NOLINTEND(portability-simd-intrinsics)

#endif
