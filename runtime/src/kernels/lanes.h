// Vectors of four or eight floats, each lane for another vertex or joint. Included by one header per instruction set,
// which defines BENDY_LANES (4 or 8), the types Lanes and Quad, and the operations that differ between instruction
// sets.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

constexpr std::size_t kLanes = BENDY_LANES;

struct Three {
    Lanes x, y, z;
};

#if BENDY_LANES == 4
inline Lanes load_lanes(const float* from) {
    return load_quad(from);
}
inline Lanes repeat(const float* quad) {
    return load_quad(quad);
}
inline Quad low(Lanes lanes) {
    return lanes;
}
#endif

/// Loads four numbers; into the upper lanes, if there are any, those from `upper`.
inline Lanes load_quads(const float* lower, [[maybe_unused]] const float* upper) {
#if BENDY_LANES == 8
    return joined(load_quad(lower), load_quad(upper));
#else
    return load_quad(lower);
#endif
}
inline Lanes load_quads(const float* from, std::size_t apart) {
    return load_quads(from, from + apart);
}
inline void store_quads(Lanes lanes, float* lower, [[maybe_unused]] float* upper) {
    store(lower, low(lanes));
#if BENDY_LANES == 8
    store(upper, high(lanes));
#endif
}

/// Transposes four numbers of each of four vertices (and of four more per four upper lanes): to[c] receives number c of
/// every vertex.
inline void transpose(Lanes a, Lanes b, Lanes c, Lanes d, Lanes* to) {
    const Lanes ab_low = shuffle<0, 1, 0, 1>(a, b);
    const Lanes ab_high = shuffle<2, 3, 2, 3>(a, b);
    const Lanes cd_low = shuffle<0, 1, 0, 1>(c, d);
    const Lanes cd_high = shuffle<2, 3, 2, 3>(c, d);
    to[0] = shuffle<0, 2, 0, 2>(ab_low, cd_low);
    to[1] = shuffle<1, 3, 1, 3>(ab_low, cd_low);
    to[2] = shuffle<0, 2, 0, 2>(ab_high, cd_high);
    to[3] = shuffle<1, 3, 1, 3>(ab_high, cd_high);
}

/// Loads x, y, z of kLanes elements.
inline Three load_three(const float* from) {
#if BENDY_LANES == 8  // whole vectors, since the processor loads them as fast as halves
    const Lanes ab = load_lanes(from);
    const Lanes ca = load_lanes(from + 8);
    const Lanes bc = load_lanes(from + 16);
    const Lanes a = halves<0, 1>(ab, ca);
    const Lanes b = halves<1, 0>(ab, bc);
    const Lanes c = halves<0, 1>(ca, bc);
#else
    const Lanes a = load_quads(from, 12);
    const Lanes b = load_quads(from + 4, 12);
    const Lanes c = load_quads(from + 8, 12);
#endif
    const Lanes xy = shuffle<2, 3, 1, 2>(b, c);
    const Lanes yz = shuffle<1, 2, 0, 1>(a, b);
    return {shuffle<0, 3, 0, 2>(a, xy), shuffle<0, 2, 1, 3>(yz, xy), shuffle<1, 3, 0, 3>(yz, c)};
}

/// Loads x, y, z, w of kLanes elements.
inline void load_four(const float* from, Lanes* to) {
    transpose(load_quads(from, 16), load_quads(from + 4, 16), load_quads(from + 8, 16), load_quads(from + 12, 16), to);
}

inline Lanes dot_of_four(const Lanes* a, const Lanes* b) {
    return (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3]);
}

/// The sign bit of each negative number; not of -0.
template <class Numbers>
inline Numbers signs_of(Numbers numbers) {
    return negatives(numbers) & Numbers(-0.0f);
}

// NOLINTEND(misc-definitions-in-headers)
