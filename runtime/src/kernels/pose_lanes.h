// The implementation of the joint matrix kernels, included after lanes.h by one source for each instruction set. All
// sums of products fuse explicitly: those of poses_lanes.h must round in the same way.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

/// Stores one column of kLanes joints' matrices, given with one joint per lane.
inline void store_column(Lanes x, Lanes y, Lanes z, Lanes w, float* to) {
    Lanes columns[4];
    transpose(x, y, z, w, columns);
    for (std::size_t k = 0; k < 4; ++k) store_quads(columns[k], to + 16 * k, to + 16 * (k + 4));
}

/// Computes the columns of scaled rotations, as to_matrix without shear.
/// \param q      x y z w
/// \param scale  three numbers
inline void make_columns(const Lanes* q, const Lanes* scale, Three* columns) {
    const Lanes x = q[0], y = q[1], z = q[2], w = q[3];
    const Lanes x2 = x + x;
    const Lanes y2 = y + y;
    const Lanes z2 = z + z;
    const Lanes yy = y * y2, zz = z * z2;
    const Lanes wx = w * x2, wy = w * y2, wz = w * z2;
    columns[0] = {(1.0f - fused(y, y2, zz)) * scale[0], fused(x, y2, wz) * scale[0],
                  fused_difference(x, z2, wy) * scale[0]};
    columns[1] = {fused_difference(x, y2, wz) * scale[1], (1.0f - fused(x, x2, zz)) * scale[1],
                  fused(y, z2, wx) * scale[1]};
    columns[2] = {fused(x, z2, wy) * scale[2], fused_difference(y, z2, wx) * scale[2],
                  (1.0f - fused(x, x2, yy)) * scale[2]};
}

/// Computes the local matrices of kLanes joints of a block.
inline void make_local(const float* local, float* to) {
    Lanes numbers[10];
    load_numbers<10>(local, numbers);
    Three columns[3];
    make_columns(numbers, numbers + 7, columns);
    const Lanes none = 0.0f;
    store_column(columns[0].x, columns[0].y, columns[0].z, none, to);
    store_column(columns[1].x, columns[1].y, columns[1].z, none, to + 4);
    store_column(columns[2].x, columns[2].y, columns[2].z, none, to + 8);
    store_column(numbers[4], numbers[5], numbers[6], Lanes(1.0f), to + 12);
}

/// a * b, column-major; the last row of b is 0 0 0 1.
inline void multiply(const float* a, const float* b, float* to) {
    const Lanes a0 = repeat(a), a1 = repeat(a + 4), a2 = repeat(a + 8);
#if BENDY_LANES == 8
    const Lanes left = load_lanes(b);
    const Lanes right = load_lanes(b + 8);
    const Lanes moved =
        joined(Quad(-0.0f), load_quad(a + 12));  // adding -0 leaves every product unchanged, including zeros
    store(to, fused(a0, everywhere<0>(left), fused(a1, everywhere<1>(left), a2 * everywhere<2>(left))));
    store(to + 8,
          fused(a0, everywhere<0>(right), fused(a1, everywhere<1>(right), fused(a2, everywhere<2>(right), moved))));
#else
    const Lanes a3 = repeat(a + 12);
    for (std::size_t k = 0; k < 4; ++k) {
        const Lanes column = load_lanes(b + 4 * k);
        const Lanes z = a2 * everywhere<2>(column);
        store(to + 4 * k, fused(a0, everywhere<0>(column), fused(a1, everywhere<1>(column), k < 3 ? z : z + a3)));
    }
#endif
}

/// Computes whole blocks: `block.model` has room for them.
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

inline void pose_subtree_lanes(const PoseBlock& block, std::uint32_t first, std::uint32_t end) {
    for (std::size_t joint = first / kLanes * kLanes; joint < end; joint += kLanes) {
        float locals[16 * kLanes];
        make_local(block.local + joint / kBlockJoints * kBlockFloats + joint % kBlockJoints, locals);
        for (std::size_t k = joint < first ? first - joint : 0; k < kLanes && joint + k < end; ++k) {
            const std::uint32_t parent = block.parents[joint + k];
            float* const to = block.model + 16 * (joint + k);
            if (parent != 0xffff'ffffu) {
                multiply(block.model + 16 * std::size_t{parent}, locals + 16 * k, to);
            } else {
                std::memcpy(to, locals + 16 * k, 16 * sizeof(float));
            }
        }
    }
}

/// Returns a row of joint * bind, given the joint's columns and the rows of the bind matrix; the last one is 0 0 0 1.
template <int row>
inline Lanes product_row(const Lanes* columns, const Lanes* bind) {
    const Lanes sum = fused(everywhere<row>(columns[2]), bind[2], everywhere<row>(columns[3]) * bind[3]);
    return fused(everywhere<row>(columns[0]), bind[0], fused(everywhere<row>(columns[1]), bind[1], sum));
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
