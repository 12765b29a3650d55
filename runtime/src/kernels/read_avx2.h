// Reads the numbers of a packed clip with AVX2, eight at a time. Included after lanes.h.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

constexpr std::ptrdiff_t kWindow = 16;  // bytes read at a time

/// Returns `from`, or a copy of the bytes up to the payload's end, padded with zeros.
template <std::ptrdiff_t size, bool is_near_end>
inline const unsigned char* reach(const unsigned char* from, const unsigned char* end, unsigned char* copy) {
    if (!is_near_end || end - from >= size) return from;
    std::memset(copy, 0, size);
    if (end > from) std::memcpy(copy, from, static_cast<std::size_t>(end - from));
    return copy;
}

template <bool is_near_end>
inline __m256i load_bases(const unsigned char* from, std::uint32_t base_bytes, const unsigned char* end) {
    alignas(32) unsigned char copy[32];
    from = reach<32, is_near_end>(from, end, copy);
    if (base_bytes == 2) return _mm256_cvtepi16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from)));
    return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
}

template <bool is_near_end>
inline __m128i load_window(const unsigned char* from, const unsigned char* end) {
    alignas(16) unsigned char copy[kWindow];
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(reach<kWindow, is_near_end>(from, end, copy)));
}

inline __m256i load_bytes(const std::uint8_t* bytes) {
    return _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(bytes)));
}

/// UnpackWindows, expanded: a source byte of the window for each byte of each lane.
struct Places {
    __m256i bytes, left, right;
};

inline Places load_places(const UnpackWindows& windows) {
    long long bytes = 0;
    std::memcpy(&bytes, windows.bytes, sizeof bytes);
    const __m256i all = _mm256_set1_epi64x(bytes);
    const __m256i each_four = _mm256_setr_epi8(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5,
                                               6, 6, 6, 6, 7, 7, 7, 7);
    return {_mm256_add_epi8(_mm256_shuffle_epi8(all, each_four), _mm256_set1_epi32(0x0302'0100)),
            load_bytes(windows.left), load_bytes(windows.right)};
}

template <bool is_near_end>
inline __m256i read_bits(const unsigned char* frame, const UnpackWindows& windows, const Places& places,
                         const unsigned char* end) {
    const __m256i both = _mm256_set_m128i(load_window<is_near_end>(frame + windows.high, end),
                                          load_window<is_near_end>(frame + windows.low, end));
    const __m256i words = _mm256_shuffle_epi8(both, places.bytes);
    return _mm256_srlv_epi32(_mm256_sllv_epi32(words, places.left), places.right);
}

/// Reads one component of a group at both frames. Lanes beyond the group's tracks are zero.
template <bool is_near_end>
inline void read_component(const UnpackGroup& group, std::size_t component, std::size_t /*first*/,
                           const UnpackWindows& windows, const UnpackBlock& block, Lanes& left, Lanes& right) {
    const unsigned char* const bases = block.tables + group.bases + component * group.stride;
    const __m256i base = load_bases<is_near_end>(bases, group.base_bytes, block.end);
    const Places places = load_places(windows);
    const Lanes step = load_lanes(group.steps[component]);
    const __m256i a = _mm256_add_epi32(base, read_bits<is_near_end>(block.left, windows, places, block.end));
    const __m256i b = _mm256_add_epi32(base, read_bits<is_near_end>(block.right, windows, places, block.end));
    left = _mm256_cvtepi32_ps(a) * step;
    right = _mm256_cvtepi32_ps(b) * step;
}

// NOLINTEND(misc-definitions-in-headers)
