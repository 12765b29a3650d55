// Stores vectors whose numbers are in lanes. Included after lanes.h by one source for each instruction set.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

/// \tparam streams  past the caches
template <bool streams, class Numbers>
inline void put(float* to, const Numbers& numbers) {
    if constexpr (streams) {
        stream(to, numbers);
    } else {
        store(to, numbers);
    }
}

/// Stores x, y, z of kLanes elements, as load_three loads them.
template <bool streams>
inline void store_packed(const Three& v, float* to) {
    const Lanes xy = shuffle<0, 2, 0, 2>(v.x, v.y);
    const Lanes yz = shuffle<1, 3, 1, 3>(v.y, v.z);
    const Lanes zx = shuffle<0, 2, 1, 3>(v.z, v.x);
    const Lanes a = shuffle<0, 2, 0, 2>(xy, zx);
    const Lanes b = shuffle<0, 2, 1, 3>(yz, xy);
    const Lanes c = shuffle<1, 3, 1, 3>(zx, yz);
#if BENDY_LANES == 8
    put<streams>(to, halves<0, 0>(a, b));
    put<streams>(to + 8, halves<0, 1>(c, a));
    put<streams>(to + 16, halves<1, 1>(b, c));
#else
    put<streams>(to, a);
    put<streams>(to + 4, b);
    put<streams>(to + 8, c);
#endif
}

/// Writes `kept` of each four numbers, `stride` apart.
template <int kept, bool streams>
inline void store_apart(Lanes x, Lanes y, Lanes z, Lanes w, float* to, std::size_t stride) {
    const auto put_vertex = [](float* vertex, Quad quad) {
        if constexpr (kept == 4) {
            put<streams>(vertex, quad);
        } else {
            store_three_of(vertex, quad);
        }
    };
    Lanes vertices[4];
    transpose(x, y, z, w, vertices);
    for (const Lanes& vertex : vertices) {
        put_vertex(to, low(vertex));
#if BENDY_LANES == 8
        put_vertex(to + 4 * stride, high(vertex));
#endif
        to += stride;
    }
}

// NOLINTEND(misc-definitions-in-headers)
