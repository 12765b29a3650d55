// The numbers of kLanes joints of a block, in registers: number c is kBlockJoints floats after number c - 1. Included
// after lanes.h by one source for each instruction set.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

// Without loops, which GCC would turn into copies of memory, sixteen bytes at a time.

template <std::size_t count>
inline void load_numbers(const float* from, Lanes* to) {
    if constexpr (count > 1) load_numbers<count - 1>(from, to);
    to[count - 1] = load_lanes(from + kBlockJoints * (count - 1));
}

template <std::size_t count>
inline void store_numbers(const Lanes* numbers, float* to) {
    if constexpr (count > 1) store_numbers<count - 1>(numbers, to);
    store(to + kBlockJoints * (count - 1), numbers[count - 1]);
}

/// Leaves joints outside the mask unchanged.
template <std::size_t count>
inline void store_numbers(const Lanes* numbers, Lanes mask, float* to) {
    if constexpr (count > 1) store_numbers<count - 1>(numbers, mask, to);
    float* const place = to + kBlockJoints * (count - 1);
    store(place, chosen(mask, numbers[count - 1], load_lanes(place)));
}

// NOLINTEND(misc-definitions-in-headers)
