// The implementation of the joint matrix kernels, included after lanes.h and blend_lanes.h by one source for each
// instruction set.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

/// Stores two columns of kLanes joints' matrices, given with one joint per lane; the fourth number of `d` counts.
inline void store_columns(const Three& c, const Lanes* d, float* to) {
    Lanes columns[4];
    transpose(c.x, c.y, c.z, Lanes{}, columns);
    for (std::size_t k = 0; k < 4; ++k) {
#if BENDY_LANES == 8
        const Lanes lower = __builtin_shufflevector(columns[k], d[k], 0, 1, 2, 3, 8, 9, 10, 11);
        const Lanes upper = __builtin_shufflevector(columns[k], d[k], 4, 5, 6, 7, 12, 13, 14, 15);
        store_lanes(to + 16 * k, lower);
        store_lanes(to + 16 * (k + 4), upper);
#else
        store_quad(to + 16 * k, columns[k]);
        store_quad(to + 16 * k + 4, d[k]);
#endif
    }
}

/// Computes the local matrices of kLanes joints of a block: to_matrix without shear.
inline void make_local(const float* local, float* to) {
    Lanes numbers[10];
    load_numbers<10>(local, numbers);
    const Lanes* const q = numbers;
    const Lanes* const moved = numbers + 4;
    const Lanes* const scale = numbers + 7;
    const Lanes x2 = q[0] + q[0];
    const Lanes y2 = q[1] + q[1];
    const Lanes z2 = q[2] + q[2];
    const Lanes xx = q[0] * x2, yy = q[1] * y2, zz = q[2] * z2;
    const Lanes xy = q[0] * y2, xz = q[0] * z2, yz = q[1] * z2;
    const Lanes wx = q[3] * x2, wy = q[3] * y2, wz = q[3] * z2;
    Lanes second[4];
    transpose((xy - wz) * scale[1], (1.0f - (xx + zz)) * scale[1], (yz + wx) * scale[1], Lanes{}, second);
    store_columns({(1.0f - (yy + zz)) * scale[0], (xy + wz) * scale[0], (xz - wy) * scale[0]}, second, to);
    Lanes fourth[4];
    transpose(moved[0], moved[1], moved[2], splat(1.0f), fourth);
    store_columns({(xz + wy) * scale[2], (yz - wx) * scale[2], (1.0f - (xx + yy)) * scale[2]}, fourth, to + 8);
}

/// a * b, column-major; the last row of b is 0 0 0 1.
inline void multiply(const float* a, const float* b, float* to) {
    const Lanes a0 = repeat(a), a1 = repeat(a + 4), a2 = repeat(a + 8);
#if BENDY_LANES == 8
    const Lanes left = load_lanes(b);
    const Lanes right = load_lanes(b + 8);
    const Lanes moved = __builtin_shufflevector(Quad{}, load_quad(a + 12), 0, 1, 2, 3, 4, 5, 6, 7);
    store_lanes(to, a0 * everywhere<0>(left) + (a1 * everywhere<1>(left) + a2 * everywhere<2>(left)));
    store_lanes(to + 8, a0 * everywhere<0>(right) + (a1 * everywhere<1>(right) + (a2 * everywhere<2>(right) + moved)));
#else
    const Lanes a3 = repeat(a + 12);
    for (std::size_t k = 0; k < 4; ++k) {
        const Lanes column = load_lanes(b + 4 * k);
        const Lanes sum = a0 * everywhere<0>(column) + (a1 * everywhere<1>(column) + a2 * everywhere<2>(column));
        store_lanes(to + 4 * k, k < 3 ? sum : sum + a3);
    }
#endif
}

inline void make_locals(const PoseBlock& block) {
    for (std::size_t joint = 0; joint < block.joints; joint += kLanes) {
        const std::size_t at = joint / kBlockJoints * kBlockFloats + joint % kBlockJoints;
        make_local(block.local + at, block.model + 16 * joint);
    }
}

inline void pose_lanes(const PoseBlock& block) {
    make_locals(block);
    const std::uint32_t* const order = block.order;
    const std::uint32_t* const parents = block.parents;
    float* const model = block.model;
    for (std::size_t k = 0, joints = block.joints; k < joints; ++k) {
        const std::uint32_t joint = order[k];
        const std::uint32_t parent = parents[joint];
        if (parent == 0xffff'ffffu) continue;
        float* const matrix = model + 16 * std::size_t{joint};
        multiply(model + 16 * std::size_t{parent}, matrix, matrix);
    }
}

#if BENDY_LANES == 8
/// Rows 0 and 1 of joint * bind, and row 2.
struct Product {
    Lanes upper;
    Quad lower;
};

/// `column` of the joint's matrix times `row` of the bind matrix, for two rows.
inline Product outer(const float* column, Lanes row) {
    const Lanes both = repeat(column);
    const Lanes upper = __builtin_shufflevector(both, both, 0, 0, 0, 0, 5, 5, 5, 5);
    return {upper * row, low(everywhere<2>(both)) * low(row)};
}

inline Product plus(const Product& a, const Product& b) {
    return {a.upper + b.upper, a.lower + b.lower};
}
#endif

inline bool palette_lanes(const PaletteBlock& block) {
    Quad sum{};  // remains zero if all numbers are finite
#if BENDY_LANES == 8
    const Lanes last{0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f};
    Lanes upper_sum{};
    for (std::size_t entry = 0; entry < block.entries; ++entry) {
        const float* const joint = block.model + 16 * std::size_t{block.joints[entry]};
        const float* const bind = block.inverse_bind[entry].rows[0];
        const Product rows =
            plus(outer(joint, repeat(bind)), plus(outer(joint + 4, repeat(bind + 4)),
                                                  plus(outer(joint + 8, repeat(bind + 8)), outer(joint + 12, last))));
        store_lanes(block.palette[entry].rows[0], rows.upper);
        store_quad(block.palette[entry].rows[2], rows.lower);
        upper_sum += 0.0f * rows.upper;
        sum += 0.0f * rows.lower;
    }
    sum += low(upper_sum) + high(upper_sum);
#else
    const Quad last{0.0f, 0.0f, 0.0f, 1.0f};
    for (std::size_t entry = 0; entry < block.entries; ++entry) {
        const float* const joint = block.model + 16 * std::size_t{block.joints[entry]};
        const float* const bind = block.inverse_bind[entry].rows[0];
        for (std::size_t row = 0; row < 3; ++row) {
            const Quad numbers =
                joint[row] * load_quad(bind) + (joint[row + 4] * load_quad(bind + 4) +
                                                (joint[row + 8] * load_quad(bind + 8) + joint[row + 12] * last));
            store_quad(block.palette[entry].rows[row], numbers);
            sum += 0.0f * numbers;
        }
    }
#endif
    return sum[0] == 0.0f && sum[1] == 0.0f && sum[2] == 0.0f && sum[3] == 0.0f;
}

// NOLINTEND(misc-definitions-in-headers)
