#include "unpack.h"

#if defined(__x86_64__)

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

// Only the functions marked so may use the instructions, so that nothing shared with other files is compiled for them.
#define BENDY_AVX2 __attribute__((target("avx2,fma")))

// NOLINTBEGIN(portability-simd-intrinsics): that is what this file is
namespace bendy {
namespace {

static_assert(offsetof(glm::quat, x) == 0 && offsetof(glm::quat, w) == 12);

constexpr std::size_t kTerms = 24;  // of the series for slerp; see blend

/// What one list's tracks are read from.
struct Source {
    const std::byte* steps;
    const std::byte* widths;  // null: constants
    const std::byte* bases;
    const std::byte* end;  // of the payload
    std::uint32_t count;
    std::uint32_t base_bytes;
};

/// The bits of two frames that are read next.
struct Frames {
    const std::byte* left;
    const std::byte* right;
    std::uint32_t bit;  // in both
};

/// u_i = 1 / (i (2i + 1)) and v_i = i / (2i + 1), i from 1: see series_of.
struct SeriesTables {
    std::array<float, kTerms> u{}, v{};
};
constexpr SeriesTables make_tables() {
    SeriesTables tables;
    for (std::size_t k = 0; k < kTerms; ++k) {
        const double i = static_cast<double>(k) + 1.0;
        tables.u[k] = static_cast<float>(1.0 / (i * (2.0 * i + 1.0)));
        tables.v[k] = static_cast<float>(i / (2.0 * i + 1.0));
    }
    return tables;
}
constexpr SeriesTables kSeries = make_tables();

/// Up to eight bytes, zeros after them.
std::uint64_t load_bytes(const std::byte* from, const std::byte* end, std::uint32_t count) {
    std::uint64_t bytes = 0;
    if (end - from >= 8) {
        std::memcpy(&bytes, from, 8);
        return count == 8 ? bytes : bytes & ((std::uint64_t{1} << (8 * count)) - 1);
    }
    std::memcpy(&bytes, from, count);
    return bytes;
}

BENDY_AVX2 inline __m256i to_lanes(std::uint64_t bytes) {
    return _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(bytes)));
}

BENDY_AVX2 inline __m256i load_bases(const Source& source, std::uint32_t number, std::uint32_t count) {
    const std::byte* from = source.bases + std::size_t{number} * source.base_bytes;
    alignas(32) std::array<std::byte, 32> copy{};
    if (source.end - from < 32) {
        std::memcpy(copy.data(), from, std::size_t{count} * source.base_bytes);
        from = copy.data();
    }
    if (source.base_bytes == 2) return _mm256_cvtepi16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from)));
    return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
}

/// packed_step of eight codes: a root of two by the low bits, a power of two by the others.
BENDY_AVX2 inline __m256 to_steps(std::uint64_t codes) {
    const __m256i code = to_lanes(codes);
    const __m256 roots =
        _mm256_setr_ps(1.0f, 1.189207115f, 1.414213562f, 1.681792831f, 1.0f, 1.189207115f, 1.414213562f, 1.681792831f);
    const __m256 root = _mm256_permutevar8x32_ps(roots, _mm256_and_si256(code, _mm256_set1_epi32(3)));
    const __m256i exponent = _mm256_add_epi32(_mm256_srli_epi32(code, 2), _mm256_set1_epi32(127 - 40));
    return _mm256_mul_ps(root, _mm256_castsi256_ps(_mm256_slli_epi32(exponent, 23)));
}

/// Sixteen bytes, zeros past the end of the payload.
BENDY_AVX2 inline __m128i load_window(const std::byte* from, const std::byte* end) {
    if (end - from >= 16) return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
    alignas(16) std::array<std::byte, 16> copy{};
    std::copy(from, end, copy.data());
    return _mm_load_si128(reinterpret_cast<const __m128i*>(copy.data()));
}

/// Where eight numbers lie in two windows of sixteen bytes, four in each: at most 4 * 24 + 7 bits.
struct Windows {
    std::size_t low, high;  // bytes from the start of the frame
    __m256i bytes;          // for each byte of each lane, which one of the window
    __m256i shift;
    __m256i mask;
};

BENDY_AVX2 inline Windows find_windows(std::uint64_t widths, std::uint32_t bit, std::uint32_t& total) {
    // Eight widths are bytes of one number; the product's bytes are their sums so far, at most 8 * 24.
    constexpr std::uint64_t kOnes = 0x0101'0101'0101'0101u;
    constexpr std::uint64_t kLow = 0x0101'0101u;
    const std::uint64_t sums = widths * kOnes;
    total = static_cast<std::uint32_t>(sums >> 56);
    const std::uint64_t four = sums >> 24 & 0xffu;
    const std::uint64_t high_bit = bit + four;
    const std::uint64_t offsets =
        (sums << 8) - ((four * kLow) << 32) + (bit % 8) * kLow + (((high_bit % 8) * kLow) << 32);
    const __m256i first = _mm256_set1_epi64x(static_cast<long long>(offsets >> 3 & (0x1f * kOnes)));
    const __m256i each_four = _mm256_setr_epi8(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5,
                                               6, 6, 6, 6, 7, 7, 7, 7);
    const __m256i one = _mm256_set1_epi32(1);
    Windows windows;
    windows.low = bit / 8;
    windows.high = high_bit / 8;
    windows.bytes = _mm256_add_epi8(_mm256_shuffle_epi8(first, each_four), _mm256_set1_epi32(0x0302'0100));
    windows.shift = to_lanes(offsets & (7 * kOnes));
    windows.mask = _mm256_sub_epi32(_mm256_sllv_epi32(one, to_lanes(widths)), one);
    return windows;
}

BENDY_AVX2 inline __m256i read_bits(const std::byte* frame, const Windows& windows, const std::byte* end) {
    const __m256i both =
        _mm256_set_m128i(load_window(frame + windows.high, end), load_window(frame + windows.low, end));
    const __m256i words = _mm256_shuffle_epi8(both, windows.bytes);
    return _mm256_and_si256(_mm256_srlv_epi32(words, windows.shift), windows.mask);
}

/// One component of up to eight tracks at both frames. Lanes past `count` hold anything.
BENDY_AVX2 inline void read_component(const Source& source, std::uint32_t number, std::uint32_t count, Frames& frames,
                                      __m256& left, __m256& right) {
    const __m256i base = load_bases(source, number, count);
    const __m256 step = to_steps(load_bytes(source.steps + number, source.end, count));
    if (source.widths == nullptr) {
        left = right = _mm256_mul_ps(_mm256_cvtepi32_ps(base), step);
        return;
    }
    std::uint32_t total = 0;
    const Windows windows = find_windows(load_bytes(source.widths + number, source.end, count), frames.bit, total);
    const __m256i a = _mm256_add_epi32(base, read_bits(frames.left, windows, source.end));
    const __m256i b = _mm256_add_epi32(base, read_bits(frames.right, windows, source.end));
    left = _mm256_mul_ps(_mm256_cvtepi32_ps(a), step);
    right = _mm256_mul_ps(_mm256_cvtepi32_ps(b), step);
    frames.bit += total;
}

/// c[0] + h (c[1] + h (...)), `terms` of them.
template <std::size_t terms>
BENDY_AVX2 inline __m256 polynomial(__m256 h, const std::array<float, 10>& c) {
    __m256 sum = _mm256_set1_ps(c[terms - 1]);
    for (std::size_t k = terms - 1; k-- > 0;) sum = _mm256_fmadd_ps(sum, h, _mm256_set1_ps(c[k]));
    return sum;
}

// Taylor's series of sin(a) / 2a and cos(a), by the square of a.
constexpr std::array<float, 10> kSine{0.5f,
                                      -1.0f / 12,
                                      1.0f / 240,
                                      -1.0f / 10080,
                                      1.0f / 725760,
                                      -1.0f / 79833600.0f,
                                      1.0f / 12454041600.0f,
                                      -1.0f / 2615348736000.0f,
                                      1.0f / 711374856192000.0f,
                                      -1.0f / 243290200817664000.0f};
constexpr std::array<float, 10> kCosine{1.0f,
                                        -1.0f / 2,
                                        1.0f / 24,
                                        -1.0f / 720,
                                        1.0f / 40320,
                                        -1.0f / 3628800,
                                        1.0f / 479001600.0f,
                                        -1.0f / 87178291200.0f,
                                        1.0f / 20922789888000.0f,
                                        -1.0f / 6402373705728000.0f};

/// exp of eight rotation vectors.
BENDY_AVX2 inline void exp(const __m256* v, __m256* q) {
    const __m256 square = _mm256_fmadd_ps(v[0], v[0], _mm256_fmadd_ps(v[1], v[1], _mm256_mul_ps(v[2], v[2])));
    const __m256 half = _mm256_min_ps(_mm256_mul_ps(square, _mm256_set1_ps(0.25f)),
                                      _mm256_set1_ps(static_cast<float>(kMaxHalfTurnSquare)));
    constexpr float kHalfTurn = 2.5f;  // few rotations are farther from rest
    const bool is_far = _mm256_movemask_ps(_mm256_cmp_ps(half, _mm256_set1_ps(kHalfTurn), _CMP_GT_OQ)) != 0;
    const __m256 sine = is_far ? polynomial<10>(half, kSine) : polynomial<6>(half, kSine);
    for (int c = 0; c < 3; ++c) q[c] = _mm256_mul_ps(v[c], sine);
    q[3] = is_far ? polynomial<10>(half, kCosine) : polynomial<7>(half, kCosine);
}

/// sin(t a) / sin(a) for x = cos(a) - 1: D. Eberly, "A Fast and Accurate Algorithm for Computing SLERP", 2011:
/// t (1 + k1 x (1 + k2 x (...))), k_i = u_i t^2 - v_i.
BENDY_AVX2 inline __m256 series_of(__m256 t, std::size_t terms, __m256 x) {
    const __m256 one = _mm256_set1_ps(1.0f);
    const __m256 square = _mm256_mul_ps(t, t);
    __m256 sum = one;
    for (std::size_t i = terms; i-- > 0;) {
        const __m256 k = _mm256_fmsub_ps(square, _mm256_set1_ps(kSeries.u[i]), _mm256_set1_ps(kSeries.v[i]));
        sum = _mm256_fmadd_ps(_mm256_mul_ps(k, x), sum, one);
    }
    return _mm256_mul_ps(t, sum);
}

/// slerp, the short way round. As many terms as the largest angle among the eight needs.
BENDY_AVX2 inline void blend(float fraction, __m256* a, const __m256* b) {
    __m256 dot = _mm256_mul_ps(a[0], b[0]);
    for (int c = 1; c < 4; ++c) dot = _mm256_fmadd_ps(a[c], b[c], dot);
    const __m256 sign = _mm256_and_ps(dot, _mm256_set1_ps(-0.0f));
    const __m256 near_one = _mm256_min_ps(_mm256_xor_ps(dot, sign), _mm256_set1_ps(1.0f));
    const __m256 x = _mm256_sub_ps(near_one, _mm256_set1_ps(1.0f));
    const auto any_below = [&](float limit) BENDY_AVX2 {
        return _mm256_movemask_ps(_mm256_cmp_ps(near_one, _mm256_set1_ps(limit), _CMP_LT_OQ)) != 0;
    };
    const std::size_t terms = !any_below(0.98f) ? 4 : !any_below(0.75f) ? 9 : kTerms;
    const __m256 t = _mm256_set1_ps(fraction);
    const __m256 from_b = _mm256_xor_ps(series_of(t, terms, x), sign);
    const __m256 from_a = series_of(_mm256_sub_ps(_mm256_set1_ps(1.0f), t), terms, x);
    for (int c = 0; c < 4; ++c) a[c] = _mm256_fmadd_ps(b[c], from_b, _mm256_mul_ps(a[c], from_a));
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

/// rest * q, unit, to the joints.
BENDY_AVX2 inline void store_rotations(const std::uint32_t* joints, std::uint32_t count, const __m256* q,
                                       JointTransform* local) {
    __m256 rest[4];
    for (std::uint32_t t = 0; t < 4; ++t) {
        const __m128 low = _mm_loadu_ps(&local[joints[t]].rotation.x);
        const __m128 high = _mm_loadu_ps(&local[joints[t + 4]].rotation.x);
        rest[t] = _mm256_set_m128(high, low);
    }
    transpose(rest);
    const auto& r = rest;
    __m256 out[4];
    out[0] = _mm256_fmadd_ps(r[3], q[0],
                             _mm256_fmadd_ps(r[0], q[3], _mm256_fmsub_ps(r[1], q[2], _mm256_mul_ps(r[2], q[1]))));
    out[1] = _mm256_fmadd_ps(r[3], q[1],
                             _mm256_fmadd_ps(r[1], q[3], _mm256_fmsub_ps(r[2], q[0], _mm256_mul_ps(r[0], q[2]))));
    out[2] = _mm256_fmadd_ps(r[3], q[2],
                             _mm256_fmadd_ps(r[2], q[3], _mm256_fmsub_ps(r[0], q[1], _mm256_mul_ps(r[1], q[0]))));
    out[3] = _mm256_fmsub_ps(r[3], q[3],
                             _mm256_fmadd_ps(r[0], q[0], _mm256_fmadd_ps(r[1], q[1], _mm256_mul_ps(r[2], q[2]))));
    __m256 square = _mm256_mul_ps(out[0], out[0]);
    for (int c = 1; c < 4; ++c) square = _mm256_fmadd_ps(out[c], out[c], square);
    const __m256 scale = _mm256_div_ps(_mm256_set1_ps(1.0f), _mm256_sqrt_ps(square));
    for (__m256& component : out) component = _mm256_mul_ps(component, scale);
    transpose(out);
    for (std::uint32_t t = 0; t < std::min(count, 4u); ++t)
        _mm_storeu_ps(&local[joints[t]].rotation.x, _mm256_castps256_ps128(out[t]));
    for (std::uint32_t t = 4; t < count; ++t)
        _mm_storeu_ps(&local[joints[t]].rotation.x, _mm256_extractf128_ps(out[t - 4], 1));
}

/// The joints of a list, one group after another; the last one again where there are fewer than eight.
class Joints {
public:
    Joints(Bytes bits, const std::byte* end) : bits_(bits), end_(end) {}

    void next(std::uint32_t count, std::uint32_t* joints) {
        for (std::uint32_t t = 0; t < count; ++t) {
            while (word_ == 0) {
                word_ = load_bytes(bits_.data() + at_, end_,
                                   static_cast<std::uint32_t>(std::min<std::size_t>(8, bits_.size() - at_)));
                first_ = static_cast<std::uint32_t>(at_) * 8;
                at_ += 8;
            }
            joints[t] = first_ + static_cast<std::uint32_t>(std::countr_zero(word_));
            word_ &= word_ - 1;
        }
        for (std::uint32_t t = count; t < kPackedGroup; ++t) joints[t] = joints[count - 1];
    }

private:
    Bytes bits_;
    const std::byte* end_;  // of the payload
    std::uint64_t word_ = 0;
    std::size_t at_ = 0;
    std::uint32_t first_ = 0;
};

BENDY_AVX2 void unpack_list(const PackedKind& kind, const PackedList& list, const Source& source, float fraction,
                            Frames& frames, JointTransform* local) {
    Joints joints(list.joints, source.end);
    std::array<std::uint32_t, kPackedGroup> of_group{};
    const bool blends = source.widths != nullptr && fraction != 0.0f;
    for (std::uint32_t first = 0; first < list.count; first += kPackedGroup) {
        const std::uint32_t count = std::min(kPackedGroup, list.count - first);
        joints.next(count, of_group.data());
        __m256 left[3];
        __m256 right[3];
        read_component(source, first, count, frames, left[0], right[0]);
        if (kind.components == 3) {
            read_component(source, list.count + first, count, frames, left[1], right[1]);
            read_component(source, 2 * list.count + first, count, frames, left[2], right[2]);
        } else {
            left[1] = left[2] = left[0];
            right[1] = right[2] = right[0];
        }
        if (kind.path == TrackPath::rotation) {
            __m256 a[4];
            exp(left, a);
            if (blends) {
                __m256 b[4];
                exp(right, b);
                blend(fraction, a, b);
            }
            store_rotations(of_group.data(), count, a, local);
            continue;
        }
        alignas(32) std::array<std::array<float, kPackedGroup>, 3> by;
        const __m256 t = _mm256_set1_ps(blends ? fraction : 0.0f);
        for (std::size_t c = 0; c < 3; ++c)
            _mm256_store_ps(by[c].data(), _mm256_fmadd_ps(_mm256_sub_ps(right[c], left[c]), t, left[c]));
        for (std::uint32_t k = 0; k < count; ++k) {
            JointTransform& joint = local[of_group[k]];
            (kind.path == TrackPath::translation ? joint.translation : joint.scale) +=
                glm::vec3(by[0][k], by[1][k], by[2][k]);
        }
    }
}

}  // namespace

BENDY_AVX2 void unpack_avx2(const PackedView& packed, float seconds, std::span<JointTransform> local) {
    if (packed.record.joints > local.size()) return;
    const PackedMoment moment = packed_moment(packed, seconds);
    const auto fraction = static_cast<float>(moment.fraction);
    const std::byte* const payload = packed.payload.data();
    const std::byte* const end = payload + packed.payload.size();
    Frames frames{};
    const std::byte* tables = nullptr;
    if (packed.animated_numbers > 0) {
        const PackedSegment segment = packed_segment(packed, moment.frame);
        const std::uint32_t right = std::min(moment.frame + 1, packed.record.frames - 1);
        frames.left = payload + segment.frames + (moment.frame - segment.first) * segment.stride;
        frames.right = payload + segment.frames + (right - segment.first) * segment.stride;
        tables = payload + segment.tables;
    }
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        const PackedList& list = packed.lists[k];
        if (list.count == 0) continue;
        const PackedKind& kind = kPackedKinds[k];
        const std::size_t numbers = std::size_t{list.count} * kind.components;
        Source source{list.steps.data(), nullptr, list.constants.data(), end, list.count, list.base_bytes};
        if (kind.animated) {
            source.widths = tables;
            source.bases = tables + numbers;
            tables += numbers * (1 + list.base_bytes);
        }
        unpack_list(kind, list, source, fraction, frames, local.data());
    }
}

}  // namespace bendy
// NOLINTEND(portability-simd-intrinsics)

#endif
