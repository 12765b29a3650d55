// The implementation of the skinning kernels, included after lanes.h by one source for each instruction set, which is
// compiled with that set's options.
//
// Vertices are processed in chunks, in two steps: first the blended matrix of each group of kLanes vertices and the
// transformed attributes, one vertex per lane; then normalisation, and the conversion to the caller's layout. Each step
// is a long dependency chain per group; in small loops the processor overlaps several groups.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

struct Matrix {
    Lanes at[3][4];
};

constexpr std::size_t kChunk = 64;  // vertices, a multiple of kLanes

/// The attributes of a group between the two steps; directions are not normalised yet.
struct Moved {
    Three positions, normals, tangents;
    Lanes sides;
};

inline Three turned(const Three& v, Lanes signs) {
    return {v.x ^ signs, v.y ^ signs, v.z ^ signs};
}

/// Compile-time properties of a block: which attributes are wanted (1 positions, 2 normals, 4 tangents; 0 if this is
/// only known at run time), that outputs are packed, that they are written past the caches, and that normals are
/// unfolded from normals8.
template <int kWanted, bool kPacked, bool kStreams, bool kUnfolds = false>
struct Form {
    static constexpr int wanted = kWanted;
    static constexpr bool packed = kPacked;
    static constexpr bool streams = kStreams;
    static constexpr bool unfolds = kUnfolds;
    using Unfolding = Form<kWanted, kPacked, kStreams, true>;
};
using AnyForm = Form<0, false, false>;

template <class F>
inline void store_three(const Three& v, const SkinOutput& out, std::size_t vertex) {
    if constexpr (F::packed) {
        store_packed<F::streams>(v, out.data + 3 * vertex);
    } else if (out.stride == 3) {
        store_packed<false>(v, out.data + 3 * vertex);
    } else {
        store_apart<3, false>(v.x, v.y, v.z, v.z, out.data + out.stride * vertex, out.stride);
    }
}

template <class F, int kPart>
inline bool wants(const SkinOutput& out) {
    return F::wanted != 0 ? (F::wanted & kPart) != 0 : out.data != nullptr;
}

/// Normalises. Vectors whose squared length underflows stay unnormalised: zero stays zero.
inline Three normalised(const Three& v) {
    constexpr float kLeast = 1.17549435e-38f;
    constexpr float kMost = 3.40282347e+38f;
    const Lanes squares = fused(v.x, v.x, fused(v.y, v.y, v.z * v.z));
    const Lanes scale = inverse_roots_of(between(squares, Lanes(kLeast), Lanes(kMost)));
    return {v.x * scale, v.y * scale, v.z * scale};
}

inline Three cross(const Lanes* a, const Lanes* b) {
    return {fused_difference(a[1], b[2], a[2] * b[1]), fused_difference(a[2], b[0], a[0] * b[2]),
            fused_difference(a[0], b[1], a[1] * b[0])};
}
inline Lanes dot(const Lanes* a, const Three& b) {
    return fused(a[0], b.x, fused(a[1], b.y, a[2] * b.z));
}

/// The first step for a group of kLanes vertices; matrix_of(vertex) is its matrix.
template <class F, class Blend>
BENDY_ALWAYS_INLINE void move(const Blend& matrix_of, const SkinBlock& block, std::size_t vertex, Moved& moved) {
    Three normals;
    if constexpr (F::unfolds) normals = load_directions(block.normals8 + 2 * vertex);  // while registers are free
    const Matrix& matrix = matrix_of(vertex);
    const auto& m = matrix.at;
    if (wants<F, 1>(block.out_positions)) {
        const Three v = load_three(block.positions + 3 * vertex);
        moved.positions = {fused(m[0][0], v.x, fused(m[0][1], v.y, fused(m[0][2], v.z, m[0][3]))),
                           fused(m[1][0], v.x, fused(m[1][1], v.y, fused(m[1][2], v.z, m[1][3]))),
                           fused(m[2][0], v.x, fused(m[2][1], v.y, fused(m[2][2], v.z, m[2][3])))};
    }
    if (!wants<F, 2>(block.out_normals) && !wants<F, 4>(block.out_tangents)) return;
    const Three area = cross(m[1], m[2]);
    const Lanes signs = signs_of(dot(m[0], area));
    if (wants<F, 2>(block.out_normals)) {
        // Transforms by the inverse transpose except for its length: by the cofactor matrix, which also exists for a
        // singular matrix. Its rows are cross products of the matrix's rows; two of the three triple products contain
        // the cross product of row 0 and the vector.
        const Three v = F::unfolds ? normals : load_three(block.normals + 3 * vertex);
        const Lanes normal[3] = {v.x, v.y, v.z};
        const Three across = cross(m[0], normal);
        moved.normals = turned({dot(normal, area), dot(m[2], across), -dot(m[1], across)}, signs);
    }
    if (wants<F, 4>(block.out_tangents)) {
        Lanes v[4];
        load_four(block.tangents + 4 * vertex, v);
        const Three tangent{v[0], v[1], v[2]};
        moved.tangents = {dot(m[0], tangent), dot(m[1], tangent), dot(m[2], tangent)};
        moved.sides = v[3] ^ signs;
    }
}

/// The second step for those of the attributes `parts` (1, 2, 4) that are wanted.
template <class F, int parts>
BENDY_ALWAYS_INLINE void finish(const Moved* moved, const SkinBlock& block, std::size_t vertex, std::size_t count) {
    for (const std::size_t end = vertex + count; vertex < end; vertex += kLanes, ++moved) {
        if ((parts & 1) != 0 && wants<F, 1>(block.out_positions))
            store_three<F>(moved->positions, block.out_positions, vertex);
        if ((parts & 2) != 0 && wants<F, 2>(block.out_normals))
            store_three<F>(normalised(moved->normals), block.out_normals, vertex);
        if ((parts & 4) != 0 && wants<F, 4>(block.out_tangents)) {
            const Three t = normalised(moved->tangents);
            const std::size_t stride = F::packed ? 4 : block.out_tangents.stride;
            store_apart<4, F::streams>(t.x, t.y, t.z, moved->sides, block.out_tangents.data + stride * vertex, stride);
        }
    }
}

#if defined(BENDY_LANES_OF_X86)  // others write through the caches

/// Prefetches the input of a group in the chunk after the next one. The processor does that by itself, but not across
/// pages.
template <class F>
inline void fetch_ahead(const SkinBlock& block, std::size_t vertex) {
    const auto fetch = [&](const float* from, std::size_t numbers) {
        prefetch(from + numbers * (vertex + 2 * kChunk));
        prefetch(from + numbers * (vertex + 2 * kChunk) + 16);
    };
    fetch(block.positions, 3);
    if (wants<F, 2>(block.out_normals) && !F::unfolds) fetch(block.normals, 3);
    if (wants<F, 4>(block.out_tangents)) fetch(block.tangents, 4);
}

#endif

/// Processes whole groups, `count` vertices from `vertex` on; matrix_of(vertex) is the matrix of a group.
template <class F, class Blend>
BENDY_ALWAYS_INLINE void transform(const SkinBlock& block, std::size_t vertex, std::size_t count,
                                   const Blend& matrix_of) {
    Moved moved[kChunk / kLanes];
    if constexpr (F::wanted == 0) std::memset(&moved, 0, sizeof moved);
    for (std::size_t k = 0; k < count; k += kLanes) {
#if defined(BENDY_LANES_OF_X86)
        if constexpr (F::streams) fetch_ahead<F>(block, vertex + k);
#endif
        move<F>(matrix_of, block, vertex + k, moved[k / kLanes]);
    }
    if constexpr (F::streams) {  // one attribute at a time, so that whole cache lines are written
        finish<F, 1>(moved, block, vertex, count);
        finish<F, 2>(moved, block, vertex, count);
        finish<F, 4>(moved, block, vertex, count);
    } else {
        finish<F, 7>(moved, block, vertex, count);
    }
}

/// Processes fewer than kLanes vertices: through copies that have the size of a group.
BENDY_NOINLINE void transform_last(const Matrix& matrix, const SkinBlock& block, std::size_t vertex) {
    const std::size_t count = block.vertices - vertex;
    float positions[3 * kLanes]{};
    float normals[3 * kLanes]{};
    float tangents[4 * kLanes]{};
    SkinBlock copy = block;
    const auto bring = [&](float* to, const float*& from, SkinOutput& out, std::size_t numbers) {
        if (out.data == nullptr) return;
        std::memcpy(to, from + numbers * vertex, numbers * count * sizeof(float));
        from = to;
        out = {to, numbers};
    };
    bring(positions, copy.positions, copy.out_positions, 3);
    if (kLanes == 8 && block.normals8 != nullptr) {
        decode_directions_lanes({{block.normals8 + 2 * vertex, 1, true}, count, 2, normals});
        copy.normals = normals;
        copy.out_normals = {normals, 3};
    } else {
        bring(normals, copy.normals, copy.out_normals, 3);
    }
    bring(tangents, copy.tangents, copy.out_tangents, 4);
    transform<AnyForm>(copy, 0, kLanes, [&](std::size_t) -> const Matrix& { return matrix; });
    const auto take = [&](const float* from, const SkinOutput& out, std::size_t numbers) {
        if (out.data == nullptr) return;
        for (std::size_t k = 0; k < count; ++k)
            std::memcpy(out.data + (vertex + k) * out.stride, from + k * numbers, numbers * sizeof(float));
    };
    take(positions, block.out_positions, 3);
    take(normals, block.out_normals, 3);
    take(tangents, block.out_tangents, 4);
}

/// Processes all vertices of a block.
template <class F, class Blend>
BENDY_ALWAYS_INLINE void transform_all(const SkinBlock& block, const Blend& matrix_of) {
    std::size_t vertex = 0;
    while (block.vertices - vertex >= kLanes) {
        const std::size_t left = block.vertices - vertex;
        const std::size_t count = left < kChunk ? left - left % kLanes : kChunk;
        transform<F>(block, vertex, count, matrix_of);
        vertex += count;
    }
    if (vertex < block.vertices) transform_last(matrix_of(vertex), block, vertex);
}

/// The blended rows of each vertex, on a cache line of its own; matrices as rows.
struct Rows {
    alignas(64) float of[kChunk][16];
};

/// Stores in a row: sum(weight * matrix) over `used` influences.
struct MatrixSum {
    const PaletteMatrix* palette;

    template <class Bone>
    BENDY_ALWAYS_INLINE void operator()(const Bone* bones, const float* weights, std::size_t used, float* to) const {
        const float* matrix = &palette[bones[0]].rows[0][0];
#if BENDY_LANES == 8
        Lanes weight = weights[0];
        Lanes upper = weight * load_lanes(matrix);
        Quad lower = low(weight) * load_quad(matrix + 8);
        for (std::size_t k = 1; k < used; ++k) {
            matrix = &palette[bones[k]].rows[0][0];
            weight = weights[k];
            upper = fused(weight, load_lanes(matrix), upper);
            lower = fused(low(weight), load_quad(matrix + 8), lower);
        }
        store(to, upper);
        store(to + 8, lower);
#else
        Quad a = weights[0] * load_quad(matrix);
        Quad b = weights[0] * load_quad(matrix + 4);
        Quad c = weights[0] * load_quad(matrix + 8);
        for (std::size_t k = 1; k < used; ++k) {
            matrix = &palette[bones[k]].rows[0][0];
            a = fused(weights[k], load_quad(matrix), a);
            b = fused(weights[k], load_quad(matrix + 4), b);
            c = fused(weights[k], load_quad(matrix + 8), c);
        }
        store(to, a);
        store(to + 4, b);
        store(to + 8, c);
#endif
    }
};

template <std::size_t used, class Sum, class Bone>
inline void blend_group(const Sum& sum, const Bone* bones, const float* weights, std::size_t influences,
                        float (*rows)[16]) {
    for (std::size_t k = 0; k < kLanes; ++k) sum(bones + k * influences, weights + k * influences, used, rows[k]);
}

/// Returns the last of four influences, from 1, that any vertex of a group has.
inline std::size_t last_of_four(const float* weights, std::size_t influences) {
    Quad all{};
    for (std::size_t k = 0; k < kLanes; ++k) all = all | load_quad(weights + k * influences);
    std::uint32_t bits[4];
    std::memcpy(bits, &all, sizeof bits);
    if (bits[3] != 0) return 4;
    if (bits[2] != 0) return 3;
    return bits[1] != 0 ? 2 : 1;
}

/// Blends a group, using as many influences for each vertex as the group needs.
template <class Sum, class Bone>
inline void blend_any(const Sum& sum, const Bone* bones, const float* weights, std::size_t influences,
                      float (*rows)[16]) {
    std::size_t used = influences;
    if (influences == 4 || (influences == 8 && last_of_four(weights + 4, 8) == 1)) {
        used = last_of_four(weights, influences);
        if (influences == 8) {
            for (std::size_t k = 0; k < kLanes; ++k) {
                if (weights[k * 8 + 4] != 0.0f) used = 8;
            }
        }
    }
    switch (used) {
        case 1:
            return blend_group<1>(sum, bones, weights, influences, rows);
        case 2:
            return blend_group<2>(sum, bones, weights, influences, rows);
        case 3:
            return blend_group<3>(sum, bones, weights, influences, rows);
        case 4:
            return blend_group<4>(sum, bones, weights, influences, rows);
        default:
            break;
    }
    for (std::size_t k = 0; k < kLanes; ++k) sum(bones + k * influences, weights + k * influences, used, rows[k]);
}

/// Blends the `count` vertices from `vertex` on.
template <class Sum, class Bone>
BENDY_NOINLINE void blend_chunk(const Sum& sum, const SkinBlock& block, const Bone* bones, std::size_t vertex,
                                std::size_t count, Rows& rows) {
    std::size_t k = 0;
    for (; count - k >= kLanes; k += kLanes) {
        const std::size_t at = (vertex + k) * block.influences;
        blend_any(sum, bones + at, block.weights + at, block.influences, rows.of + k);
    }
    for (; k < count; ++k) {
        const std::size_t at = (vertex + k) * block.influences;
        sum(bones + at, block.weights + at, block.influences, rows.of[k]);
    }
    if (count % kLanes != 0) std::memset(rows.of + count, 0, (kLanes - count % kLanes) * sizeof rows.of[0]);
}

/// Transposes four numbers of each row of a group, from `from` in the first row on.
inline void turn_four(const float* from, Lanes* to) {
    transpose(load_quads(from, 64), load_quads(from + 16, 64), load_quads(from + 32, 64), load_quads(from + 48, 64),
              to);
}

inline Matrix turn(const float (*rows)[16]) {
    Matrix matrix;
    for (std::size_t row = 0; row < 3; ++row) turn_four(&rows[0][4 * row], matrix.at[row]);
    return matrix;
}

/// Processes chunk after chunk: blend(vertex, count) fills rows, and matrix_of(k) is the matrix of the group from row k
/// on.
template <class F, class Blend, class MatrixOfRow>
BENDY_ALWAYS_INLINE void transform_chunks(const SkinBlock& block, const Blend& blend, const MatrixOfRow& matrix_of) {
    for (std::size_t vertex = 0; vertex < block.vertices;) {
        const std::size_t count = block.vertices - vertex < kChunk ? block.vertices - vertex : kChunk;
        const std::size_t whole = count - count % kLanes;
        blend(vertex, count);
        transform<F>(block, vertex, whole, [&](std::size_t at) { return matrix_of(at - vertex); });
        if (whole < count) transform_last(matrix_of(whole), block, vertex + whole);
        vertex += count;
    }
}

template <class F, class Bone>
void skin_blended(const SkinBlock& block, const Bone* bones) {
    Rows rows;
    transform_chunks<F>(
        block,
        [&](std::size_t vertex, std::size_t count) {
            blend_chunk(MatrixSum{block.palette}, block, bones, vertex, count, rows);
        },
        [&](std::size_t k) { return turn(rows.of + k); });
}

template <class F>
void skin_rigid(const SkinBlock& block) {
    Matrix matrix;
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 4; ++column) matrix.at[row][column] = block.palette->rows[row][column];
    }
    transform_all<F>(block, [&](std::size_t) -> const Matrix& { return matrix; });
}

#if BENDY_LANES == 8

/// Computes sum(weight * matrix) for eight vertices at a time, from `count` bones that they share.
BENDY_ALWAYS_INLINE Matrix blend_shared(const PaletteMatrix* palette, const std::uint16_t* bones, const float* weights,
                                        std::size_t count) {
    const float* matrix = &palette[bones[0]].rows[0][0];
    Lanes weight = load_lanes(weights);
    Lanes m00 = weight * matrix[0], m01 = weight * matrix[1], m02 = weight * matrix[2], m03 = weight * matrix[3];
    Lanes m10 = weight * matrix[4], m11 = weight * matrix[5], m12 = weight * matrix[6], m13 = weight * matrix[7];
    Lanes m20 = weight * matrix[8], m21 = weight * matrix[9], m22 = weight * matrix[10], m23 = weight * matrix[11];
    for (std::size_t k = 1; k < count; ++k) {
        matrix = &palette[bones[k]].rows[0][0];
        weight = load_lanes(weights + 8 * k);
        m00 = fused(weight, matrix[0], m00);
        m01 = fused(weight, matrix[1], m01);
        m02 = fused(weight, matrix[2], m02);
        m03 = fused(weight, matrix[3], m03);
        m10 = fused(weight, matrix[4], m10);
        m11 = fused(weight, matrix[5], m11);
        m12 = fused(weight, matrix[6], m12);
        m13 = fused(weight, matrix[7], m13);
        m20 = fused(weight, matrix[8], m20);
        m21 = fused(weight, matrix[9], m21);
        m22 = fused(weight, matrix[10], m22);
        m23 = fused(weight, matrix[11], m23);
    }
    return {{{m00, m01, m02, m03}, {m10, m11, m12, m13}, {m20, m21, m22, m23}}};
}

/// The same from the influences of single vertices: for groups with too many bones.
BENDY_NOINLINE void blend_apart(const SkinBlock& block, std::size_t vertex, Matrix& matrix) {
    Rows rows;
    const std::size_t count = block.vertices - vertex < kLanes ? block.vertices - vertex : kLanes;
    if (block.bones16 != nullptr) {
        blend_chunk(MatrixSum{block.palette}, block, block.bones16, vertex, count, rows);
    } else {
        blend_chunk(MatrixSum{block.palette}, block, block.bones8, vertex, count, rows);
    }
    matrix = turn(rows.of);
}

BENDY_ALWAYS_INLINE Matrix blend_planned(const SkinBlock& block, std::size_t vertex) {
    const std::uint32_t* const first = block.plan_first + vertex / 8;
    if (first[1] != first[0]) {
        return blend_shared(block.palette, block.plan_bones + first[0], block.plan_weights + std::size_t{8} * first[0],
                            first[1] - first[0]);
    }
    Matrix matrix;
    blend_apart(block, vertex, matrix);
    return matrix;
}
#endif

template <class F>
void skin_as(const SkinBlock& block) {
#if BENDY_LANES == 8
    if constexpr (F::wanted != 1 && !F::unfolds) {
        if (block.normals8 != nullptr) return skin_as<typename F::Unfolding>(block);
    }
    if (block.plan_first != nullptr)
        return transform_all<F>(block, [&](std::size_t vertex) { return blend_planned(block, vertex); });
#endif
    if (block.bones8 != nullptr) {
        skin_blended<F>(block, block.bones8);
    } else if (block.bones16 != nullptr) {
        skin_blended<F>(block, block.bones16);
    } else {
        skin_rigid<F>(block);
    }
}

inline bool is_packed(const SkinOutput& out, std::size_t numbers) {
    return out.data == nullptr || out.stride == numbers;
}
#if defined(BENDY_LANES_OF_X86)
inline bool is_aligned(const SkinOutput& out) {
    return reinterpret_cast<std::uintptr_t>(out.data) % 16 == 0;
}
#endif

template <bool streams>
void skin_packed(const SkinBlock& block, int wanted) {
    switch (wanted) {
        case 1:
            return skin_as<Form<1, true, streams>>(block);
        case 3:
            return skin_as<Form<3, true, streams>>(block);
        case 7:
            return skin_as<Form<7, true, streams>>(block);
        default:
            return skin_as<AnyForm>(block);
    }
}

void skin_lanes(const SkinBlock& block) {
    const int wanted = (block.out_positions.data != nullptr ? 1 : 0) | (block.out_normals.data != nullptr ? 2 : 0) |
                       (block.out_tangents.data != nullptr ? 4 : 0);
    if (!is_packed(block.out_positions, 3) || !is_packed(block.out_normals, 3) || !is_packed(block.out_tangents, 4))
        return skin_as<AnyForm>(block);
#if defined(BENDY_LANES_OF_X86)
    if (block.streams && is_aligned(block.out_positions) && is_aligned(block.out_normals) &&
        is_aligned(block.out_tangents)) {
        skin_packed<true>(block, wanted);
        end_streams();
        return;
    }
#endif
    skin_packed<false>(block, wanted);
}
// NOLINTEND(misc-definitions-in-headers)
