// The implementation of the blending kernels, included after lanes.h by one source for each instruction set, which also
// defines roots_of(Lanes).

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
    const Lanes scale = 1.0f / roots_of(dot_of_four(q, q));
    for (std::size_t c = 0; c < 4; ++c) q[c] = q[c] * scale;
}

/// kLanes joints.
inline void mix_joints(float* local, const float* other, Lanes weight) {
    Lanes a[4];
    Lanes b[4];
    load_joint_rotations(local, a);
    load_joint_rotations(other, b);
    const Lanes by_b = weight ^ signs_of(dot_of_four(a, b));
    const Lanes by_a = 1.0f - weight;
    for (std::size_t c = 0; c < 4; ++c) a[c] = by_a * a[c] + by_b * b[c];
    normalise_four(a);
    float weights[kLanes];
    store(weights, weight);
    for (std::size_t k = 0; k < kLanes; ++k) {
        const Lanes by = weights[k];
        for (std::size_t c = 2; c < 10; c += kLanes) {  // loads the rotation's second half too; it is stored later
            float* const to = local + 10 * k + c;
            store(to, (1.0f - by) * load_lanes(to) + by * load_lanes(other + 10 * k + c));
        }
    }
    store_joint_rotations(a, local);
}

/// kLanes joints; `other` is a difference.
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
        (q[3] * d[0] + q[0] * d[3]) + (q[1] * d[2] - q[2] * d[1]),
        (q[3] * d[1] + q[1] * d[3]) + (q[2] * d[0] - q[0] * d[2]),
        (q[3] * d[2] + q[2] * d[3]) + (q[0] * d[1] - q[1] * d[0]),
        (q[3] * d[3] - q[0] * d[0]) - (q[1] * d[1] + q[2] * d[2]),
    };
    float weights[kLanes];
    store(weights, weight);
    for (std::size_t k = 0; k < kLanes; ++k) {
        float* const to = local + 10 * k;
        const float* const from = other + 10 * k;
        for (std::size_t c = 4; c < 7; ++c) to[c] += weights[k] * from[c];
        for (std::size_t c = 7; c < 10; ++c) to[c] *= (1.0f - weights[k]) + weights[k] * from[c];
    }
    store_joint_rotations(product, local);
}

using BlendJoints = void(float* local, const float* other, Lanes weight);

/// kLanes joints from `joint` on.
template <BlendJoints blend_joints>
inline void blend_group(const BlendBlock& block, std::size_t joint, float* local) {
    const Lanes mask = block.mask == nullptr ? Lanes(1.0f) : load_lanes(block.mask + joint);
    blend_joints(local, block.other + 10 * joint, block.weight * mask);
}

/// For fewer joints than lanes.
template <BlendJoints blend_joints>
BENDY_NOINLINE void blend_few(const BlendBlock& block) {
    float local[10 * kLanes]{};
    float other[10 * kLanes]{};
    float weights[kLanes]{};
    for (std::size_t k = 0; k < block.joints; ++k)
        weights[k] = block.weight * (block.mask == nullptr ? 1.0f : block.mask[k]);
    std::memcpy(local, block.local, 10 * block.joints * sizeof(float));
    std::memcpy(other, block.other, 10 * block.joints * sizeof(float));
    blend_joints(local, other, load_lanes(weights));
    std::memcpy(block.local, local, 10 * block.joints * sizeof(float));
}

template <BlendJoints blend_joints>
inline void blend_lanes(const BlendBlock& block) {
    if (block.joints < kLanes) return blend_few<blend_joints>(block);
    // The last group overlaps the one before it: it is read before the others are written.
    const std::size_t last = block.joints - kLanes;
    float local[10 * kLanes];
    std::memcpy(local, block.local + 10 * last, sizeof local);
    blend_group<blend_joints>(block, last, local);
    for (std::size_t joint = 0; joint < last; joint += kLanes)
        blend_group<blend_joints>(block, joint, block.local + 10 * joint);
    std::memcpy(block.local + 10 * last, local, sizeof local);
}

// NOLINTEND(misc-definitions-in-headers)
