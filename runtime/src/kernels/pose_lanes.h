// The implementation of the joint matrix kernels, included after lanes.h by one source for each instruction set.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

/// Stores two columns of kLanes joints' matrices, given with one joint per lane; the fourth number of `d` counts.
inline void store_columns(const Three& c, const Lanes* d, float* to) {
    Lanes columns[4];
    transpose(c.x, c.y, c.z, Lanes{}, columns);
    for (std::size_t k = 0; k < 4; ++k) {
#if BENDY_LANES == 8
        store(to + 16 * k, halves<0, 0>(columns[k], d[k]));
        store(to + 16 * (k + 4), halves<1, 1>(columns[k], d[k]));
#else
        store(to + 16 * k, columns[k]);
        store(to + 16 * k + 4, d[k]);
#endif
    }
}

/// Computes the local matrices of kLanes joints: to_matrix without shear.
inline void make_local(const float* local, float* to) {
    Lanes q[4];
    transpose(load_quads(local, 40), load_quads(local + 10, 40), load_quads(local + 20, 40), load_quads(local + 30, 40),
              q);
    Lanes scale[4];  // from translation z on
    transpose(load_quads(local + 6, 40), load_quads(local + 16, 40), load_quads(local + 26, 40),
              load_quads(local + 36, 40), scale);
    const Lanes x2 = q[0] + q[0];
    const Lanes y2 = q[1] + q[1];
    const Lanes z2 = q[2] + q[2];
    const Lanes xx = q[0] * x2, yy = q[1] * y2, zz = q[2] * z2;
    const Lanes xy = q[0] * y2, xz = q[0] * z2, yz = q[1] * z2;
    const Lanes wx = q[3] * x2, wy = q[3] * y2, wz = q[3] * z2;
    Lanes second[4];
    transpose((xy - wz) * scale[2], (1.0f - (xx + zz)) * scale[2], (yz + wx) * scale[2], Lanes{}, second);
    store_columns({(1.0f - (yy + zz)) * scale[1], (xy + wz) * scale[1], (xz - wy) * scale[1]}, second, to);
    Lanes fourth[4];
    for (std::size_t k = 0; k < 4; ++k) {
        const float* const place = local + 10 * k + 4;
        fourth[k] = with_one(load_quads(place, 40));
    }
    store_columns({(xz + wy) * scale[3], (yz - wx) * scale[3], (1.0f - (xx + yy)) * scale[3]}, fourth, to + 8);
}

/// a * b, column-major; the last row of b is 0 0 0 1.
inline void multiply(const float* a, const float* b, float* to) {
    const Lanes a0 = repeat(a), a1 = repeat(a + 4), a2 = repeat(a + 8);
#if BENDY_LANES == 8
    const Lanes left = load_lanes(b);
    const Lanes right = load_lanes(b + 8);
    const Lanes moved = joined(Quad{}, load_quad(a + 12));
    store(to, a0 * everywhere<0>(left) + (a1 * everywhere<1>(left) + a2 * everywhere<2>(left)));
    store(to + 8, a0 * everywhere<0>(right) + (a1 * everywhere<1>(right) + (a2 * everywhere<2>(right) + moved)));
#else
    const Lanes a3 = repeat(a + 12);
    for (std::size_t k = 0; k < 4; ++k) {
        const Lanes column = load_lanes(b + 4 * k);
        const Lanes sum = a0 * everywhere<0>(column) + (a1 * everywhere<1>(column) + a2 * everywhere<2>(column));
        store(to + 4 * k, k < 3 ? sum : sum + a3);
    }
#endif
}

inline void make_locals(const PoseBlock& block) {
    const std::size_t joints = block.joints;
    if (joints < kLanes) {
        float local[kLanes * 10]{};
        float matrices[kLanes * 16];
        std::memcpy(local, block.local, joints * 10 * sizeof(float));
        make_local(local, matrices);
        std::memcpy(block.model, matrices, joints * 16 * sizeof(float));
        return;
    }
    for (std::size_t joint = 0; joint < joints; joint += kLanes) {
        const std::size_t first = joint < joints - kLanes ? joint : joints - kLanes;  // some twice, at the end
        make_local(block.local + 10 * first, block.model + 16 * first);
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
    return {first_and_second(both) * row, everywhere<2>(low(both)) * low(row)};
}

inline Product plus(const Product& a, const Product& b) {
    return {a.upper + b.upper, a.lower + b.lower};
}
#endif

constexpr float kLastRow[4] = {0.0f, 0.0f, 0.0f, 1.0f};

inline bool palette_lanes(const PaletteBlock& block) {
    Quad sum{};  // remains zero if all numbers are finite
#if BENDY_LANES == 8
    const Lanes last = repeat(kLastRow);
    Lanes upper_sum{};
    for (std::size_t entry = 0; entry < block.entries; ++entry) {
        const float* const joint = block.model + 16 * std::size_t{block.joints[entry]};
        const float* const bind = block.inverse_bind[entry].rows[0];
        const Product rows =
            plus(outer(joint, repeat(bind)), plus(outer(joint + 4, repeat(bind + 4)),
                                                  plus(outer(joint + 8, repeat(bind + 8)), outer(joint + 12, last))));
        store(block.palette[entry].rows[0], rows.upper);
        store(block.palette[entry].rows[2], rows.lower);
        upper_sum += 0.0f * rows.upper;
        sum += 0.0f * rows.lower;
    }
    sum += low(upper_sum) + high(upper_sum);
#else
    const Quad last = load_quad(kLastRow);
    for (std::size_t entry = 0; entry < block.entries; ++entry) {
        const float* const joint = block.model + 16 * std::size_t{block.joints[entry]};
        const float* const bind = block.inverse_bind[entry].rows[0];
        for (std::size_t row = 0; row < 3; ++row) {
            const Quad numbers =
                joint[row] * load_quad(bind) + (joint[row + 4] * load_quad(bind + 4) +
                                                (joint[row + 8] * load_quad(bind + 8) + joint[row + 12] * last));
            store(block.palette[entry].rows[row], numbers);
            sum += 0.0f * numbers;
        }
    }
#endif
    float sums[4];
    store(sums, sum);
    return sums[0] == 0.0f && sums[1] == 0.0f && sums[2] == 0.0f && sums[3] == 0.0f;
}

// NOLINTEND(misc-definitions-in-headers)
