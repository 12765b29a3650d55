// The implementation of the joint matrix kernels, included after lanes.h by one source for each instruction set.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

/// Stores one column of kLanes joints' matrices, given with one joint per lane.
inline void store_column(Lanes x, Lanes y, Lanes z, Lanes w, float* to) {
    Lanes columns[4];
    transpose(x, y, z, w, columns);
    for (std::size_t k = 0; k < 4; ++k) store_quads(columns[k], to + 16 * k, to + 16 * (k + 4));
}

/// Computes the local matrices of kLanes joints of a block: to_matrix without shear.
inline void make_local(const float* local, float* to) {
    Lanes numbers[10];
    load_numbers<10>(local, numbers);
    const auto [x, y, z, w, at_x, at_y, at_z, a, b, c] = numbers;
    const Lanes x2 = x + x;
    const Lanes y2 = y + y;
    const Lanes z2 = z + z;
    const Lanes xx = x * x2, yy = y * y2, zz = z * z2;
    const Lanes xy = x * y2, xz = x * z2, yz = y * z2;
    const Lanes wx = w * x2, wy = w * y2, wz = w * z2;
    store_column((1.0f - (yy + zz)) * a, (xy + wz) * a, (xz - wy) * a, Lanes(0.0f), to);
    store_column((xy - wz) * b, (1.0f - (xx + zz)) * b, (yz + wx) * b, Lanes(0.0f), to + 4);
    store_column((xz + wy) * c, (yz - wx) * c, (1.0f - (xx + yy)) * c, Lanes(0.0f), to + 8);
    store_column(at_x, at_y, at_z, Lanes(1.0f), to + 12);
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

/// Of whole blocks: `block.model` has room for them.
inline void make_locals(const PoseBlock& block) {
    for (std::size_t joint = 0; joint < block.joints; joint += kLanes)
        make_local(block.local + joint / kBlockJoints * kBlockFloats + joint % kBlockJoints, block.model + 16 * joint);
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

/// Returns a row of joint * bind, given the joint's columns and the rows of the bind matrix; the last one is 0 0 0 1.
template <int row>
inline Lanes product_row(const Lanes* columns, const Lanes* bind) {
    return everywhere<row>(columns[0]) * bind[0] +
           (everywhere<row>(columns[1]) * bind[1] +
            (everywhere<row>(columns[2]) * bind[2] + everywhere<row>(columns[3]) * bind[3]));
}

/// With two entries in eight lanes.
inline bool palette_lanes(const PaletteBlock& block) {
    constexpr float kLastRow[4] = {0.0f, 0.0f, 0.0f, 1.0f};
    const auto [entries, model, joints, inverse_bind, palette] = block;
    Lanes bind[4];
    bind[3] = repeat(kLastRow);
    Lanes sum = 0.0f;  // remains zero if all numbers are finite
    for (std::size_t lower = 0; lower < entries; lower += kLanes / 4) {
        const std::size_t upper = lower + 1 < entries ? lower + 1 : lower;
        const float* const joint = model + 16 * std::size_t{joints[lower]};
        const float* const other = model + 16 * std::size_t{joints[upper]};
        Lanes columns[4];
        for (std::size_t c = 0; c < 4; ++c) columns[c] = load_quads(joint + 4 * c, other + 4 * c);
        for (std::size_t r = 0; r < 3; ++r)
            bind[r] = load_quads(inverse_bind[lower].rows[r], inverse_bind[upper].rows[r]);
        const Lanes rows[3] = {product_row<0>(columns, bind), product_row<1>(columns, bind),
                               product_row<2>(columns, bind)};
        for (std::size_t r = 0; r < 3; ++r) {
            store_quads(rows[r], palette[lower].rows[r], palette[upper].rows[r]);
            sum += 0.0f * rows[r];
        }
    }
    float sums[kLanes];
    store(sums, sum);
    for (const float each : sums) {
        if (each != 0.0f) return false;  // true for NaN
    }
    return true;
}

// NOLINTEND(misc-definitions-in-headers)
