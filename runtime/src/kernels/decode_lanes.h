// The implementation of the kernels that decode streams, included after lanes.h and store_lanes.h by one source for
// each instruction set.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

/// Decodes BoxedBlock::kPattern numbers at a time. Takes a copy: for a reference, the compiler would read it anew after
/// each store.
template <class T>
BENDY_NOINLINE void decode_boxed_as(const BoxedBlock block) {
    constexpr std::size_t kPattern = BoxedBlock::kPattern;
    const auto decode = [&](const T* from, float* to) {
        for (std::size_t k = 0; k < kPattern; k += kLanes)
            store(to + k, fused(load_lanes(block.step + k), load_integers(from + k), load_lanes(block.minimum + k)));
    };
    const T* from = static_cast<const T*>(block.integers.data);
    float* to = block.to;
    std::size_t left = block.numbers;
    for (; left >= kPattern; left -= kPattern, from += kPattern, to += kPattern) decode(from, to);
    T integers[kPattern]{};
    float numbers[kPattern];
    std::memcpy(integers, from, left * sizeof(T));
    decode(integers, numbers);
    std::memcpy(to, numbers, left * sizeof(float));
}

inline void decode_boxed_lanes(const BoxedBlock& block) {
    const auto [data, bytes, is_signed] = block.integers;
    if (bytes == 4) return decode_boxed_as<std::uint32_t>(block);
    if (bytes == 2) return is_signed ? decode_boxed_as<std::int16_t>(block) : decode_boxed_as<std::uint16_t>(block);
    is_signed ? decode_boxed_as<std::int8_t>(block) : decode_boxed_as<std::uint8_t>(block);
}

/// Returns the unit vectors at points whose coordinates are integers, `largest` standing for 1; zero vectors where both
/// are the type's smallest.
inline Three unfolded(Lanes a, Lanes b, float largest) {
    const Lanes is_there = negatives(-2.0f * largest - 1.5f - (a + b));
    a = between(a, -largest, largest);
    b = between(b, -largest, largest);
    const Lanes sign_of_a = a & Lanes(-0.0f), sign_of_b = b & Lanes(-0.0f);
    const Lanes up = (largest - (a ^ sign_of_a)) - (b ^ sign_of_b);
    const Lanes below = lesser(up, 0.0f);  // where it is not zero, the point is on a folded corner
    const Lanes right = a + (below ^ sign_of_a);
    const Lanes ahead = b + (below ^ sign_of_b);
    const Lanes scale = inverse_roots_of(fused(right, right, fused(ahead, ahead, up * up))) & is_there;
    return {right * scale, ahead * scale, up * scale};
}

/// Loads kLanes pairs of integers.
template <class T>
inline void load_pairs(const T* from, Lanes& first, Lanes& second) {
#if BENDY_LANES == 8
    load_integer_pairs(from, first, second);
#else
    const Lanes lower = load_integers(from);
    const Lanes upper = load_integers(from + kLanes);
    first = shuffle<0, 2, 0, 2>(lower, upper);
    second = shuffle<1, 3, 1, 3>(lower, upper);
#endif
}

/// The integer that stands for 1.
template <class T>
constexpr auto kLargest = static_cast<float>((1 << (8 * sizeof(T) - 1)) - 1);

/// Decodes kLanes elements of two integers.
template <class T>
inline Three load_directions(const T* from) {
    Lanes a, b;
    load_pairs(from, a, b);
    return unfolded(a, b, kLargest<T>);
}

/// Decodes kLanes elements.
template <std::size_t width, class T>
inline void decode_directions(const T* from, float* to) {
    if constexpr (width == 2) {
        store_packed<false>(load_directions(from), to);
    } else {
        float numbers[width * kLanes];
        for (std::size_t k = 0; k < width * kLanes; k += kLanes) store(numbers + k, load_integers(from + k));
        const Three element = load_three(numbers);
        const Three v = unfolded(element.x, element.y, kLargest<T>);
        store_apart<4, false>(v.x, v.y, v.z, -lesser(1.0f, -element.z / Lanes(kLargest<T>)), to, 4);
    }
}

template <std::size_t width, class T>
BENDY_NOINLINE void decode_directions_of(const DirectionsBlock block) {
    const T* const integers = static_cast<const T*>(block.integers.data);
    std::size_t at = 0;
    for (; at + kLanes <= block.count; at += kLanes)
        decode_directions<width>(integers + width * at, block.to + (width + 1) * at);
    T some[width * kLanes]{};
    float decoded[(width + 1) * kLanes];
    std::memcpy(some, integers + width * at, (block.count - at) * width * sizeof(T));
    decode_directions<width>(some, decoded);
    std::memcpy(block.to + (width + 1) * at, decoded, (block.count - at) * (width + 1) * sizeof(float));
}

inline void decode_directions_lanes(const DirectionsBlock& block) {
    const bool is_short = block.integers.bytes == 2;
    if (block.width == 2) {
        return is_short ? decode_directions_of<2, std::int16_t>(block) : decode_directions_of<2, std::int8_t>(block);
    }
    is_short ? decode_directions_of<3, std::int16_t>(block) : decode_directions_of<3, std::int8_t>(block);
}

// NOLINTEND(misc-definitions-in-headers)
