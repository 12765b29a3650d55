// The implementation of the blending kernels, included after lanes.h by one source for each instruction set, which also
// defines inverse_roots_of(Lanes).

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

/// Rotations of kLanes joints, one joint per lane.
inline void load_joint_rotations(const float* local, Lanes* to) {
    transpose(load_quads(local, 40), load_quads(local + 10, 40), load_quads(local + 20, 40), load_quads(local + 30, 40),
              to);
}

inline void store_joint_rotations(const Lanes* numbers, float* local) {
    Lanes rotations[4];
    transpose(numbers[0], numbers[1], numbers[2], numbers[3], rotations);
    for (std::size_t k = 0; k < 4; ++k) {
        store(local + 10 * k, low(rotations[k]));
#if BENDY_LANES == 8
        store(local + 10 * (k + 4), high(rotations[k]));
#endif
    }
}

inline void normalise_four(Lanes* q) {
    const Lanes scale = inverse_roots_of(dot_of_four(q, q));
    for (std::size_t c = 0; c < 4; ++c) q[c] = q[c] * scale;
}

/// The rotations of kLanes joints, blended.
inline void mix_rotations(const float* local, const float* other, Lanes weight, Lanes* mixed) {
    Lanes b[4];
    load_joint_rotations(local, mixed);
    load_joint_rotations(other, b);
    const Lanes by_b = weight ^ signs_of(dot_of_four(mixed, b));
    const Lanes by_a = 1.0f - weight;
    for (std::size_t c = 0; c < 4; ++c) mixed[c] = fused(by_b, b[c], by_a * mixed[c]);
    normalise_four(mixed);
}

/// Of kLanes joints, with a weight for all of them, or (has_mask) one for each.
template <bool has_mask>
inline void mix_joints(float* local, const float* other, Lanes weight) {
    Lanes rotations[4];
    mix_rotations(local, other, weight, rotations);
    if constexpr (has_mask) {
        float weights[kLanes];
        store(weights, weight);
        for (std::size_t k = 0; k < kLanes; ++k) {
            const Lanes by = weights[k];
            for (std::size_t c = 2; c < 10; c += kLanes) {  // loads the rotation's second half too; it is stored later
                float* const to = local + 10 * k + c;
                store(to, fused(by, load_lanes(other + 10 * k + c), (1.0f - by) * load_lanes(to)));
            }
        }
    } else {
        const Lanes rest = 1.0f - weight;
        for (std::size_t at = 0; at < 10 * kLanes; at += kLanes)  // rotations too; they are stored later
            store(local + at, fused(weight, load_lanes(other + at), rest * load_lanes(local + at)));
    }
    store_joint_rotations(rotations, local);
}

/// kLanes joints; `other` is a difference.
template <bool has_mask>
inline void add_joints(float* local, const float* other, Lanes weight) {
    Lanes q[4];
    Lanes d[4];
    load_joint_rotations(local, q);
    load_joint_rotations(other, d);
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
    float weights[kLanes];
    if constexpr (has_mask) store(weights, weight);
    for (std::size_t k = 0; k < kLanes; ++k) {
        const Quad by_one = has_mask ? Quad(weights[k]) : low(weight);
        float* const to = local + 10 * k;
        const float* const from = other + 10 * k;
        // x y z of the translation and x of the scale, then the last four numbers: x is made twice, from what it was.
        const Quad moved = fused(by_one, load_quad(from + 4), load_quad(to + 4));
        const Quad grown = load_quad(to + 6) * fused(by_one, load_quad(from + 6), Quad(1.0f) - by_one);
        store(to + 6, grown);
        store_three_of(to + 4, moved);
    }
    store_joint_rotations(product, local);
}

using BlendJoints = void(float* local, const float* other, Lanes weight);

/// Whole groups of kLanes joints, also where fewer are left at the end: poses have room for them, see PoseState::local.
template <BlendJoints blend_all, BlendJoints blend_masked>
inline void blend_lanes(const BlendBlock& block) {
    if (block.mask == nullptr) {
        for (std::size_t joint = 0; joint < block.joints; joint += kLanes)
            blend_all(block.local + 10 * joint, block.other + 10 * joint, block.weight);
        return;
    }
    std::size_t joint = 0;
    for (; joint + kLanes <= block.joints; joint += kLanes)
        blend_masked(block.local + 10 * joint, block.other + 10 * joint, block.weight * load_lanes(block.mask + joint));
    if (joint == block.joints) return;
    float mask[kLanes]{};
    for (std::size_t k = 0; joint + k < block.joints; ++k) mask[k] = block.mask[joint + k];
    blend_masked(block.local + 10 * joint, block.other + 10 * joint, block.weight * load_lanes(mask));
}

// NOLINTEND(misc-definitions-in-headers)
