// Reads the numbers of a packed clip one at a time, for instruction sets without shifts per lane. Included after
// lanes.h.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

/// Reads a number of `size` bytes, little-endian like everything in the file; zeros beyond the payload's end.
template <class Number, bool is_near_end>
inline Number read_number(const unsigned char* from, const unsigned char* end) {
    Number number = 0;
    if (is_near_end && end - from < static_cast<std::ptrdiff_t>(sizeof number)) {
        if (end > from) std::memcpy(&number, from, static_cast<std::size_t>(end - from));
    } else {
        std::memcpy(&number, from, sizeof number);
    }
    return number;
}

template <bool is_near_end>
inline std::uint32_t read_bits(const unsigned char* frame, const UnpackWindows& windows, std::size_t lane,
                               const unsigned char* end) {
    if (windows.right[lane] == 32) return 0;
    const unsigned char* const window = frame + (lane < 4 ? windows.low : windows.high);
    const auto word = read_number<std::uint32_t, is_near_end>(window + windows.bytes[lane], end);
    return word << windows.left[lane] >> windows.right[lane];
}

/// Reads one component of kLanes tracks at both frames. Lanes beyond the group's tracks are zero.
template <bool is_near_end>
inline void read_component(const UnpackGroup& group, std::size_t component, std::size_t first,
                           const UnpackWindows& windows, const UnpackBlock& block, Lanes& left, Lanes& right) {
    const unsigned char* const bases = block.tables + group.bases + component * group.stride;
    std::int32_t a[kLanes];
    std::int32_t b[kLanes];
    for (std::size_t k = 0; k < kLanes; ++k) {
        const std::size_t lane = first + k;
        const unsigned char* const from = bases + lane * group.base_bytes;
        const std::int32_t base = group.base_bytes == 2 ? read_number<std::int16_t, is_near_end>(from, block.end)
                                                        : read_number<std::int32_t, is_near_end>(from, block.end);
        const auto from_base = static_cast<std::uint32_t>(base);
        a[k] = static_cast<std::int32_t>(from_base + read_bits<is_near_end>(block.left, windows, lane, block.end));
        b[k] = static_cast<std::int32_t>(from_base + read_bits<is_near_end>(block.right, windows, lane, block.end));
    }
    const Lanes step = load_lanes(group.steps[component] + first);
    left = from_integers(a) * step;
    right = from_integers(b) * step;
}

// NOLINTEND(misc-definitions-in-headers)
