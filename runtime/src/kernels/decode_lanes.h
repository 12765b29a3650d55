// The implementation of the kernels that decode streams, included after lanes.h and store_lanes.h by one source for
// each instruction set.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

template <class T>
BENDY_NOINLINE void widen_as(const T* from, std::size_t count, float* to) {
    std::size_t at = 0;
    for (; at + kLanes <= count; at += kLanes) store(to + at, load_integers(from + at));
    if (at == count) return;
    T last[kLanes]{};
    std::memcpy(last, from + at, (count - at) * sizeof(T));
    store(to + at, load_integers(last));
}

/// Converts `count` integers from the number `first` on to floats; `to` has room for whole lanes.
inline void widen(const Integers& integers, std::size_t first, std::size_t count, float* to) {
    const auto [data, bytes, is_signed] = integers;
    if (bytes == 4) return widen_as(static_cast<const std::uint32_t*>(data) + first, count, to);
    if (bytes == 2 && is_signed) return widen_as(static_cast<const std::int16_t*>(data) + first, count, to);
    if (bytes == 2) return widen_as(static_cast<const std::uint16_t*>(data) + first, count, to);
    if (is_signed) return widen_as(static_cast<const std::int8_t*>(data) + first, count, to);
    widen_as(static_cast<const std::uint8_t*>(data) + first, count, to);
}

/// Numbers that are decoded at a time: of whole elements, and a multiple of BoxedBlock::kPattern and of all lanes.
constexpr std::size_t kDecoded = 96;

inline void decode_boxed_lanes(const BoxedBlock& block) {
    float numbers[kDecoded]{};
    for (std::size_t first = 0; first < block.numbers; first += kDecoded) {
        const std::size_t count = block.numbers - first < kDecoded ? block.numbers - first : kDecoded;
        widen(block.integers, first, count, numbers);
        float* const to = count == kDecoded ? block.to + first : numbers;
        for (std::size_t at = 0; at < kDecoded; at += BoxedBlock::kPattern) {
            for (std::size_t k = 0; k < BoxedBlock::kPattern; k += kLanes) {
                store(to + at + k,
                      fused(load_lanes(block.step + k), load_lanes(numbers + at + k), load_lanes(block.minimum + k)));
            }
        }
        if (count < kDecoded) std::memcpy(block.to + first, numbers, count * sizeof(float));
    }
}

/// Returns the unit vectors at points whose coordinates are integers, `largest` standing for 1; zero vectors where both
/// are the type's smallest.
inline Three unfolded(Lanes a, Lanes b, float largest) {
    const Lanes is_there = negatives(-2.0f * largest - 1.5f - (a + b));
    a = -lesser(largest, -a);
    b = -lesser(largest, -b);
    const Lanes sign_of_a = signs_of(a), sign_of_b = signs_of(b);
    const Lanes up = (largest - (a ^ sign_of_a)) - (b ^ sign_of_b);
    const Lanes below = -lesser(up, 0.0f);  // where it is not zero, the point is on a folded corner
    const Lanes right = a - (below ^ sign_of_a);
    const Lanes ahead = b - (below ^ sign_of_b);
    const Lanes scale = inverse_roots_of(fused(right, right, fused(ahead, ahead, up * up))) & is_there;
    return {right * scale, ahead * scale, up * scale};
}

/// Decodes kLanes elements whose integers are floats.
template <std::size_t width>
inline void decode_directions(const float* from, float largest, float* to) {
    if constexpr (width == 2) {
        const Lanes first = load_lanes(from);
        const Lanes second = load_lanes(from + kLanes);
#if BENDY_LANES == 8
        const Lanes lower = halves<0, 0>(first, second);
        const Lanes upper = halves<1, 1>(first, second);
#else
        const Lanes lower = first;
        const Lanes upper = second;
#endif
        store_packed<false>(unfolded(shuffle<0, 2, 0, 2>(lower, upper), shuffle<1, 3, 1, 3>(lower, upper), largest),
                            to);
    } else {
        const Three element = load_three(from);
        const Three v = unfolded(element.x, element.y, largest);
        store_apart<4, false>(v.x, v.y, v.z, -lesser(1.0f, -element.z / Lanes(largest)), to, 4);
    }
}

template <std::size_t width>
inline void decode_directions_of(const DirectionsBlock& block) {
    constexpr std::size_t kElements = kDecoded / 3;
    const float largest = block.integers.bytes == 1 ? 127.0f : 32767.0f;
    float numbers[kDecoded]{};
    float decoded[4 * kElements];
    for (std::size_t first = 0; first < block.count; first += kElements) {
        const std::size_t count = block.count - first < kElements ? block.count - first : kElements;
        widen(block.integers, width * first, width * count, numbers);
        float* const out = block.to + (width + 1) * first;
        float* const to = count == kElements ? out : decoded;
        for (std::size_t k = 0; k < kElements; k += kLanes)
            decode_directions<width>(numbers + width * k, largest, to + (width + 1) * k);
        if (count < kElements) std::memcpy(out, decoded, (width + 1) * count * sizeof(float));
    }
}

inline void decode_directions_lanes(const DirectionsBlock& block) {
    if (block.width == 2) return decode_directions_of<2>(block);
    decode_directions_of<3>(block);
}

// NOLINTEND(misc-definitions-in-headers)
