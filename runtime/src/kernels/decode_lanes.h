// The implementation of the kernels that decode streams, included after lanes.h and store_lanes.h by one source for
// each instruction set.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

#if BENDY_LANES == 8

// NOLINTBEGIN(portability-simd-intrinsics): the only set of eight lanes
inline Lanes load_integers(const std::uint8_t* from) {
    return _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from))));
}
inline Lanes load_integers(const std::int8_t* from) {
    return _mm256_cvtepi32_ps(_mm256_cvtepi8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from))));
}
inline Lanes load_integers(const std::uint16_t* from) {
    return _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from))));
}
inline Lanes load_integers(const std::int16_t* from) {
    return _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from))));
}
inline Lanes load_integers(const std::uint32_t* from) {
    const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
    const Lanes upper = _mm256_cvtepi32_ps(_mm256_srli_epi32(all, 16));
    const Lanes lower = _mm256_cvtepi32_ps(_mm256_and_si256(all, _mm256_set1_epi32(0xffff)));
    return fused(upper, Lanes(65536.0f), lower);
}
// NOLINTEND(portability-simd-intrinsics)

#else

template <class T>
inline Lanes load_integers(const T* from) {
    const std::int32_t numbers[4] = {from[0], from[1], from[2], from[3]};
    return from_integers(numbers);
}
inline Lanes load_integers(const std::uint32_t* from) {
    std::int32_t upper[4];
    std::int32_t lower[4];
    for (std::size_t k = 0; k < 4; ++k) {
        upper[k] = static_cast<std::int32_t>(from[k] >> 16u);
        lower[k] = static_cast<std::int32_t>(from[k] & 0xffffu);
    }
    return fused(from_integers(upper), Lanes(65536.0f), from_integers(lower));
}

#endif

template <class T>
inline void decode_pattern(const T* from, const BoxedBlock& block, float* to) {
    for (std::size_t k = 0; k < BoxedBlock::kPattern; k += kLanes)
        store(to + k, fused(load_lanes(block.step + k), load_integers(from + k), load_lanes(block.minimum + k)));
}

template <class T>
inline void decode_boxed_as(const BoxedBlock& block) {
    constexpr std::size_t kPattern = BoxedBlock::kPattern;
    const T* const from = static_cast<const T*>(block.integers.data);
    std::size_t at = 0;
    for (; at + kPattern <= block.numbers; at += kPattern) decode_pattern(from + at, block, block.to + at);
    if (at == block.numbers) return;
    T last[kPattern]{};
    float decoded[kPattern];
    std::memcpy(last, from + at, (block.numbers - at) * sizeof(T));
    decode_pattern(last, block, decoded);
    std::memcpy(block.to + at, decoded, (block.numbers - at) * sizeof(float));
}

inline void decode_boxed_lanes(const BoxedBlock& block) {
    const auto [data, bytes, is_signed] = block.integers;
    if (bytes == 1) return is_signed ? decode_boxed_as<std::int8_t>(block) : decode_boxed_as<std::uint8_t>(block);
    if (bytes == 2) return is_signed ? decode_boxed_as<std::int16_t>(block) : decode_boxed_as<std::uint16_t>(block);
    decode_boxed_as<std::uint32_t>(block);
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

/// Decodes kLanes elements.
template <class T, std::size_t width>
inline void decode_directions(const T* from, float* to) {
    constexpr auto kLargest = static_cast<float>((1 << (8 * sizeof(T) - 1)) - 1);
    if constexpr (width == 2) {
        const Lanes first = load_integers(from);
        const Lanes second = load_integers(from + kLanes);
#if BENDY_LANES == 8
        const Lanes lower = halves<0, 0>(first, second);
        const Lanes upper = halves<1, 1>(first, second);
#else
        const Lanes lower = first;
        const Lanes upper = second;
#endif
        const Lanes a = shuffle<0, 2, 0, 2>(lower, upper);
        const Lanes b = shuffle<1, 3, 1, 3>(lower, upper);
        store_packed<false>(unfolded(a, b, kLargest), to);
    } else {
        float numbers[3 * kLanes];
        store(numbers, load_integers(from));
        store(numbers + kLanes, load_integers(from + kLanes));
        store(numbers + 2 * kLanes, load_integers(from + 2 * kLanes));
        const Three element = load_three(numbers);
        const Three v = unfolded(element.x, element.y, kLargest);
        store_apart<4, false>(v.x, v.y, v.z, -lesser(1.0f, -element.z / Lanes(kLargest)), to, 4);
    }
}

template <class T, std::size_t width>
inline void decode_directions_as(const DirectionsBlock& block) {
    constexpr std::size_t kNumbers = width == 2 ? 3 : 4;  // of a vector
    const T* const from = static_cast<const T*>(block.integers.data);
    std::size_t at = 0;
    for (; at + kLanes <= block.count; at += kLanes)
        decode_directions<T, width>(from + width * at, block.to + kNumbers * at);
    if (at == block.count) return;
    T last[width * kLanes]{};
    float decoded[kNumbers * kLanes];
    std::memcpy(last, from + width * at, width * (block.count - at) * sizeof(T));
    decode_directions<T, width>(last, decoded);
    std::memcpy(block.to + kNumbers * at, decoded, kNumbers * (block.count - at) * sizeof(float));
}

inline void decode_directions_lanes(const DirectionsBlock& block) {
    if (block.integers.bytes == 1) {
        return block.width == 2 ? decode_directions_as<std::int8_t, 2>(block)
                                : decode_directions_as<std::int8_t, 3>(block);
    }
    if (block.width == 2) return decode_directions_as<std::int16_t, 2>(block);
    decode_directions_as<std::int16_t, 3>(block);
}

// NOLINTEND(misc-definitions-in-headers)
