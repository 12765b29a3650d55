// The implementation of the blending kernels, included after lanes.h by one source for each instruction set, which also
// defines inverse_roots_of(Lanes) and, with BENDY_LANES_OF_X86, guess_inverse_roots(Lanes).

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

/// 1 / sqrt. Without the root and the division, which blending would wait for: from a guess within 4 %, one step of
/// Newton's method and one of Halley's, to 1.5 units in the last place.
inline Lanes quick_inverse_roots_of(Lanes squares) {
#if defined(BENDY_LANES_OF_X86)
    const Lanes guess = guess_inverse_roots(squares);
    const Lanes better = guess * (1.5f - 0.5f * squares * guess * guess);
    const Lanes error = 1.0f - squares * better * better;
    return better + better * error * (0.5f + 0.375f * error);
#else
    return inverse_roots_of(squares);
#endif
}

inline void normalise_four(Lanes* q) {
    const Lanes scale = quick_inverse_roots_of(dot_of_four(q, q));
    for (std::size_t c = 0; c < 4; ++c) q[c] = q[c] * scale;
}

/// kLanes joints of a block.
BENDY_ALWAYS_INLINE void mix_joints(float* local, const float* other, Lanes weight) {
    Lanes a[4];
    Lanes b[4];
    load_numbers<4>(local, a);
    load_numbers<4>(other, b);
    const Lanes by_b = weight ^ signs_of(dot_of_four(a, b));
    const Lanes by_a = 1.0f - weight;
    for (std::size_t c = 0; c < 4; ++c) a[c] = fused(by_b, b[c], by_a * a[c]);
    normalise_four(a);
    Lanes to[6];
    Lanes from[6];
    load_numbers<6>(local + kTranslation, to);
    load_numbers<6>(other + kTranslation, from);
    for (std::size_t c = 0; c < 6; ++c) to[c] = fused(weight, from[c], by_a * to[c]);
    store_numbers<4>(a, local);
    store_numbers<6>(to, local + kTranslation);
}

/// kLanes joints of a block; `other` is a difference.
BENDY_ALWAYS_INLINE void add_joints(float* local, const float* other, Lanes weight) {
    Lanes q[4];
    Lanes d[4];
    load_numbers<4>(local, q);
    load_numbers<4>(other, d);
    const Lanes by = weight ^ signs_of(d[3]);
    for (Lanes& each : d) each = by * each;
    d[3] = d[3] + (1.0f - weight);
    normalise_four(d);
    const Lanes product[4] = {
        fused(q[3], d[0], q[0] * d[3]) + fused_difference(q[1], d[2], q[2] * d[1]),
        fused(q[3], d[1], q[1] * d[3]) + fused_difference(q[2], d[0], q[0] * d[2]),
        fused(q[3], d[2], q[2] * d[3]) + fused_difference(q[0], d[1], q[1] * d[0]),
        fused_difference(q[3], d[3], q[0] * d[0]) - fused(q[1], d[1], q[2] * d[2]),
    };
    Lanes to[6];
    Lanes from[6];
    load_numbers<6>(local + kTranslation, to);
    load_numbers<6>(other + kTranslation, from);
    const Lanes rest = 1.0f - weight;
    for (std::size_t c = 0; c < 3; ++c) to[c] = fused(weight, from[c], to[c]);
    for (std::size_t c = 3; c < 6; ++c) to[c] = to[c] * fused(weight, from[c], rest);
    store_numbers<4>(product, local);
    store_numbers<6>(to, local + kTranslation);
}

/// All bits in the first `count` lanes.
inline Lanes first_lanes(std::size_t count) {
    constexpr float kNumbers[8] = {0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f};
    return negatives(load_lanes(kNumbers) - static_cast<float>(count));
}

/// The weights of joints from `joint` on; 0 after the last one, so that the rest of its block remains at rest.
inline Lanes weights_at(const BlendBlock& block, std::size_t joint) {
    const std::size_t left = block.joints - joint;
    if (block.mask == nullptr) return block.weight & first_lanes(left);
    if (left >= kLanes) return block.weight * load_lanes(block.mask + joint);
#if BENDY_LANES == 8
    return block.weight * load_some(block.mask + joint, first_lanes(left));
#else
    float mask[kLanes]{};
    for (std::size_t k = 0; k < left; ++k) mask[k] = block.mask[joint + k];
    return block.weight * load_lanes(mask);
#endif
}

using BlendJoints = void(float* local, const float* other, Lanes weight);

template <BlendJoints blend_joints>
inline void blend_lanes(const BlendBlock& block) {
    for (std::size_t joint = 0; joint < block.joints; joint += kLanes) {
        const std::size_t at = joint / kBlockJoints * kBlockFloats + joint % kBlockJoints;
        blend_joints(block.local + at, block.other + at, weights_at(block, joint));
    }
}

// NOLINTEND(misc-definitions-in-headers)
