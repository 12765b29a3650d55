// The implementation of the kernel that adds morph targets, included after lanes.h and store_lanes.h by one source for
// each instruction set.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

/// Numbers of vertices that are displaced at a time: whole vertices, and whole lanes.
constexpr std::size_t kDisplaced = 3 * kLanes;

inline float fused_one(float a, float b, float c) {
    return first_of(fused(Quad(a), Quad(b), Quad(c)));
}

/// The numbers of a target, x y z of one entry after the other, stored as floats.
struct FloatShifts {
    const float* numbers;

    /// Returns kLanes numbers from `at` on, the first of which is the component `first`.
    [[nodiscard]] Lanes lanes(std::size_t at, std::size_t /*first*/) const { return load_lanes(numbers + at); }
    [[nodiscard]] float number(std::size_t at, std::size_t /*component*/) const { return numbers[at]; }
};

/// The same, stored as minimum + step * integer.
template <class T>
class BoxedShifts {
public:
    explicit BoxedShifts(const DisplaceBlock& block) : numbers_(static_cast<const T*>(block.integers.data)) {
        for (std::size_t k = 0; k < kRepeated; ++k) {
            minimum_[k] = block.minimum[k % 3];
            step_[k] = block.step[k % 3];
        }
    }

    [[nodiscard]] Lanes lanes(std::size_t at, std::size_t first) const {
        return fused(load_lanes(step_ + first), load_integers(numbers_ + at), load_lanes(minimum_ + first));
    }
    [[nodiscard]] float number(std::size_t at, std::size_t component) const {
        return fused_one(step_[component], static_cast<float>(numbers_[at]), minimum_[component]);
    }

private:
    static constexpr std::size_t kRepeated = kLanes + 2;

    const T* numbers_;
    float minimum_[kRepeated], step_[kRepeated];  // of x y z x y z ...
};

/// Takes copies: for references, the compiler would read all numbers anew after each store.
template <class Shifts>
BENDY_NOINLINE void displace_by(const Shifts shifts, const DisplaceBlock block) {
    const Lanes weight = block.weight;
    for (std::size_t run = 0; run < block.count; ++run) {
        const auto [entry, vertex, count] = block.runs[run];
        std::size_t at = std::size_t{entry} * 3;
        float* to = block.to + vertex * block.width;
        if (block.width != 3) {
            for (std::uint32_t k = 0; k < count; ++k, at += 3, to += block.width) {
                for (std::size_t c = 0; c < 3; ++c) to[c] = fused_one(block.weight, shifts.number(at + c, c), to[c]);
            }
            continue;
        }
        std::size_t left = std::size_t{count} * 3;
        for (; left >= kDisplaced; left -= kDisplaced, at += kDisplaced, to += kDisplaced) {
            for (std::size_t k = 0; k < kDisplaced; k += kLanes)
                store(to + k, fused(weight, shifts.lanes(at + k, k % 3), load_lanes(to + k)));
        }
        std::size_t k = 0;
        for (; k + kLanes <= left; k += kLanes)
            store(to + k, fused(weight, shifts.lanes(at + k, k % 3), load_lanes(to + k)));
        for (; k < left; ++k) to[k] = fused_one(block.weight, shifts.number(at + k, k % 3), to[k]);
    }
}

template <class T>
inline void displace_boxed(const DisplaceBlock& block) {
    displace_by(BoxedShifts<T>(block), block);
}

inline void displace_lanes(const DisplaceBlock& block) {
    if (block.floats != nullptr) return displace_by(FloatShifts{block.floats}, block);
    const auto [data, bytes, is_signed] = block.integers;
    if (bytes == 2) return is_signed ? displace_boxed<std::int16_t>(block) : displace_boxed<std::uint16_t>(block);
    is_signed ? displace_boxed<std::int8_t>(block) : displace_boxed<std::uint8_t>(block);
}

// NOLINTEND(misc-definitions-in-headers)
