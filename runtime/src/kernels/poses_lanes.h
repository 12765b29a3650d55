// The joint matrix kernels for several poses at once, one per lane: only input and output are shuffled. Included after
// pose_lanes.h by one source for each instruction set.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

constexpr std::size_t kPoses = PosesBlock::kPoses;

/// Loads one number of four neighbouring joints of kLanes poses; to[c] receives that of joint c.
inline void load_joints(const float* const* local, std::size_t place, Lanes* to) {
    Lanes quads[4];
    for (std::size_t k = 0; k < 4; ++k) quads[k] = load_quads(local[k] + place, local[(k + 4) % kLanes] + place);
    transpose(quads[0], quads[1], quads[2], quads[3], to);
}

/// Stores the row of a joint's matrix in model space, given its parent's: `parent * columns, place`, as `multiply`.
inline void store_product(const float* parent, const Three* columns, const Three& place, float* to) {
    const Lanes a = load_lanes(parent);
    const Lanes b = load_lanes(parent + kPoses);
    const Lanes c = load_lanes(parent + 2 * kPoses);
    const Lanes moved = load_lanes(parent + 3 * kPoses);
    store(to, fused(a, columns[0].x, fused(b, columns[0].y, c * columns[0].z)));
    store(to + kPoses, fused(a, columns[1].x, fused(b, columns[1].y, c * columns[1].z)));
    store(to + 2 * kPoses, fused(a, columns[2].x, fused(b, columns[2].y, c * columns[2].z)));
#if BENDY_LANES == 8
    store(to + 3 * kPoses, fused(a, place.x, fused(b, place.y, fused(c, place.z, moved))));
#else
    store(to + 3 * kPoses, fused(a, place.x, fused(b, place.y, c * place.z + moved)));
#endif
}

/// Computes a joint's matrices, given its ten numbers.
inline void pose_joint(const PosesBlock& block, std::size_t joint, std::size_t first, const Lanes* numbers) {
    Three columns[3];
    make_columns(numbers, numbers + 7, columns);
    const Three place{numbers[4], numbers[5], numbers[6]};
    float* const to = block.model + kMatrixLanes * joint + first;
    const std::uint32_t parent = block.parents[joint];
    if (parent == 0xffff'ffffu) {
        const Lanes rows[12] = {columns[0].x, columns[1].x, columns[2].x, place.x,      columns[0].y, columns[1].y,
                                columns[2].y, place.y,      columns[0].z, columns[1].z, columns[2].z, place.z};
        for (std::size_t k = 0; k < 12; ++k) store(to + kPoses * k, rows[k]);
        return;
    }
    const float* const from = block.model + kMatrixLanes * parent + first;
    for (std::size_t row = 0; row < 3; ++row)
        store_product(from + 4 * kPoses * row, columns, place, to + 4 * kPoses * row);
}

inline void poses_lanes(const PosesBlock& block) {
    for (std::size_t first = 0; first < kPoses; first += kLanes) {
        for (std::size_t joint = 0; joint < block.joints; joint += 4) {
            const std::size_t place = joint / kBlockJoints * kBlockFloats + joint % kBlockJoints;
            Lanes numbers[4][10];
            for (std::size_t c = 0; c < 10; ++c) {
                Lanes joints[4];
                load_joints(block.local + first, place + kBlockJoints * c, joints);
                for (std::size_t k = 0; k < 4; ++k) numbers[k][c] = joints[k];
            }
            for (std::size_t k = 0; k < 4 && joint + k < block.joints; ++k)
                pose_joint(block, joint + k, first, numbers[k]);
        }
    }
}

/// Stores one row of an entry of kLanes palettes.
inline void store_row(const Lanes* row, PaletteMatrix* const* palette, std::size_t entry, std::size_t number) {
    Lanes poses[4];
    transpose(row[0], row[1], row[2], row[3], poses);
    for (std::size_t k = 0; k < 4; ++k)
        store_quads(poses[k], palette[k][entry].rows[number], palette[(k + 4) % kLanes][entry].rows[number]);
}

/// One row of joint * bind, as product_row.
inline void multiply_row(const Lanes* joint, const PaletteMatrix& bind, Lanes* to) {
    const Lanes zero = joint[3] * Lanes(0.0f);
    for (std::size_t c = 0; c < 4; ++c) {
        const Lanes sum = fused(joint[2], bind.rows[2][c], c < 3 ? zero : joint[3]);
        to[c] = fused(joint[0], bind.rows[0][c], fused(joint[1], bind.rows[1][c], sum));
    }
}

inline void palettes_lanes(const PalettesBlock& block) {
    for (std::size_t first = 0; first < kPoses; first += kLanes) {
        for (std::size_t entry = 0; entry < block.entries; ++entry) {
            const float* const joint = block.model + kMatrixLanes * block.joints[entry] + first;
            for (std::size_t number = 0; number < 3; ++number) {
                Lanes row[4];
                for (std::size_t c = 0; c < 4; ++c) row[c] = load_lanes(joint + kPoses * (4 * number + c));
                if (block.inverse_bind != nullptr) {
                    Lanes product[4];
                    multiply_row(row, block.inverse_bind[entry], product);
                    store_row(product, block.palette + first, entry, number);
                } else {
                    store_row(row, block.palette + first, entry, number);
                }
            }
        }
    }
}

// NOLINTEND(misc-definitions-in-headers)
