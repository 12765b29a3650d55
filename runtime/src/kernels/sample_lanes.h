// The implementation of the sampling kernels, included after lanes.h by one source for each instruction set.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

/// sin(t a) / sin(a), the weight of one end of a slerp, is t + x t (1 - t^2) g with x = cos(a) - 1. Of g, the
/// coefficients of x^k, by powers of t^2: fitted to the least largest error, 3.1e-8 of the weight, for angles up to 90
/// degrees.
constexpr float kSlerpTerms[4][8] = {
    {-0.33332437f, 0.13360566f, -0.054326084f, 0.039327182f, 0.025814326f, 0.061644703f, 0.04330331f, 0.017685812f},
    {-3.028558e-6f, -0.03343266f, 0.01953624f, -0.016529154f, -0.010986094f, -0.028487712f, -0.020733183f,
     -0.008903766f},
    {-7.293666e-6f, -1.9245983e-4f, -0.0032827074f, -0.0057055443f, -0.015908686f, -0.017159494f, -0.010359596f,
     -0.001978312f},
    {1.0742694e-5f, 2.8862973e-4f, 0.002601923f, 0.011003862f, 0.024990909f, 0.030774353f, 0.019626623f, 0.0050113345f},
};

/// The weight of one end at one moment, for all angles; at a moment of its own for each lane if numbers are Lanes.
template <class Number>
struct SlerpWeight {
    Number t;
    Number c[8];  ///< coefficients of x^(k + 1)

    [[nodiscard]] Lanes at(Lanes x, Lanes x2, Lanes x4) const {
        const Lanes low = (c[0] + c[1] * x) + x2 * (c[2] + c[3] * x);
        const Lanes high = (c[4] + c[5] * x) + x2 * (c[6] + c[7] * x);
        return t + x * (low + x4 * high);
    }
};

inline SlerpWeight<float> slerp_weight(float time) {
    SlerpWeight<float> weight{time, {}};
    const float square = time * time;
    const float scale = time * (1.0f - square);
    for (std::size_t k = 0; k < 8; k += kLanes) {
        Lanes sum = load_lanes(kSlerpTerms[3] + k);
        for (std::size_t power = 3; power-- > 0;) sum = sum * square + load_lanes(kSlerpTerms[power] + k);
        store(weight.c + k, scale * sum);
    }
    return weight;
}

BENDY_NOINLINE inline SlerpWeight<Lanes> slerp_weight(Lanes time) {
    SlerpWeight<Lanes> weight{time, {}};
    const Lanes square = time * time;
    const Lanes scale = time * (1.0f - square);
    for (std::size_t k = 0; k < 8; ++k) {
        Lanes sum = kSlerpTerms[3][k];
        for (std::size_t power = 3; power-- > 0;) sum = sum * square + kSlerpTerms[power][k];
        weight.c[k] = scale * sum;
    }
    return weight;
}

/// The weights of two keys, and the sign of the right one.
template <class Number>
struct Moment {
    SlerpWeight<Number> left, right;
    Lanes sign;  ///< the bits of the right key to flip if the shorter arc leads to its negative; none at the key itself
    explicit Moment(Number fraction)
        : left(slerp_weight(1.0f - fraction)),
          right(slerp_weight(fraction)),
          sign(negatives(fraction - Lanes(1.0f)) & Lanes(-0.0f)) {}
};

/// Loads four numbers of kLanes tracks, one track per lane.
inline void load_fours(const float* const* keys, std::size_t at, Lanes* to) {
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

/// Slerp along the shorter arc from a, which receives the result, to b. At either end, exactly the key.
template <class Number>
inline void slerp(Lanes* a, const Lanes* b, const Moment<Number>& moment) {
    const Lanes dot = dot_of_four(a, b);
    const Lanes signs = negatives(dot) & moment.sign;
    const Lanes x = lesser(1.0f, dot ^ signs) - 1.0f;
    const Lanes x2 = x * x;
    const Lanes x4 = x2 * x2;
    const Lanes by_a = moment.left.at(x, x2, x4);
    const Lanes by_b = moment.right.at(x, x2, x4) ^ signs;
    for (std::size_t c = 0; c < 4; ++c) a[c] = by_a * a[c] + by_b * b[c];
}

inline void sample_rotations(const TrackGroup& group, std::size_t first, const SampleBlock& block,
                             const Moment<float>& moment) {
    Lanes a[4];
    Lanes b[4];
    load_fours(group.keys + first, 4 * block.left, a);
    load_fours(group.keys + first, 4 * block.left + 4, b);
    slerp(a, b, moment);
    store_tracks<4>(a, group, first, block.local);
}

/// Interpolates a vector, or two in the upper and lower lanes; the fourth number has no meaning.
template <class Numbers>
inline Numbers between_keys(Numbers left, Numbers left_z_and_right, const Moment<float>& moment) {
    return moment.left.t * left + moment.right.t * shuffle<1, 2, 3, 3>(left_z_and_right, left_z_and_right);
}

inline void sample_vectors(const TrackGroup& group, std::size_t first, const SampleBlock& block,
                           const Moment<float>& moment) {
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
    const Moment<float> moment(block.fraction);
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

/// Returns the position of each lane between its keys, 0 to 1.
inline Lanes fractions_of(const TimedBlock& block, std::size_t first) {
    const Lanes left = load_lanes(block.left + first);
    const Lanes right = load_lanes(block.right + first);
    const Lanes fraction = between((block.seconds - left) / (right - left), 0.0f, 1.0f);
    return chosen(negatives(block.seconds - right), fraction, 1.0f);
}

BENDY_NOINLINE inline void sample_timed_rotations(const TimedBlock& block, std::size_t first) {
    Lanes a[4];
    Lanes b[4];
    load_fours(block.keys + first, 0, a);
    load_fours(block.keys + first, 4, b);
    slerp(a, b, Moment<Lanes>(fractions_of(block, first)));
    store_tracks<4>(a, *block.group, first, block.local);
}

BENDY_NOINLINE inline void sample_timed_vectors(const TimedBlock& block, std::size_t first) {
    Lanes left[4];
    Lanes left_z_and_right[4];
    load_fours(block.keys + first, 0, left);
    load_fours(block.keys + first, 2, left_z_and_right);
    const Lanes fraction = fractions_of(block, first);
    for (std::size_t c = 0; c < 3; ++c) left[c] = (1.0f - fraction) * left[c] + fraction * left_z_and_right[c + 1];
    store_tracks<3>(left, *block.group, first, block.local);
}

inline void sample_timed_lanes(const TimedBlock& block) {
    for (std::size_t first = 0; first < kBlockJoints; first += kLanes)
        block.is_rotation ? sample_timed_rotations(block, first) : sample_timed_vectors(block, first);
}

/// The weights in a cubic Hermite spline of the left value and out-tangent, and of the right in-tangent and value.
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
    load_fours(group.keys + first, left, q);
    load_fours(group.keys + first, left + 4, out);
    load_fours(group.keys + first, left + 8, in);
    load_fours(group.keys + first, left + 12, right);
    for (std::size_t c = 0; c < 4; ++c)
        q[c] = (weights.left * q[c] + weights.out * out[c]) + (weights.in * in[c] + weights.right * right[c]);
    constexpr float kLeast = 1e-37f, kMost = 1e37f;  // a quaternion of zeros remains one
    const Lanes scale = 1.0f / roots_of(between(dot_of_four(q, q), kLeast, kMost));
    for (Lanes& number : q) number = number * scale;
    store_tracks<4>(q, group, first, block.local);
}

/// Only single vectors: the plan makes no groups of them.
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
