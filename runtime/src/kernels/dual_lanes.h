// The implementation of the dual quaternion kernels, included after skin_lanes.h: each vertex's matrix comes from the
// blended motion; everything else is as there.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

/// Stores in a row: sum(weight * motion), real part before dual part, each with the sign that matches the heaviest one;
/// then the sum of the weights.
struct DualSum {
    const DualMotion* motions;

    template <class Bone>
    BENDY_ALWAYS_INLINE void operator()(const Bone* bones, const float* weights, std::size_t used, float* to) const {
        std::size_t heaviest = 0;
        for (std::size_t k = 1; k < used; ++k) heaviest = weights[k] > weights[heaviest] ? k : heaviest;
        const Quad pivot = load_quad(motions[bones[heaviest]].real);
        Quad real{}, dual{}, all{};
        for (std::size_t k = 0; k < used; ++k) {
            const DualMotion& add = motions[bones[k]];
            const Quad turn = load_quad(add.real);
            const Quad weight = weights[k];
            const Quad signed_weight = on_side_of(turn * pivot, weight);
            real += signed_weight * turn;
            dual += signed_weight * load_quad(add.dual);
            all += weight;
        }
        store(to, real);
        store(to + 4, dual);
        store(to + 8, all);
    }

    /// Returns the weight, negated where the sum of the products is negative.
    static inline Quad on_side_of(Quad products, Quad weight) {
        products += shuffle<2, 3, 0, 1>(products, products);
        products += shuffle<1, 0, 3, 2>(products, products);
        return weight ^ signs_of(products);
    }
};

/// v -> scale * (blended motion of v).
inline Matrix rigid_matrix(const float (*duals)[16], float scale) {
    Lanes q[4], d[4];
    turn_four(duals[0], q);
    turn_four(duals[0] + 4, d);
    // Divided by the squared length, so the real part need not be normalised; zero becomes a zero matrix.
    const Lanes share = scale / between(dot_of_four(q, q), Lanes(1e-30f), Lanes(1e30f));
    const Lanes twice = share + share;
    const Lanes xx = q[0] * q[0], yy = q[1] * q[1], zz = q[2] * q[2], ww = q[3] * q[3];
    const Lanes xy = q[0] * q[1], xz = q[0] * q[2], yz = q[1] * q[2];
    const Lanes xw = q[0] * q[3], yw = q[1] * q[3], zw = q[2] * q[3];
    const Three across = cross(d, q);
    Matrix m;
    m.at[0][0] = share * ((ww + xx) - (yy + zz));
    m.at[0][1] = twice * (xy - zw);
    m.at[0][2] = twice * (xz + yw);
    m.at[1][0] = twice * (xy + zw);
    m.at[1][1] = share * ((ww + yy) - (xx + zz));
    m.at[1][2] = twice * (yz - xw);
    m.at[2][0] = twice * (xz - yw);
    m.at[2][1] = twice * (yz + xw);
    m.at[2][2] = share * ((ww + zz) - (xx + yy));
    // The vector part of 2 * dual * conjugate(real).
    m.at[0][3] = twice * (q[3] * d[0] - d[3] * q[0] - across.x);
    m.at[1][3] = twice * (q[3] * d[1] - d[3] * q[1] - across.y);
    m.at[2][3] = twice * (q[3] * d[2] - d[3] * q[2] - across.z);
    return m;
}

/// First the blended stretches, divided by the sum of their weights, then the motion.
inline Matrix after_stretch(const Matrix& motion, const float (*stretches)[16], const float (*duals)[16]) {
    const Matrix sum = turn(stretches);
    Lanes all[4];
    turn_four(duals[0] + 8, all);
    const Lanes share = 1.0f / between(all[0], Lanes(1e-30f), Lanes(1e30f));
    Matrix m;
    for (std::size_t row = 0; row < 3; ++row) {
        const Lanes a = share * motion.at[row][0], b = share * motion.at[row][1], c = share * motion.at[row][2];
        for (std::size_t column = 0; column < 4; ++column)
            m.at[row][column] = a * sum.at[0][column] + (b * sum.at[1][column] + c * sum.at[2][column]);
        m.at[row][3] += motion.at[row][3];
    }
    return m;
}

template <class F, class Bone>
void dual_blended(const DualBlock& duals, const Bone* bones) {
    const SkinBlock& block = duals.vertices;
    const bool is_stretched = block.palette != nullptr;
    Rows motions, stretches;
    transform_chunks<F>(
        block,
        [&](std::size_t vertex, std::size_t count) {
            blend_chunk(DualSum{duals.motions}, block, bones, vertex, count, motions);
            if (is_stretched) blend_chunk(MatrixSum{block.palette}, block, bones, vertex, count, stretches);
        },
        [&](std::size_t k) {
            const Matrix motion = rigid_matrix(motions.of + k, duals.scale);
            return is_stretched ? after_stretch(motion, stretches.of + k, motions.of + k) : motion;
        });
}

template <class F>
void dual_as(const DualBlock& duals) {
    if (duals.vertices.bones8 != nullptr) {
        dual_blended<F>(duals, duals.vertices.bones8);
    } else {
        dual_blended<F>(duals, duals.vertices.bones16);
    }
}

void dual_lanes(const DualBlock& duals) {
    const SkinBlock& block = duals.vertices;
    const bool is_packed_too = is_packed(block.out_positions, 3) && is_packed(block.out_normals, 3);
    if (is_packed_too && block.out_positions.data != nullptr && block.out_tangents.data == nullptr) {
        if (block.out_normals.data != nullptr) return dual_as<Form<3, true, false>>(duals);
        return dual_as<Form<1, true, false>>(duals);
    }
    dual_as<AnyForm>(duals);
}
// NOLINTEND(misc-definitions-in-headers)
