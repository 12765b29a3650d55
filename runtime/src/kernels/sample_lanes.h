// The implementation of the sampling kernels, included after lanes.h by one source for each instruction set.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

/// sin(t a) / sin(a) by Eberly's series, "A Fast and Accurate Algorithm for Computing SLERP", 2011:
/// t (1 + k1 x (1 + k2 x (...))), x = cos(a) - 1, k_i = (t^2 / i - i) / (2 i + 1).
constexpr int kFarTerms = 24;  // at right angles each term is half the previous one
constexpr int kNearTerms = 4;
constexpr float kNearCosine = 0.9f;

struct SeriesTerms {
    float of_square[kFarTerms], constant[kFarTerms];
};
constexpr SeriesTerms make_series_terms() {
    SeriesTerms terms{};
    for (int k = 0; k < kFarTerms; ++k) {
        const double i = k + 1.0;
        terms.of_square[k] = static_cast<float>(1.0 / (i * (2.0 * i + 1.0)));
        terms.constant[k] = static_cast<float>(i / (2.0 * i + 1.0));
    }
    return terms;
}
constexpr SeriesTerms kSeriesTerms = make_series_terms();

/// The series at one moment.
template <int terms>
struct Series {
    float t;
    float k[terms];

    explicit Series(float time) : t(time) {
        const float square = time * time;
        for (int i = 0; i < terms; ++i) k[i] = square * kSeriesTerms.of_square[i] - kSeriesTerms.constant[i];
    }
    [[nodiscard]] Lanes at(Lanes x) const {
        Lanes sum = 1.0f;
        for (int i = terms; i-- > 0;) sum = 1.0f + (k[i] * x) * sum;
        return t * sum;
    }
};

/// For the weights of two keys. Most rotations between keys are small: the terms for larger ones are computed when they
/// are needed.
struct Moment {
    Series<kNearTerms> left, right;
    explicit Moment(float fraction) : left(1.0f - fraction), right(fraction) {}
};

inline float least_of(Lanes lanes) {
#if BENDY_LANES == 8
    Quad least = lesser(low(lanes), high(lanes));
#else
    Quad least = lanes;
#endif
    least = lesser(least, shuffle<2, 3, 0, 1>(least, least));
    return first_of(lesser(least, shuffle<1, 0, 3, 2>(least, least)));
}

/// Loads the rotations of kLanes tracks, one track per lane.
inline void load_rotations(const float* const* keys, std::size_t at, Lanes* to) {
    Lanes quads[4];
    for (std::size_t k = 0; k < 4; ++k) quads[k] = load_quads(keys[k] + at, keys[(k + 4) % kLanes] + at);
    transpose(quads[0], quads[1], quads[2], quads[3], to);
}

/// Stores numbers of the group's lanes from `first` on, where these have a track.
template <std::size_t count>
inline void store_tracks(const Lanes* numbers, const TrackGroup& group, std::size_t first, float* local) {
    float* const to = local + group.place + first;
    if (group.count == kBlockJoints) return store_numbers<count>(numbers, to);
    store_numbers<count>(numbers, load_mask(group.has_track + first), to);
}

/// Stores three numbers of one joint.
inline void store_joint_vector(float* to, Quad vector) {
    float numbers[4];
    store(numbers, vector);
    for (std::size_t c = 0; c < 3; ++c) to[kBlockJoints * c] = numbers[c];
}

/// The weights of the two ends of an interpolated rotation.
struct Shares {
    Lanes left, right;
};

template <int terms>
BENDY_NOINLINE Shares far_shares(const Moment& moment, Lanes x) {
    return {Series<terms>(moment.left.t).at(x), Series<terms>(moment.right.t).at(x)};
}

inline Shares near_shares(const Moment& moment, Lanes x) {
    return {moment.left.at(x), moment.right.at(x)};
}

/// Slerp along the shorter arc.
inline void sample_rotations(const TrackGroup& group, std::size_t first, const SampleBlock& block,
                             const Moment& moment) {
    Lanes a[4];
    Lanes b[4];
    load_rotations(group.keys + first, 4 * block.left, a);
    load_rotations(group.keys + first, 4 * block.left + 4, b);
    const Lanes dot = dot_of_four(a, b);
    const Lanes signs = signs_of(dot);
    const Lanes cosine = dot ^ signs;
    const Lanes x = lesser(1.0f, cosine) - 1.0f;
    const bool is_near = least_of(cosine) >= kNearCosine;
    const Shares shares = is_near ? near_shares(moment, x) : far_shares<kFarTerms>(moment, x);
    Lanes by_b = shares.right ^ signs;
    if (block.fraction == 1.0f) by_b = Lanes(1.0f);  // exactly the key, including its sign
    for (std::size_t c = 0; c < 4; ++c) a[c] = shares.left * a[c] + by_b * b[c];
    store_tracks<4>(a, group, first, block.local);
}

/// Interpolates a vector, or two in the upper and lower lanes; the fourth number has no meaning.
template <class Numbers>
inline Numbers between_keys(Numbers left, Numbers left_z_and_right, const Moment& moment) {
    return moment.left.t * left + moment.right.t * shuffle<1, 2, 3, 3>(left_z_and_right, left_z_and_right);
}

inline void sample_vectors(const TrackGroup& group, std::size_t first, const SampleBlock& block, const Moment& moment) {
    const float* const* const keys = group.keys + first;
    const std::size_t at = 3 * block.left;
    Lanes vectors[4];
    for (std::size_t k = 0; k < 4; ++k) {
        const float* const lower = keys[k] + at;
        const float* const upper = keys[(k + 4) % kLanes] + at;
        vectors[k] = between_keys(load_quads(lower, upper), load_quads(lower + 2, upper + 2), moment);
    }
    Lanes numbers[4];
    transpose(vectors[0], vectors[1], vectors[2], vectors[3], numbers);
    store_tracks<3>(numbers, group, first, block.local);
}

inline void sample_lanes(const SampleBlock& block) {
    const Moment moment(block.fraction);
    for (std::size_t group = 0; group < block.rotation_groups; ++group) {
        for (std::size_t first = 0; first < kBlockJoints; first += kLanes)
            sample_rotations(block.rotations[group], first, block, moment);
    }
    for (std::size_t group = 0; group < block.vector_groups; ++group) {
        for (std::size_t first = 0; first < kBlockJoints; first += kLanes)
            sample_vectors(block.vectors[group], first, block, moment);
    }
    for (std::size_t k = 0; k < block.track_count; ++k) {
        const VectorTrack& track = block.tracks[k];
        const float* const keys = track.keys + 3 * block.left;
        store_joint_vector(block.local + track.place, between_keys(load_quad(keys), load_quad(keys + 2), moment));
    }
}

/// What a cubic Hermite spline takes of the left value and out-tangent, and of the right in-tangent and value.
struct CubicWeights {
    float left, out, in, right;

    explicit CubicWeights(const SampleBlock& block) {
        const double u = block.fraction;
        const double u2 = u * u;
        const double u3 = u2 * u;
        left = static_cast<float>(2.0 * u3 - 3.0 * u2 + 1.0);
        out = static_cast<float>(block.seconds * (u3 - 2.0 * u2 + u));
        in = static_cast<float>(block.seconds * (u3 - u2));
        right = static_cast<float>(3.0 * u2 - 2.0 * u3);
    }
};

inline void sample_cubic_rotations(const TrackGroup& group, std::size_t first, const SampleBlock& block,
                                   const CubicWeights& weights) {
    const std::size_t left = 12 * block.left + 4;
    Lanes q[4];
    Lanes out[4];
    Lanes in[4];
    Lanes right[4];
    load_rotations(group.keys + first, left, q);
    load_rotations(group.keys + first, left + 4, out);
    load_rotations(group.keys + first, left + 8, in);
    load_rotations(group.keys + first, left + 12, right);
    for (std::size_t c = 0; c < 4; ++c)
        q[c] = (weights.left * q[c] + weights.out * out[c]) + (weights.in * in[c] + weights.right * right[c]);
    constexpr float kLeast = 1e-37f, kMost = 1e37f;  // a quaternion of zeros remains one
    const Lanes scale = 1.0f / roots_of(between(dot_of_four(q, q), kLeast, kMost));
    for (Lanes& number : q) number = number * scale;
    store_tracks<4>(q, group, first, block.local);
}

/// Vectors one by one only: the plan makes no groups of them.
inline void sample_cubic_lanes(const SampleBlock& block) {
    const CubicWeights weights(block);
    for (std::size_t group = 0; group < block.rotation_groups; ++group) {
        for (std::size_t first = 0; first < kBlockJoints; first += kLanes)
            sample_cubic_rotations(block.rotations[group], first, block, weights);
    }
    for (std::size_t k = 0; k < block.track_count; ++k) {
        const VectorTrack& track = block.tracks[k];
        const float* const left = track.keys + 9 * block.left + 3;
        store_joint_vector(block.local + track.place,
                           (weights.left * load_quad(left) + weights.out * load_quad(left + 3)) +
                               (weights.in * load_quad(left + 6) + weights.right * load_quad(left + 9)));
    }
}

// NOLINTEND(misc-definitions-in-headers)
