// Vectors of four or eight floats, each lane for another vertex or joint. Included by one source per instruction set,
// which defines BENDY_LANES (4 or 8) and includes lane_types.h.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

struct Three {
    Lanes x, y, z;
};

inline Lanes splat(float number) {
#if BENDY_LANES == 8
    return Lanes{number, number, number, number, number, number, number, number};
#else
    return Lanes{number, number, number, number};
#endif
}

inline Quad load_quad(const float* from) {
    Quad quad;
    __builtin_memcpy(&quad, from, sizeof quad);
    return quad;
}

inline void store_quad(float* to, Quad quad) {
    __builtin_memcpy(to, &quad, sizeof quad);
}

/// In each group of four lanes: elements a and b of x, c and d of y.
template <int a, int b, int c, int d>
inline Lanes shuffle(Lanes x, Lanes y) {
#if BENDY_LANES == 8
    return __builtin_shufflevector(x, y, a, b, 8 + c, 8 + d, 4 + a, 4 + b, 12 + c, 12 + d);
#else
    return __builtin_shufflevector(x, y, a, b, 4 + c, 4 + d);
#endif
}

/// Loads consecutive numbers.
inline Lanes load_lanes(const float* from) {
    Lanes lanes;
    __builtin_memcpy(&lanes, from, sizeof lanes);
    return lanes;
}

#if BENDY_LANES == 4
/// Four numbers, repeated in the upper lanes if there are any: defined by instruction sets with upper lanes.
inline Lanes repeat(const float* quad) {
    return load_lanes(quad);
}
#endif

inline void store_lanes(float* to, Lanes lanes) {
    __builtin_memcpy(to, &lanes, sizeof lanes);
}

/// Loads four numbers from `from`; into the upper lanes, if there are any, those `apart` floats further on, and so on.
inline Lanes load_quads(const float* from, [[maybe_unused]] std::size_t apart) {
#if BENDY_LANES == 8
    return __builtin_shufflevector(load_quad(from), load_quad(from + apart), 0, 1, 2, 3, 4, 5, 6, 7);
#else
    return load_quad(from);
#endif
}

/// Returns the four lanes from 4 * part on.
template <int part>
inline Quad quad_of(Lanes lanes) {
#if BENDY_LANES == 4
    return lanes;
#else
    return __builtin_shufflevector(lanes, lanes, 4 * part, 4 * part + 1, 4 * part + 2, 4 * part + 3);
#endif
}
inline Quad low(Lanes lanes) {
    return quad_of<0>(lanes);
}
#if BENDY_LANES == 8
inline Quad high(Lanes lanes) {
    return quad_of<1>(lanes);
}
#endif

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
    const Lanes a = __builtin_shufflevector(ab, ca, 0, 1, 2, 3, 12, 13, 14, 15);
    const Lanes b = __builtin_shufflevector(ab, bc, 4, 5, 6, 7, 8, 9, 10, 11);
    const Lanes c = __builtin_shufflevector(ca, bc, 0, 1, 2, 3, 12, 13, 14, 15);
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

/// Broadcasts one number of each group of four to all four lanes.
template <int place>
inline Lanes everywhere(Lanes lanes) {
    return shuffle<place, place, place, place>(lanes, lanes);
}

// NOLINTEND(misc-definitions-in-headers)
