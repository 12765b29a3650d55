// The implementation of the sampling kernels, included after lanes.h by one source for each instruction set.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

/// sin(t a) / sin(a) by Eberly's series, "A Fast and Accurate Algorithm for Computing SLERP", 2011:
/// t (1 + k1 x (1 + k2 x (...))), x = cos(a) - 1, k_i = (t^2 / i - i) / (2 i + 1).
struct SeriesTerms {
    static constexpr int kTerms = 24;  // at right angles each term is half the previous one
    float of_square[kTerms], constant[kTerms];
};
constexpr SeriesTerms make_series_terms() {
    SeriesTerms terms{};
    for (int k = 0; k < SeriesTerms::kTerms; ++k) {
        const double i = k + 1.0;
        terms.of_square[k] = static_cast<float>(1.0 / (i * (2.0 * i + 1.0)));
        terms.constant[k] = static_cast<float>(i / (2.0 * i + 1.0));
    }
    return terms;
}
constexpr SeriesTerms kSeries = make_series_terms();

/// The series at a moment of each lane's own.
struct Series {
    static constexpr int kNearTerms = 4;
    static constexpr float kNearCosine = 0.9f;
    Lanes t, square;
    Lanes k[kNearTerms];

    explicit Series(Lanes time) : t(time), square(time * time) {
        for (int i = 0; i < kNearTerms; ++i) k[i] = square * kSeries.of_square[i] - kSeries.constant[i];
    }
    template <int terms>
    [[nodiscard]] Lanes at(Lanes x) const {
        Lanes sum = splat(1.0f);
        for (int i = terms; i-- > kNearTerms;)
            sum = 1.0f + ((square * kSeries.of_square[i] - kSeries.constant[i]) * x) * sum;
        for (int i = kNearTerms; i-- > 0;) sum = 1.0f + (k[i] * x) * sum;
        return t * sum;
    }
};

inline float least_of(Lanes lanes) {
#if BENDY_LANES == 8
    Quad least = low(lanes) < high(lanes) ? low(lanes) : high(lanes);
#else
    Quad least = lanes;
#endif
    const Quad swapped = __builtin_shufflevector(least, least, 2, 3, 0, 1);
    least = least < swapped ? least : swapped;
    return least[0] < least[1] ? least[0] : least[1];
}

/// The weights of the two ends of an interpolated rotation.
struct Shares {
    Lanes left, right;
};

template <int terms>
inline Shares shares_of(const Series& left, const Series& right, Lanes x) {
    return {left.at<terms>(x), right.at<terms>(x)};
}

__attribute__((noinline)) Shares far_shares(const Series& left, const Series& right, Lanes x) {
    return shares_of<SeriesTerms::kTerms>(left, right, x);
}

/// The moment of kLanes tracks.
struct Moments {
    Lanes fraction;
    Series left, right;
    explicit Moments(Lanes at) : fraction(at), left(1.0f - at), right(at) {}
};

inline Lanes fractions_of(const TrackGroup& group, std::size_t first, const SampleMoment* moments) {
    Lanes fractions;
    for (std::size_t k = 0; k < kLanes; ++k) fractions[k] = moments[group.moments[first + k]].fraction;
    return fractions;
}

/// The left keys of kLanes tracks.
struct Keys {
    const float* of[kLanes];
};

template <std::size_t numbers>
inline Keys keys_of(const TrackGroup& group, std::size_t first, const SampleMoment* moments) {
    Keys keys;
    if (group.is_one_moment) {
        const std::size_t at = numbers * moments[group.moments[0]].left;
        for (std::size_t k = 0; k < kLanes; ++k) keys.of[k] = group.keys[first + k] + at;
    } else {
        for (std::size_t k = 0; k < kLanes; ++k)
            keys.of[k] = group.keys[first + k] + numbers * moments[group.moments[first + k]].left;
    }
    return keys;
}

/// Loads four numbers from `at` floats after each key: to[k] has track k, and track k + 4 in the upper lanes.
inline void load_keys(const Keys& keys, std::size_t at, Lanes* to) {
    for (std::size_t k = 0; k < 4; ++k) {
#if BENDY_LANES == 8
        to[k] =
            __builtin_shufflevector(load_quad(keys.of[k] + at), load_quad(keys.of[k + 4] + at), 0, 1, 2, 3, 4, 5, 6, 7);
#else
        to[k] = load_quad(keys.of[k] + at);
#endif
    }
}

/// Stores one number of kLanes joints, where these are animated.
inline void store_animated(const TrackGroup& group, std::size_t first, Lanes numbers, float* to) {
    if (!group.is_full) {
        Integers is_animated;
        __builtin_memcpy(&is_animated, group.is_animated + first, sizeof is_animated);
        numbers = is_animated < 0 ? numbers : load_lanes(to);
    }
    store_lanes(to, numbers);
}

/// Slerp along the shorter arc.
inline void sample_rotations(const TrackGroup& group, std::size_t first, const SampleBlock& block,
                             const Moments& moments) {
    Lanes quads[4];
    Lanes a[4];
    Lanes b[4];
    const Keys keys = keys_of<4>(group, first, block.moments);
    load_keys(keys, 0, quads);
    transpose(quads[0], quads[1], quads[2], quads[3], a);
    load_keys(keys, 4, quads);
    transpose(quads[0], quads[1], quads[2], quads[3], b);
    const Lanes dot = dot_of_four(a, b);
    const Lanes cosine = dot < 0.0f ? -dot : dot;
    const Lanes x = (cosine > 1.0f ? splat(1.0f) : cosine) - 1.0f;
    const bool is_near = least_of(cosine) >= Series::kNearCosine;
    const Shares shares = is_near ? shares_of<Series::kNearTerms>(moments.left, moments.right, x)
                                  : far_shares(moments.left, moments.right, x);
    Lanes by_b = dot < 0.0f ? -shares.right : shares.right;
    by_b = moments.fraction == 1.0f ? splat(1.0f) : by_b;  // exactly the key, including its sign
    float* const to = block.local + group.place + first;
    for (std::size_t c = 0; c < 4; ++c)
        store_animated(group, first, shares.left * a[c] + by_b * b[c], to + kBlockJoints * c);
}

/// From the left key and the right one, which follows it: x, y, z and a number without meaning.
inline Lanes between_keys(Lanes left, Lanes from_z, Lanes fraction) {
    return (1.0f - fraction) * left + fraction * shuffle<1, 2, 3, 3>(from_z, from_z);
}

inline void sample_vectors(const TrackGroup& group, std::size_t first, const SampleBlock& block, Lanes fraction) {
    const Keys keys = keys_of<3>(group, first, block.moments);
    Lanes left[4];
    Lanes from_z[4];  // the left key's last number, and the right key
    load_keys(keys, 0, left);
    load_keys(keys, 2, from_z);
    Lanes numbers[4];
    transpose(between_keys(left[0], from_z[0], everywhere<0>(fraction)),
              between_keys(left[1], from_z[1], everywhere<1>(fraction)),
              between_keys(left[2], from_z[2], everywhere<2>(fraction)),
              between_keys(left[3], from_z[3], everywhere<3>(fraction)), numbers);
    float* const to = block.local + group.place + first;
    for (std::size_t c = 0; c < 3; ++c) store_animated(group, first, numbers[c], to + kBlockJoints * c);
}

/// Stores three numbers of a joint in its block.
inline void store_three_of(float* to, Quad quad) {
    to[0] = quad[0];
    to[kBlockJoints] = quad[1];
    to[2 * kBlockJoints] = quad[2];
}

inline void sample_track(const VectorTrack& track, const SampleBlock& block) {
    const SampleMoment moment = block.moments[track.moment];
    const float* const keys = track.keys + std::size_t{3} * moment.left;
    const Quad from_z = load_quad(keys + 2);
    const Quad right = __builtin_shufflevector(from_z, from_z, 1, 2, 3, 3);
    store_three_of(block.local + track.place, (1.0f - moment.fraction) * load_quad(keys) + moment.fraction * right);
}

inline void sample_lanes(const SampleBlock& block) {
    std::uint32_t last = 0xffff'ffffu;
    Moments one(splat(0.0f));  // of the last group whose tracks have one moment
    for (std::size_t number = 0; number < block.rotation_groups; ++number) {
        const TrackGroup& group = block.rotations[number];
        if (group.is_one_moment) {
            if (group.moments[0] != last) one = Moments(splat(block.moments[group.moments[0]].fraction));
            last = group.moments[0];
            for (std::size_t first = 0; first < kBlockJoints; first += kLanes)
                sample_rotations(group, first, block, one);
        } else {
            for (std::size_t first = 0; first < kBlockJoints; first += kLanes)
                sample_rotations(group, first, block, Moments(fractions_of(group, first, block.moments)));
        }
    }
    for (std::size_t number = 0; number < block.vector_groups; ++number) {
        const TrackGroup& group = block.vectors[number];
        for (std::size_t first = 0; first < kBlockJoints; first += kLanes)
            sample_vectors(group, first, block,
                           group.is_one_moment ? splat(block.moments[group.moments[0]].fraction)
                                               : fractions_of(group, first, block.moments));
    }
    for (std::size_t k = 0; k < block.track_count; ++k) sample_track(block.tracks[k], block);
}

// NOLINTEND(misc-definitions-in-headers)
