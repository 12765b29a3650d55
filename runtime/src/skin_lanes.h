// The body of the skinning kernels, included after lanes.h by one source for each instruction set, which also defines
// roots_of(Lanes) and stream(float*, Quad), and is compiled with that set's options.
//
// Some vertices at a time: matrices are blended vertex by vertex, as rows, since each vertex reads others; then they
// are turned so that a lane is a vertex, and what follows goes by lanes.

// NOLINTBEGIN(misc-definitions-in-headers): this is a body; it stands in a nameless namespace

struct Matrix {
    Lanes at[3][4];
};
template <bool streams>
inline void put_quad(float* to, Quad quad) {
    if constexpr (streams) {
        stream(to, quad);
    } else {
        store_quad(to, quad);
    }
}

template <bool streams>
inline void store_packed(const Three& v, float* to) {
    const Lanes xy = shuffle<0, 2, 0, 2>(v.x, v.y);
    const Lanes yz = shuffle<1, 3, 1, 3>(v.y, v.z);
    const Lanes zx = shuffle<0, 2, 1, 3>(v.z, v.x);
    const Lanes a = shuffle<0, 2, 0, 2>(xy, zx);
    const Lanes b = shuffle<0, 2, 1, 3>(yz, xy);
    const Lanes c = shuffle<1, 3, 1, 3>(zx, yz);
    put_quad<streams>(to, low(a));
    put_quad<streams>(to + 4, low(b));
    put_quad<streams>(to + 8, low(c));
#if BENDY_LANES == 8
    put_quad<streams>(to + 12, high(a));
    put_quad<streams>(to + 16, high(b));
    put_quad<streams>(to + 20, high(c));
#endif
}

/// `kept` of each four numbers at `stride`.
template <int kept>
inline void store_apart(Lanes x, Lanes y, Lanes z, Lanes w, float* to, std::size_t stride) {
    Lanes vertices[4];
    transpose(x, y, z, w, vertices);
    for (std::size_t k = 0; k < 4; ++k) {
        const Quad lower = low(vertices[k]);
        __builtin_memcpy(to + k * stride, &lower, kept * sizeof(float));
#if BENDY_LANES == 8
        const Quad upper = high(vertices[k]);
        __builtin_memcpy(to + (k + 4) * stride, &upper, kept * sizeof(float));
#endif
    }
}

/// What is known of a block before it runs: which attributes are wanted (1 positions, 2 normals, 4 tangents; 0 if that
/// is found out as it goes), that positions and normals are packed, and that they go past the caches.
template <int kWanted, bool kPacked, bool kStreams>
struct Form {
    static constexpr int wanted = kWanted;
    static constexpr bool packed = kPacked;
    static constexpr bool streams = kStreams;
};
using AnyForm = Form<0, false, false>;

template <class F>
inline void store_three(const Three& v, const SkinOutput& out, std::size_t vertex) {
    if constexpr (F::packed) {
        store_packed<F::streams>(v, out.data + 3 * vertex);
    } else if (out.stride == 3) {
        store_packed<false>(v, out.data + 3 * vertex);
    } else {
        store_apart<3>(v.x, v.y, v.z, v.z, out.data + out.stride * vertex, out.stride);
    }
}

template <class F, int kPart>
inline bool wants(const SkinOutput& out) {
    return F::wanted != 0 ? (F::wanted & kPart) != 0 : out.data != nullptr;
}

/// Zero stays zero.
inline Three normalised(const Three& v) {
    const Lanes length = roots_of(v.x * v.x + v.y * v.y + v.z * v.z);
    const Lanes scale = length > 0.0f ? 1.0f / length : Lanes{};
    return {v.x * scale, v.y * scale, v.z * scale};
}

/// One group of kLanes vertices.
template <class F>
inline __attribute__((always_inline)) void transform(const Matrix& matrix, const SkinBlock& block, std::size_t vertex) {
    const auto& m = matrix.at;
    if (wants<F, 1>(block.out_positions)) {
        const Three v = load_three(block.positions + 3 * vertex);
        const Three moved{m[0][0] * v.x + (m[0][1] * v.y + (m[0][2] * v.z + m[0][3])),
                          m[1][0] * v.x + (m[1][1] * v.y + (m[1][2] * v.z + m[1][3])),
                          m[2][0] * v.x + (m[2][1] * v.y + (m[2][2] * v.z + m[2][3]))};
        store_three<F>(moved, block.out_positions, vertex);
    }
    if (!wants<F, 2>(block.out_normals) && !wants<F, 4>(block.out_tangents)) return;
    const Lanes c00 = m[1][1] * m[2][2] - m[1][2] * m[2][1];
    const Lanes c01 = m[1][2] * m[2][0] - m[1][0] * m[2][2];
    const Lanes c02 = m[1][0] * m[2][1] - m[1][1] * m[2][0];
    const Lanes determinant = m[0][0] * c00 + (m[0][1] * c01 + m[0][2] * c02);
    const Lanes side = determinant < 0.0f ? splat(-1.0f) : splat(1.0f);
    if (wants<F, 2>(block.out_normals)) {
        // The inverse transpose but for its length: the cofactors, which a matrix without an inverse has, too.
        const Three v = load_three(block.normals + 3 * vertex);
        const Lanes c10 = m[2][1] * m[0][2] - m[2][2] * m[0][1];
        const Lanes c11 = m[2][2] * m[0][0] - m[2][0] * m[0][2];
        const Lanes c12 = m[2][0] * m[0][1] - m[2][1] * m[0][0];
        const Lanes c20 = m[0][1] * m[1][2] - m[0][2] * m[1][1];
        const Lanes c21 = m[0][2] * m[1][0] - m[0][0] * m[1][2];
        const Lanes c22 = m[0][0] * m[1][1] - m[0][1] * m[1][0];
        const Three n = normalised({c00 * v.x + (c01 * v.y + c02 * v.z), c10 * v.x + (c11 * v.y + c12 * v.z),
                                    c20 * v.x + (c21 * v.y + c22 * v.z)});
        store_three<F>({n.x * side, n.y * side, n.z * side}, block.out_normals, vertex);
    }
    if (wants<F, 4>(block.out_tangents)) {
        Lanes v[4];
        load_four(block.tangents + 4 * vertex, v);
        const Three t = normalised({m[0][0] * v[0] + (m[0][1] * v[1] + m[0][2] * v[2]),
                                    m[1][0] * v[0] + (m[1][1] * v[1] + m[1][2] * v[2]),
                                    m[2][0] * v[0] + (m[2][1] * v[1] + m[2][2] * v[2])});
        store_apart<4>(t.x, t.y, t.z, v[3] * side, block.out_tangents.data + block.out_tangents.stride * vertex,
                       block.out_tangents.stride);
    }
}

constexpr std::size_t kChunk = 64;  // vertices that are blended before they are transformed

/// Blended matrices, as rows; each on a cache line of its own.
struct Rows {
    alignas(64) float of[kChunk][16];
};

/// sum(weight * matrix) over `used` influences.
template <class Bone>
inline __attribute__((always_inline)) void blend_vertex(const PaletteMatrix* palette, const Bone* bones,
                                                        const float* weights, std::size_t used, float* to) {
#if BENDY_LANES == 8
    const float* matrix = &palette[bones[0]].rows[0][0];
    Lanes weight = splat(weights[0]);
    Lanes upper = weight * load_lanes(matrix);
    Quad lower = low(weight) * load_quad(matrix + 8);
    for (std::size_t k = 1; k < used; ++k) {
        matrix = &palette[bones[k]].rows[0][0];
        weight = splat(weights[k]);
        upper += weight * load_lanes(matrix);
        lower += low(weight) * load_quad(matrix + 8);
    }
    __builtin_memcpy(to, &upper, sizeof upper);
    store_quad(to + 8, lower);
#else
    const float* matrix = &palette[bones[0]].rows[0][0];
    Quad a = weights[0] * load_quad(matrix);
    Quad b = weights[0] * load_quad(matrix + 4);
    Quad c = weights[0] * load_quad(matrix + 8);
    for (std::size_t k = 1; k < used; ++k) {
        matrix = &palette[bones[k]].rows[0][0];
        a += weights[k] * load_quad(matrix);
        b += weights[k] * load_quad(matrix + 4);
        c += weights[k] * load_quad(matrix + 8);
    }
    store_quad(to, a);
    store_quad(to + 4, b);
    store_quad(to + 8, c);
#endif
}

template <std::size_t used, class Bone>
inline void blend_group(const PaletteMatrix* palette, const Bone* bones, const float* weights, std::size_t influences,
                        float (*rows)[16]) {
    for (std::size_t k = 0; k < kLanes; ++k)
        blend_vertex(palette, bones + k * influences, weights + k * influences, used, rows[k]);
}

/// The last of four influences, from 1, that any vertex of a group has.
inline std::size_t last_of_four(const float* weights, std::size_t influences) {
    using Bits = unsigned __attribute__((vector_size(16)));
    Bits any{};
    for (std::size_t k = 0; k < kLanes; ++k) {
        Bits bits;
        __builtin_memcpy(&bits, weights + k * influences, sizeof bits);
        any |= bits;
    }
    if (any[3] != 0) return 4;
    if (any[2] != 0) return 3;
    return any[1] != 0 ? 2 : 1;
}

/// A group, each vertex with as many influences as the group has.
template <class Bone>
inline void blend_any(const SkinBlock& block, const Bone* bones, const float* weights, float (*rows)[16]) {
    const std::size_t influences = block.influences;
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
            return blend_group<1>(block.palette, bones, weights, influences, rows);
        case 2:
            return blend_group<2>(block.palette, bones, weights, influences, rows);
        case 3:
            return blend_group<3>(block.palette, bones, weights, influences, rows);
        case 4:
            return blend_group<4>(block.palette, bones, weights, influences, rows);
        default:
            break;
    }
    for (std::size_t k = 0; k < kLanes; ++k)
        blend_vertex(block.palette, bones + k * influences, weights + k * influences, used, rows[k]);
}

/// The `count` vertices from `vertex` on.
template <class Bone>
__attribute__((noinline)) void blend_chunk(const SkinBlock& block, const Bone* bones, std::size_t vertex,
                                           std::size_t count, Rows& rows) {
    std::size_t k = 0;
    for (; count - k >= kLanes; k += kLanes) {
        const std::size_t at = (vertex + k) * block.influences;
        blend_any(block, bones + at, block.weights + at, rows.of + k);
    }
    for (; k < count; ++k) {
        const std::size_t at = (vertex + k) * block.influences;
        blend_vertex(block.palette, bones + at, block.weights + at, block.influences, rows.of[k]);
    }
}

inline Matrix turn(const float (*rows)[16]) {
    Matrix matrix;
    for (std::size_t row = 0; row < 3; ++row) {
        const float* const from = &rows[0][4 * row];
        transpose(load_quads(from, 64), load_quads(from + 16, 64), load_quads(from + 32, 64), load_quads(from + 48, 64),
                  matrix.at[row]);
    }
    return matrix;
}

#if BENDY_LANES == 8
/// sum(weight * matrix) for eight vertices at once, of `count` bones that they share.
inline __attribute__((always_inline)) Matrix blend_shared(const PaletteMatrix* palette, const std::uint16_t* bones,
                                                          const float* weights, std::size_t count) {
    const float* matrix = &palette[bones[0]].rows[0][0];
    Lanes weight = load_lanes(weights);
    Lanes m00 = weight * matrix[0], m01 = weight * matrix[1], m02 = weight * matrix[2], m03 = weight * matrix[3];
    Lanes m10 = weight * matrix[4], m11 = weight * matrix[5], m12 = weight * matrix[6], m13 = weight * matrix[7];
    Lanes m20 = weight * matrix[8], m21 = weight * matrix[9], m22 = weight * matrix[10], m23 = weight * matrix[11];
    for (std::size_t k = 1; k < count; ++k) {
        matrix = &palette[bones[k]].rows[0][0];
        weight = load_lanes(weights + 8 * k);
        m00 += weight * matrix[0];
        m01 += weight * matrix[1];
        m02 += weight * matrix[2];
        m03 += weight * matrix[3];
        m10 += weight * matrix[4];
        m11 += weight * matrix[5];
        m12 += weight * matrix[6];
        m13 += weight * matrix[7];
        m20 += weight * matrix[8];
        m21 += weight * matrix[9];
        m22 += weight * matrix[10];
        m23 += weight * matrix[11];
    }
    return {{{m00, m01, m02, m03}, {m10, m11, m12, m13}, {m20, m21, m22, m23}}};
}
#endif

inline Matrix spread(const PaletteMatrix& entry) {
    Matrix matrix;
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 4; ++column) matrix.at[row][column] = splat(entry.rows[row][column]);
    }
    return matrix;
}

/// Fewer than kLanes vertices: with copies around them that are as long as a group.
__attribute__((noinline)) void transform_last(const Matrix& matrix, const SkinBlock& block, std::size_t vertex) {
    const std::size_t count = block.vertices - vertex;
    float positions[3 * kLanes]{};
    float normals[3 * kLanes]{};
    float tangents[4 * kLanes]{};
    SkinBlock copy = block;
    const auto bring = [&](float* to, const float*& from, SkinOutput& out, std::size_t numbers) {
        if (out.data == nullptr) return;
        __builtin_memcpy(to, from + numbers * vertex, numbers * count * sizeof(float));
        from = to;
        out = {to, numbers};
    };
    bring(positions, copy.positions, copy.out_positions, 3);
    bring(normals, copy.normals, copy.out_normals, 3);
    bring(tangents, copy.tangents, copy.out_tangents, 4);
    transform<AnyForm>(matrix, copy, 0);
    const auto take = [&](const float* from, const SkinOutput& out, std::size_t numbers) {
        if (out.data == nullptr) return;
        for (std::size_t k = 0; k < count; ++k)
            __builtin_memcpy(out.data + (vertex + k) * out.stride, from + k * numbers, numbers * sizeof(float));
    };
    take(positions, block.out_positions, 3);
    take(normals, block.out_normals, 3);
    take(tangents, block.out_tangents, 4);
}

template <class F, class Bone>
void skin_blended(const SkinBlock& block, const Bone* bones) {
    Rows rows;
    for (std::size_t vertex = 0; vertex < block.vertices;) {
        const std::size_t count = block.vertices - vertex < kChunk ? block.vertices - vertex : kChunk;
        blend_chunk(block, bones, vertex, count, rows);
        std::size_t k = 0;
        for (; count - k >= kLanes; k += kLanes) transform<F>(turn(rows.of + k), block, vertex + k);
        if (k < count) {
            __builtin_memset(rows.of + count, 0, (k + kLanes - count) * sizeof rows.of[0]);
            transform_last(turn(rows.of + k), block, vertex + k);
        }
        vertex += count;
    }
}

#if BENDY_LANES == 8
template <class F, class Bone>
void skin_planned(const SkinBlock& block, const Bone* bones) {
    for (std::size_t vertex = 0; vertex < block.vertices; vertex += kLanes) {
        const std::size_t first = block.plan_first[vertex / kLanes];
        const std::size_t shared = block.plan_first[vertex / kLanes + 1] - first;
        const std::size_t count = block.vertices - vertex < kLanes ? block.vertices - vertex : kLanes;
        Matrix matrix;
        if (shared == 0) {
            Rows rows;
            blend_chunk(block, bones, vertex, count, rows);
            __builtin_memset(rows.of + count, 0, (kLanes - count) * sizeof rows.of[0]);
            matrix = turn(rows.of);
        } else {
            matrix = blend_shared(block.palette, block.plan_bones + first, block.plan_weights + kLanes * first, shared);
        }
        if (count == kLanes) {
            transform<F>(matrix, block, vertex);
        } else {
            transform_last(matrix, block, vertex);
        }
    }
}
#endif

template <class F>
void skin_rigid(const SkinBlock& block) {
    const Matrix matrix = spread(*block.palette);
    std::size_t vertex = 0;
    for (; block.vertices - vertex >= kLanes; vertex += kLanes) transform<F>(matrix, block, vertex);
    if (vertex < block.vertices) transform_last(matrix, block, vertex);
}

template <class F>
void skin_as(const SkinBlock& block) {
#if BENDY_LANES == 8
    if (block.plan_first != nullptr) {
        if (block.bones16 != nullptr) return skin_planned<F>(block, block.bones16);
        return skin_planned<F>(block, block.bones8);
    }
#endif
    if (block.bones8 != nullptr) {
        skin_blended<F>(block, block.bones8);
    } else if (block.bones16 != nullptr) {
        skin_blended<F>(block, block.bones16);
    } else {
        skin_rigid<F>(block);
    }
}

inline bool is_packed(const SkinOutput& out) {
    return out.data == nullptr || out.stride == 3;
}
inline bool is_aligned(const SkinOutput& out) {
    return reinterpret_cast<std::uintptr_t>(out.data) % 16 == 0;
}

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
    if (!is_packed(block.out_positions) || !is_packed(block.out_normals)) return skin_as<AnyForm>(block);
    if (block.streams && is_aligned(block.out_positions) && is_aligned(block.out_normals)) {
        skin_packed<true>(block, wanted);
        end_streams();
        return;
    }
    skin_packed<false>(block, wanted);
}
// NOLINTEND(misc-definitions-in-headers)
