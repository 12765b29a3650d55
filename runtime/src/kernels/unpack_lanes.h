// The implementation of the packed clip kernels, included after lanes.h and sample_lanes.h by one source for each
// instruction set, which also defines roots_of(Lanes) and read_component<is_near_end>(...): see read_lanes.h.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

/// Coefficients of a polynomial.
template <int terms>
struct Terms {
    float of[terms];
};

/// Taylor series, in the square of a, of sin(a) / 2a if `first` is 1, and of cos(a) if it is 0.
template <int terms>
constexpr Terms<terms> taylor(double scale, int first) {
    Terms<terms> series{};
    double value = scale;
    for (int n = 1; n <= first; ++n) value /= n;
    for (int k = 0; k < terms; ++k) {
        series.of[k] = static_cast<float>(k % 2 == 0 ? value : -value);
        value /= static_cast<double>((2 * k + first + 1) * (2 * k + first + 2));
    }
    return series;
}
constexpr Terms<10> kSine = taylor<10>(0.5, 1);
constexpr Terms<10> kCosine = taylor<10>(1.0, 0);

/// The sum of c[k] h^k: even and odd terms are computed side by side, since each step depends on the previous one.
template <int terms>
inline Lanes polynomial(Lanes h, Lanes square, const Terms<10>& c) {
    constexpr int kOdd = (terms - 2) / 2 * 2 + 1;
    constexpr int kEven = (terms - 1) / 2 * 2;
    Lanes odd = c.of[kOdd];
    Lanes even = c.of[kEven];
    for (int k = kOdd; k > 1; k -= 2) odd = odd * square + c.of[k - 2];
    for (int k = kEven; k > 0; k -= 2) even = even * square + c.of[k - 2];
    return odd * h + even;
}

constexpr float kNearHalfTurnSquare = 2.5f;  // few rotations are farther from rest

struct Rotations {
    Lanes of[4];
};

/// Returns exp of rotation vectors v, given h = |v|^2 / 4.
inline Rotations near_exp(const Lanes* v, Lanes h) {
    const Lanes square = h * h;
    const Lanes sine = polynomial<6>(h, square, kSine);
    return {{v[0] * sine, v[1] * sine, v[2] * sine, polynomial<7>(h, square, kCosine)}};
}

/// The same for vectors of any length.
BENDY_NOINLINE Rotations far_exp(const Lanes* v, Lanes h) {
    const Lanes most = UnpackBlock::kMaxHalfTurnSquare;
    const Lanes held = lesser(h, most);
    const Lanes square = held * held;
    const Lanes sine = polynomial<10>(held, square, kSine);
    Rotations q{{v[0] * sine, v[1] * sine, v[2] * sine, polynomial<10>(held, square, kCosine)}};
    const Lanes scale = 1.0f / roots_of(dot_of_four(q.of, q.of));
    for (Lanes& number : q.of) number = number * scale;
    return q;
}

inline Lanes half_turn_square(const Lanes* v) {
    return 0.25f * (v[0] * v[0] + (v[1] * v[1] + v[2] * v[2]));
}

/// Stores numbers of the group's lanes from `first` on in the joints' blocks.
template <std::size_t count>
inline void store_unpacked(const Lanes* numbers, const UnpackGroup& group, [[maybe_unused]] std::size_t first,
                           [[maybe_unused]] const UnpackPart* parts, float* local) {
#if BENDY_LANES == 8
    for (const UnpackPart* part = parts; part != parts + group.parts; ++part) {
        Lanes moved[count];
        for (std::size_t c = 0; c < count; ++c) moved[c] = permuted(numbers[c], part->lanes);
        store_numbers<count>(moved, load_mask(part->has_track), local + part->place);
    }
#else
    float lanes[count][kLanes];
    for (std::size_t c = 0; c < count; ++c) store(lanes[c], numbers[c]);
    for (std::size_t k = 0; k < kLanes && first + k < group.count; ++k) {
        float* const to = local + group.places[first + k];
        for (std::size_t c = 0; c < count; ++c) to[kBlockJoints * c] = lanes[c][k];
    }
#endif
}

inline float least_of(Lanes lanes) {
#if BENDY_LANES == 8
    Quad least = lesser(low(lanes), high(lanes));
#else
    Quad least = lanes;
#endif
    least = lesser(least, shuffle<2, 3, 0, 1>(least, least));
    return first_of(lesser(least, shuffle<1, 0, 3, 2>(least, least)));
}

/// Interpolates between rotation vectors, relative to rest, for the group's lanes from `first` on.
inline void unpack_rotations(const UnpackGroup& group, std::size_t first, const Lanes* v, const Lanes* w,
                             const Moment<float>& moment, const UnpackPart* parts, float* local) {
    const Lanes of_v = half_turn_square(v);
    const Lanes of_w = half_turn_square(w);
    const bool is_near = -least_of(lesser(-of_v, -of_w)) <= kNearHalfTurnSquare;
    Rotations a = is_near ? near_exp(v, of_v) : far_exp(v, of_v);
    const Rotations b = is_near ? near_exp(w, of_w) : far_exp(w, of_w);
    slerp(a.of, b.of, moment);
    const Lanes* const q = a.of;
    Lanes r[4];
    load_numbers<4>(group.rest[0] + first, r);
    Lanes out[4] = {(r[3] * q[0] + r[0] * q[3]) + (r[1] * q[2] - r[2] * q[1]),
                    (r[3] * q[1] + r[1] * q[3]) + (r[2] * q[0] - r[0] * q[2]),
                    (r[3] * q[2] + r[2] * q[3]) + (r[0] * q[1] - r[1] * q[0]),
                    (r[3] * q[3] - r[0] * q[0]) - (r[1] * q[1] + r[2] * q[2])};
    const Lanes scale = 1.5f - 0.5f * dot_of_four(out, out);  // one Newton step towards 1 / length
    for (Lanes& number : out) number = number * scale;
    store_unpacked<4>(out, group, first, parts, local);
}

/// Stores rest + value in the joints' translations or scales.
inline void unpack_vectors(const UnpackGroup& group, std::size_t first, const Lanes* v, const Lanes* w, float u,
                           const UnpackPart* parts, float* local) {
    Lanes at[3];
    for (std::size_t c = 0; c < 3; ++c) at[c] = load_lanes(group.rest[c] + first) + ((w[c] - v[c]) * u + v[c]);
    store_unpacked<3>(at, group, first, parts, local);
}

template <bool is_near_end>
inline void unpack_groups(const UnpackBlock& block) {
    const Moment<float> moment(block.fraction);
    const UnpackWindows* windows = block.windows;
    const UnpackPart* parts = block.parts;
    for (std::size_t number = 0; number < block.group_count; ++number) {
        const UnpackGroup& group = block.groups[number];
        for (std::size_t first = 0; first < group.count; first += kLanes) {
            Lanes v[3];
            Lanes w[3];
            for (std::size_t c = 0; c < group.components; ++c)
                read_component<is_near_end>(group, c, first, windows[c], block, v[c], w[c]);
            if (group.components == 1) {
                v[1] = v[2] = v[0];
                w[1] = w[2] = w[0];
            }
            if (group.is_rotation) {
                unpack_rotations(group, first, v, w, moment, parts, block.local);
            } else {
                unpack_vectors(group, first, v, w, block.fraction, parts, block.local);
            }
        }
        windows += group.components;
        parts += group.parts;
    }
}

inline void unpack_lanes(const UnpackBlock& block) {
    if (block.is_near_end) return unpack_groups<true>(block);
    unpack_groups<false>(block);
}

// NOLINTEND(misc-definitions-in-headers)
