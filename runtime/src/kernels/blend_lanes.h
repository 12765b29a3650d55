// The implementation of the blending kernels, included after lanes.h by one source for each instruction set, which also
// defines roots_of(Lanes).

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

inline void normalise_four(Lanes* q) {
    const Lanes scale = 1.0f / roots_of(dot_of_four(q, q));
    for (std::size_t c = 0; c < 4; ++c) q[c] = q[c] * scale;
}

/// The numbers of kLanes joints of a block, in registers; number c is kBlockJoints floats after number c - 1.
template <std::size_t count>
inline void load_numbers(const float* from, Lanes* to) {
    for (std::size_t c = 0; c < count; ++c) to[c] = load_lanes(from + kBlockJoints * c);
}

template <std::size_t count>
inline void store_numbers(const Lanes* from, float* to) {
    for (std::size_t c = 0; c < count; ++c) store_lanes(to + kBlockJoints * c, from[c]);
}

constexpr std::size_t kTranslation = std::size_t{4} * kBlockJoints;  // floats from a block's start
constexpr std::size_t kScale = std::size_t{7} * kBlockJoints;

/// kLanes joints of a block.
inline void mix_joints(float* local, const float* other, Lanes weight) {
    Lanes a[4];
    Lanes b[4];
    load_numbers<4>(local, a);
    load_numbers<4>(other, b);
    const Lanes by_b = dot_of_four(a, b) < 0.0f ? -weight : weight;
    const Lanes by_a = 1.0f - weight;
    for (std::size_t c = 0; c < 4; ++c) a[c] = by_a * a[c] + by_b * b[c];
    normalise_four(a);
    Lanes to[6];
    Lanes from[6];
    load_numbers<6>(local + kTranslation, to);
    load_numbers<6>(other + kTranslation, from);
    for (std::size_t c = 0; c < 6; ++c) to[c] = by_a * to[c] + weight * from[c];
    store_numbers<4>(a, local);
    store_numbers<6>(to, local + kTranslation);
}

/// kLanes joints of a block; `other` is a difference.
inline void add_joints(float* local, const float* other, Lanes weight) {
    Lanes q[4];
    Lanes d[4];
    load_numbers<4>(local, q);
    load_numbers<4>(other, d);
    const Lanes by = d[3] < 0.0f ? -weight : weight;
    for (Lanes& each : d) each = by * each;
    d[3] = d[3] + (1.0f - weight);
    normalise_four(d);
    const Lanes product[4] = {
        (q[3] * d[0] + q[0] * d[3]) + (q[1] * d[2] - q[2] * d[1]),
        (q[3] * d[1] + q[1] * d[3]) + (q[2] * d[0] - q[0] * d[2]),
        (q[3] * d[2] + q[2] * d[3]) + (q[0] * d[1] - q[1] * d[0]),
        (q[3] * d[3] - q[0] * d[0]) - (q[1] * d[1] + q[2] * d[2]),
    };
    Lanes translation[3];
    Lanes moved[3];
    load_numbers<3>(local + kTranslation, translation);
    load_numbers<3>(other + kTranslation, moved);
    for (std::size_t c = 0; c < 3; ++c) translation[c] = translation[c] + weight * moved[c];
    Lanes scale[3];
    Lanes scaled[3];
    load_numbers<3>(local + kScale, scale);
    load_numbers<3>(other + kScale, scaled);
    const Lanes rest = 1.0f - weight;
    for (std::size_t c = 0; c < 3; ++c) scale[c] = scale[c] * (rest + weight * scaled[c]);
    store_numbers<4>(product, local);
    store_numbers<3>(translation, local + kTranslation);
    store_numbers<3>(scale, local + kScale);
}

/// The weights of kLanes joints; 0 after the last one, so that a block stays padded with the identity.
inline Lanes weights_at(const BlendBlock& block, std::size_t joint) {
    if (joint + kLanes <= block.joints)
        return block.mask == nullptr ? splat(block.weight) : block.weight * load_lanes(block.mask + joint);
    Lanes weights{};
    for (std::size_t k = 0; joint + k < block.joints; ++k)
        weights[k] = block.mask == nullptr ? block.weight : block.weight * block.mask[joint + k];
    return weights;
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
