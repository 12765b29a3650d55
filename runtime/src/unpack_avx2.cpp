#include "unpack.h"

#if defined(__x86_64__)

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>

// Only the functions marked so may use the instructions, so that nothing shared with other files is compiled for them.
#define BENDY_AVX2 __attribute__((target("avx2,fma")))

// NOLINTBEGIN(portability-simd-intrinsics): that is what this file is
namespace bendy {
namespace {

constexpr std::size_t kTerms = 24;  // of the series for slerp; see blend

/// What is read of the payload at one moment.
struct Moment {
    const UnpackWindows* windows;
    const std::byte* tables;
    const std::byte* left;   // frames
    const std::byte* right;  // the same one at the end
    const std::byte* end;    // of the payload
    float fraction;
    bool is_near_end;  // reading past a frame may leave the payload
};
constexpr std::size_t kWindow = 16;                   // bytes read at once
constexpr std::size_t kReadPast = 2 * kWindow;  // so far past a frame's or a table's end may be read

/// The bytes there are, zeros after the end of the payload.
template <std::size_t size, bool is_near_end>
const std::byte* reach(const std::byte* from, const std::byte* end, std::array<std::byte, size>& copy) {
    if (!is_near_end || end - from >= static_cast<std::ptrdiff_t>(size)) return from;
    std::copy(from, std::max(from, end), copy.data());
    return copy.data();
}

template <bool is_near_end>
BENDY_AVX2 inline __m256i load_bases(const std::byte* from, std::uint32_t base_bytes, const std::byte* end) {
    alignas(32) std::array<std::byte, 32> copy{};
    from = reach<32, is_near_end>(from, end, copy);
    if (base_bytes == 2) return _mm256_cvtepi16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from)));
    return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
}

template <bool is_near_end>
BENDY_AVX2 inline __m128i load_window(const std::byte* from, const std::byte* end) {
    alignas(16) std::array<std::byte, kWindow> copy{};
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(reach<kWindow, is_near_end>(from, end, copy)));
}

BENDY_AVX2 inline __m256i load_lanes(const std::array<std::uint8_t, kPackedGroup>& bytes) {
    return _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(bytes.data())));
}

/// UnpackWindows, ready for use: a source byte of the window for each byte of each lane.
struct Places {
    __m256i bytes, left, right;
};

BENDY_AVX2 inline Places load_places(const UnpackWindows& windows) {
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, windows.bytes.data(), sizeof bytes);
    const __m256i all = _mm256_set1_epi64x(static_cast<long long>(bytes));
    const __m256i each_four = _mm256_setr_epi8(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5,
                                               6, 6, 6, 6, 7, 7, 7, 7);
    return {_mm256_add_epi8(_mm256_shuffle_epi8(all, each_four), _mm256_set1_epi32(0x0302'0100)), load_lanes(windows.left),
            load_lanes(windows.right)};
}

template <bool is_near_end>
BENDY_AVX2 inline __m256i read_bits(const std::byte* frame, const UnpackWindows& windows, const Places& places,
                                    const std::byte* end) {
    const __m256i both = _mm256_set_m128i(load_window<is_near_end>(frame + windows.high, end),
                                          load_window<is_near_end>(frame + windows.low, end));
    const __m256i words = _mm256_shuffle_epi8(both, places.bytes);
    return _mm256_srlv_epi32(_mm256_sllv_epi32(words, places.left), places.right);
}

/// One component of a group at both frames. Lanes past the group's tracks hold zeros.
template <bool is_near_end>
BENDY_AVX2 inline void read_component(const UnpackGroup& group, std::uint32_t c, const UnpackWindows& windows,
                                      const Moment& at, __m256& left, __m256& right) {
    const std::byte* const bases = at.tables + group.bases + std::size_t{c} * group.stride;
    const __m256i base = load_bases<is_near_end>(bases, group.base_bytes, at.end);
    const Places places = load_places(windows);
    const __m256i a = _mm256_add_epi32(base, read_bits<is_near_end>(at.left, windows, places, at.end));
    const __m256i b = _mm256_add_epi32(base, read_bits<is_near_end>(at.right, windows, places, at.end));
    const __m256 step = _mm256_loadu_ps(group.steps[c].data());
    left = _mm256_mul_ps(_mm256_cvtepi32_ps(a), step);
    right = _mm256_mul_ps(_mm256_cvtepi32_ps(b), step);
}

/// A constant in each lane, so that no instruction is needed to spread it.
struct Spread {
    alignas(32) std::array<float, kPackedGroup> lanes;
    constexpr explicit Spread(double value) : lanes() { lanes.fill(static_cast<float>(value)); }
};

BENDY_AVX2 inline __m256 load(const Spread& constant) {
    return _mm256_load_ps(constant.lanes.data());
}

/// The sum of c[k] h^k, `terms` of them: even and odd ones side by side, since each step waits for the one before.
template <std::size_t terms>
BENDY_AVX2 inline __m256 polynomial(__m256 h, __m256 square, const std::array<Spread, 10>& c) {
    constexpr std::size_t kOdd = (terms - 2) / 2 * 2 + 1;
    constexpr std::size_t kEven = (terms - 1) / 2 * 2;
    __m256 odd = load(c[kOdd]);
    __m256 even = load(c[kEven]);
    for (std::size_t k = kOdd; k > 1; k -= 2) odd = _mm256_fmadd_ps(odd, square, load(c[k - 2]));
    for (std::size_t k = kEven; k > 0; k -= 2) even = _mm256_fmadd_ps(even, square, load(c[k - 2]));
    return _mm256_fmadd_ps(odd, h, even);
}

/// Taylor's series of sin(a) / 2a, if `first` is 1, and cos(a), if it is 0, by the square of a.
template <std::size_t... k>
constexpr std::array<Spread, sizeof...(k)> taylor(double scale, std::size_t first, std::index_sequence<k...>) {
    const auto term = [&](std::size_t number) {
        double value = scale;
        for (std::size_t n = 1; n <= 2 * number + first; ++n) value /= static_cast<double>(n);
        return Spread(number % 2 == 0 ? value : -value);
    };
    return {term(k)...};
}
constexpr std::array<Spread, 10> kSine = taylor(0.5, 1, std::make_index_sequence<10>());
constexpr std::array<Spread, 10> kCosine = taylor(1.0, 0, std::make_index_sequence<10>());

constexpr float kNear = 2.5f;  // (angle / 2)^2: few rotations are farther from rest

BENDY_AVX2 inline __m256 dot3(const __m256* a, const __m256* b) {
    return _mm256_fmadd_ps(a[0], b[0], _mm256_fmadd_ps(a[1], b[1], _mm256_mul_ps(a[2], b[2])));
}
BENDY_AVX2 inline __m256 dot4(const __m256* a, const __m256* b) {
    return _mm256_add_ps(_mm256_fmadd_ps(a[0], b[0], _mm256_mul_ps(a[1], b[1])),
                         _mm256_fmadd_ps(a[2], b[2], _mm256_mul_ps(a[3], b[3])));
}

BENDY_AVX2 inline void scale_by(__m256 factor, __m256* q) {
    for (int c = 0; c < 4; ++c) q[c] = _mm256_mul_ps(q[c], factor);
}

/// exp of eight rotation vectors v, given h = |v|^2 / 4.
BENDY_AVX2 inline void near_exp(const __m256* v, __m256 h, __m256* q) {
    const __m256 square = _mm256_mul_ps(h, h);
    const __m256 sine = polynomial<6>(h, square, kSine);
    for (int c = 0; c < 3; ++c) q[c] = _mm256_mul_ps(v[c], sine);
    q[3] = polynomial<7>(h, square, kCosine);
}

/// The same, however long the vectors are.
[[gnu::noinline]] BENDY_AVX2 void far_exp(const __m256* v, __m256 h, __m256* q) {
    const __m256 held = _mm256_min_ps(h, _mm256_set1_ps(static_cast<float>(kMaxHalfTurnSquare)));
    const __m256 square = _mm256_mul_ps(held, held);
    const __m256 sine = polynomial<10>(held, square, kSine);
    for (int c = 0; c < 3; ++c) q[c] = _mm256_mul_ps(v[c], sine);
    q[3] = polynomial<10>(held, square, kCosine);
    scale_by(_mm256_div_ps(_mm256_set1_ps(1.0f), _mm256_sqrt_ps(dot4(q, q))), q);
}

BENDY_AVX2 inline void exp(const __m256* v, const __m256* w, __m256* p, __m256* q) {
    const __m256 quarter = _mm256_set1_ps(0.25f);
    const __m256 of_v = _mm256_mul_ps(dot3(v, v), quarter);
    const __m256 of_w = _mm256_mul_ps(dot3(w, w), quarter);
    const __m256 is_far = _mm256_cmp_ps(_mm256_max_ps(of_v, of_w), _mm256_set1_ps(kNear), _CMP_GT_OQ);
    if (_mm256_movemask_ps(is_far) != 0) {
        far_exp(v, of_v, p);
        far_exp(w, of_w, q);
        return;
    }
    near_exp(v, of_v, p);
    near_exp(w, of_w, q);
}

/// u_i = 1 / (i (2i + 1)) and v_i = i / (2i + 1), i from 1.
template <std::size_t... k>
constexpr std::array<Spread, sizeof...(k)> first_factors(std::index_sequence<k...>) {
    return {Spread(1.0 / ((k + 1.0) * (2.0 * k + 3.0)))...};
}
template <std::size_t... k>
constexpr std::array<Spread, sizeof...(k)> second_factors(std::index_sequence<k...>) {
    return {Spread((k + 1.0) / (2.0 * k + 3.0))...};
}
constexpr std::array<Spread, kTerms> kU = first_factors(std::make_index_sequence<kTerms>());
constexpr std::array<Spread, kTerms> kV = second_factors(std::make_index_sequence<kTerms>());

/// sin(t a) / sin(a) for x = cos(a) - 1: D. Eberly, "A Fast and Accurate Algorithm for Computing SLERP", 2011:
/// t (1 + k1 x (1 + k2 x (...))), k_i = u_i t^2 - v_i.
template <std::size_t terms>
BENDY_AVX2 inline void weigh(__m256 t, __m256 x, __m256* a, const __m256* b, __m256 sign) {
    const __m256 one = _mm256_set1_ps(1.0f);
    const __m256 u = _mm256_sub_ps(one, t);
    const __m256 t_square = _mm256_mul_ps(t, t);
    const __m256 u_square = _mm256_mul_ps(u, u);
    __m256 of_b = one;
    __m256 of_a = one;
    for (std::size_t i = terms; i-- > 0;) {
        const __m256 ui = load(kU[i]);
        const __m256 vi = load(kV[i]);
        of_b = _mm256_fmadd_ps(_mm256_mul_ps(_mm256_fmsub_ps(t_square, ui, vi), x), of_b, one);
        of_a = _mm256_fmadd_ps(_mm256_mul_ps(_mm256_fmsub_ps(u_square, ui, vi), x), of_a, one);
    }
    of_b = _mm256_xor_ps(_mm256_mul_ps(t, of_b), sign);
    of_a = _mm256_mul_ps(u, of_a);
    for (int c = 0; c < 4; ++c) a[c] = _mm256_fmadd_ps(b[c], of_b, _mm256_mul_ps(a[c], of_a));
}

template <std::size_t terms>
[[gnu::noinline]] BENDY_AVX2 void weigh_far(__m256 t, __m256 x, __m256* a, const __m256* b, __m256 sign) {
    weigh<terms>(t, x, a, b, sign);
}

/// slerp, the short way round, into a. As many terms as the largest angle among the eight needs.
BENDY_AVX2 inline void blend(float fraction, __m256* a, const __m256* b) {
    const __m256 cosine = dot4(a, b);
    const __m256 sign = _mm256_and_ps(cosine, _mm256_set1_ps(-0.0f));
    const __m256 near_one = _mm256_min_ps(_mm256_xor_ps(cosine, sign), _mm256_set1_ps(1.0f));
    const __m256 x = _mm256_sub_ps(near_one, _mm256_set1_ps(1.0f));
    const auto any_below = [&](float limit) BENDY_AVX2 {
        return _mm256_movemask_ps(_mm256_cmp_ps(near_one, _mm256_set1_ps(limit), _CMP_LT_OQ)) != 0;
    };
    const __m256 t = _mm256_set1_ps(fraction);
    if (!any_below(0.9f)) {
        weigh<4>(t, x, a, b, sign);
    } else if (!any_below(0.55f)) {
        weigh_far<9>(t, x, a, b, sign);
    } else {
        weigh_far<kTerms>(t, x, a, b, sign);
    }
}

/// Four rows of eight become eight columns of four, columns 0 to 3 in the rows' low halves, 4 to 7 in the high ones;
/// and back.
BENDY_AVX2 inline void transpose(__m256* rows) {
    const __m256 a = _mm256_unpacklo_ps(rows[0], rows[1]);
    const __m256 b = _mm256_unpackhi_ps(rows[0], rows[1]);
    const __m256 c = _mm256_unpacklo_ps(rows[2], rows[3]);
    const __m256 d = _mm256_unpackhi_ps(rows[2], rows[3]);
    rows[0] = _mm256_shuffle_ps(a, c, 0x44);
    rows[1] = _mm256_shuffle_ps(a, c, 0xee);
    rows[2] = _mm256_shuffle_ps(b, d, 0x44);
    rows[3] = _mm256_shuffle_ps(b, d, 0xee);
}

/// rest * q, unit, to the joints. q is unit but for rounding.
BENDY_AVX2 inline void store_rotations(const UnpackGroup& group, const __m256* q, float* floats) {
    __m256 r[4];
    for (std::size_t c = 0; c < 4; ++c) r[c] = _mm256_loadu_ps(group.rest[c].data());
    __m256 out[4];
    out[0] = _mm256_fmadd_ps(r[3], q[0],
                             _mm256_fmadd_ps(r[0], q[3], _mm256_fmsub_ps(r[1], q[2], _mm256_mul_ps(r[2], q[1]))));
    out[1] = _mm256_fmadd_ps(r[3], q[1],
                             _mm256_fmadd_ps(r[1], q[3], _mm256_fmsub_ps(r[2], q[0], _mm256_mul_ps(r[0], q[2]))));
    out[2] = _mm256_fmadd_ps(r[3], q[2],
                             _mm256_fmadd_ps(r[2], q[3], _mm256_fmsub_ps(r[0], q[1], _mm256_mul_ps(r[1], q[0]))));
    out[3] = _mm256_fmsub_ps(r[3], q[3],
                             _mm256_fmadd_ps(r[0], q[0], _mm256_fmadd_ps(r[1], q[1], _mm256_mul_ps(r[2], q[2]))));
    // One step of Newton towards 1 / length.
    scale_by(_mm256_fnmadd_ps(dot4(out, out), _mm256_set1_ps(0.5f), _mm256_set1_ps(1.5f)), out);
    transpose(out);
    for (std::size_t t = 4; t-- > 0;) _mm_storeu_ps(floats + group.places[t + 4], _mm256_extractf128_ps(out[t], 1));
    for (std::size_t t = 4; t-- > 0;) _mm_storeu_ps(floats + group.places[t], _mm256_castps256_ps128(out[t]));
}

/// rest + value, to the joints' translations or scales.
BENDY_AVX2 inline void store_vectors(const UnpackGroup& group, const __m256* value, float* floats) {
    alignas(32) std::array<std::array<float, kPackedGroup>, 3> by;
    for (std::size_t c = 0; c < 3; ++c)
        _mm256_store_ps(by[c].data(), _mm256_add_ps(_mm256_loadu_ps(group.rest[c].data()), value[c]));
    for (std::uint32_t k = 0; k < group.count; ++k) {
        for (std::size_t c = 0; c < 3; ++c) floats[group.places[k] + c] = by[c][k];
    }
}

template <bool is_near_end>
BENDY_AVX2 void unpack_groups(std::span<const UnpackGroup> groups, const Moment& at, float* floats) {
    const UnpackWindows* windows = at.windows;
    for (const UnpackGroup& group : groups) {
        __m256 left[3];
        __m256 right[3];
        read_component<is_near_end>(group, 0, windows[0], at, left[0], right[0]);
        if (group.components == 3) {
            read_component<is_near_end>(group, 1, windows[1], at, left[1], right[1]);
            read_component<is_near_end>(group, 2, windows[2], at, left[2], right[2]);
        } else {
            left[1] = left[2] = left[0];
            right[1] = right[2] = right[0];
        }
        windows += group.components;
        if (group.path == TrackPath::rotation) {
            __m256 a[4];
            __m256 b[4];
            exp(left, right, a, b);
            blend(at.fraction, a, b);
            store_rotations(group, a, floats);
            continue;
        }
        const __m256 t = _mm256_set1_ps(at.fraction);
        for (int c = 0; c < 3; ++c) left[c] = _mm256_fmadd_ps(_mm256_sub_ps(right[c], left[c]), t, left[c]);
        store_vectors(group, left, floats);
    }
}

void store_constants(std::span<const UnpackedConstant> constants, float* floats) {
    for (const UnpackedConstant& constant : constants) {
        float* const out = floats + constant.place;
        std::memcpy(out, constant.value.data(), 3 * sizeof(float));
        if (constant.floats == 4) out[3] = constant.value[3];
    }
}

Moment moment_at(const UnpackPlan& plan, float seconds) {
    const PackedView& packed = *plan.packed;
    const PackedMoment moment = packed_moment(packed, seconds);
    const std::uint32_t from_segment_to_segment = packed.record.segment_frames;
    const UnpackSegment* segment = plan.segments.data();
    std::uint32_t frame = moment.frame;
    if (packed.segments > 1) {
        const std::uint32_t number = std::min(frame / from_segment_to_segment, packed.segments - 1);
        segment += number;
        frame -= number * from_segment_to_segment;
    }
    const std::byte* const payload = packed.payload.data();
    Moment at{};
    at.windows = plan.windows.data() + segment->windows;
    at.tables = payload + segment->tables;
    at.left = payload + segment->frames + frame * segment->stride;
    at.right = moment.frame + 1 < packed.record.frames ? at.left + segment->stride : at.left;
    at.end = payload + packed.payload.size();
    at.fraction = static_cast<float>(moment.fraction);
    at.is_near_end = static_cast<std::size_t>(at.end - at.right) < segment->stride + kReadPast;
    return at;
}

}  // namespace

BENDY_AVX2 void unpack_avx2(const UnpackPlan& plan, float seconds, std::span<JointTransform> local) {
    if (plan.packed->record.joints > local.size()) return;
    if (local.empty()) return;
    store_constants(plan.constants, &local[0].rotation.x);
    if (plan.groups.empty()) return;
    const Moment at = moment_at(plan, seconds);
    (at.is_near_end ? unpack_groups<true> : unpack_groups<false>)(plan.groups, at, &local[0].rotation.x);
}

}  // namespace bendy
// NOLINTEND(portability-simd-intrinsics)

#endif
