// The implementation of the sampling kernels, included after lanes.h by one source for each instruction set.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

/// sin(t a) / sin(a) by Eberly's series, "A Fast and Accurate Algorithm for Computing SLERP", 2011:
/// t (1 + k1 x (1 + k2 x (...))), x = cos(a) - 1, k_i = (t^2 / i - i) / (2 i + 1).
struct Series {
    static constexpr int kTerms = 24;  // at right angles each term is half the previous one
    static constexpr int kNearTerms = 4;
    static constexpr float kNearCosine = 0.9f;
    float t;
    float k[kTerms];

    explicit Series(float time) : t(time) {
        const float square = time * time;
        for (int i = 0; i < kTerms; ++i) {
            const auto number = static_cast<float>(i + 1);
            k[i] = (square * (1.0f / number) - number) * (1.0f / (2.0f * number + 1.0f));
        }
    }
    template <int terms>
    [[nodiscard]] Lanes at(Lanes x) const {
        Lanes sum = 1.0f;
        for (int i = terms; i-- > 0;) sum = 1.0f + (k[i] * x) * sum;
        return t * sum;
    }
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
    for (std::size_t k = 0; k < 4; ++k) {
#if BENDY_LANES == 8
        quads[k] = joined(load_quad(keys[k] + at), load_quad(keys[k + 4] + at));
#else
        quads[k] = load_quad(keys[k] + at);
#endif
    }
    transpose(quads[0], quads[1], quads[2], quads[3], to);
}

inline void store_rotations(const Lanes* numbers, const std::uint32_t* places, float* to) {
    Lanes quads[4];
    transpose(numbers[0], numbers[1], numbers[2], numbers[3], quads);
    for (std::size_t k = 0; k < 4; ++k) {
        store(to + places[k], low(quads[k]));
#if BENDY_LANES == 8
        store(to + places[k + 4], high(quads[k]));
#endif
    }
}

/// The weights of the two ends of an interpolated rotation.
struct Shares {
    Lanes left, right;
};

template <int terms>
inline Shares shares_of(const Series& left, const Series& right, Lanes x) {
    return {left.at<terms>(x), right.at<terms>(x)};
}

BENDY_NOINLINE Shares far_shares(const Series& left, const Series& right, Lanes x) {
    return shares_of<Series::kTerms>(left, right, x);
}

/// Slerp along the shorter arc.
inline void sample_rotations(const RotationTracks& tracks, std::size_t first, const SampleBlock& block,
                             const Series& left, const Series& right) {
    Lanes a[4];
    Lanes b[4];
    load_rotations(tracks.keys + first, 4 * block.left, a);
    load_rotations(tracks.keys + first, 4 * block.left + 4, b);
    const Lanes dot = dot_of_four(a, b);
    const Lanes signs = signs_of(dot);
    const Lanes cosine = dot ^ signs;
    const Lanes x = lesser(1.0f, cosine) - 1.0f;
    const bool is_near = least_of(cosine) >= Series::kNearCosine;
    const Shares shares = is_near ? shares_of<Series::kNearTerms>(left, right, x) : far_shares(left, right, x);
    Lanes by_b = shares.right ^ signs;
    if (block.fraction == 1.0f) by_b = Lanes(1.0f);  // exactly the key, including its sign
    for (std::size_t c = 0; c < 4; ++c) a[c] = shares.left * a[c] + by_b * b[c];
    store_rotations(a, tracks.places + first, block.local);
}

inline void sample_lanes(const SampleBlock& block) {
    const Series left(1.0f - block.fraction);
    const Series right(block.fraction);
    for (std::size_t group = 0; group < block.rotation_groups; ++group) {
        for (std::size_t first = 0; first < RotationTracks::kMost; first += kLanes)
            sample_rotations(block.rotations[group], first, block, left, right);
    }
    for (std::size_t k = 0; k < block.vector_tracks; ++k) {
        const VectorTrack& track = block.vectors[k];
        const float* const keys = track.keys + 3 * block.left;
        const Quad both = load_quad(keys + 2);  // the left key's last number, and the right key
        const Quad moved = shuffle<1, 2, 3, 3>(both, both);
        store_three_of(block.local + track.place, left.t * load_quad(keys) + right.t * moved);
    }
}

// NOLINTEND(misc-definitions-in-headers)
