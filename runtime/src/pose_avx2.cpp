#include "pose_block.h"

#if defined(__AVX2__)

namespace bendy {
namespace {

using Doubles = double __attribute__((vector_size(32)));
using Floats = float __attribute__((vector_size(16)));

inline Doubles load(const double* from) {
    Doubles four;
    __builtin_memcpy(&four, from, sizeof four);
    return four;
}
inline void store(double* to, Doubles four) {
    __builtin_memcpy(to, &four, sizeof four);
}
inline Floats load_floats(const float* from) {
    Floats four;
    __builtin_memcpy(&four, from, sizeof four);
    return four;
}
inline void store_floats(float* to, Floats four) {
    __builtin_memcpy(to, &four, sizeof four);
}

inline void transpose(Floats a, Floats b, Floats c, Floats d, Floats* to) {
    const Floats ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5);
    const Floats ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
    const Floats cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5);
    const Floats cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
    to[0] = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
    to[1] = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
    to[2] = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
    to[3] = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

/// One column of four joints, with zeros below: from a lane each to a vector each.
inline void store_columns(Doubles x, Doubles y, Doubles z, double* to) {
    const Doubles xy_even = __builtin_shufflevector(x, y, 0, 4, 2, 6);
    const Doubles xy_odd = __builtin_shufflevector(x, y, 1, 5, 3, 7);
    const Doubles z_even = __builtin_shufflevector(z, Doubles{}, 0, 4, 2, 6);
    const Doubles z_odd = __builtin_shufflevector(z, Doubles{}, 1, 5, 3, 7);
    store(to, __builtin_shufflevector(xy_even, z_even, 0, 1, 4, 5));
    store(to + 16, __builtin_shufflevector(xy_odd, z_odd, 0, 1, 4, 5));
    store(to + 32, __builtin_shufflevector(xy_even, z_even, 2, 3, 6, 7));
    store(to + 48, __builtin_shufflevector(xy_odd, z_odd, 2, 3, 6, 7));
}

/// Local matrices of four joints: to_matrix without shear.
inline void make_local(const float* local, double* to) {
    Floats rotations[4];
    transpose(load_floats(local), load_floats(local + 10), load_floats(local + 20), load_floats(local + 30), rotations);
    const Doubles x = __builtin_convertvector(rotations[0], Doubles);
    const Doubles y = __builtin_convertvector(rotations[1], Doubles);
    const Doubles z = __builtin_convertvector(rotations[2], Doubles);
    const Doubles w = __builtin_convertvector(rotations[3], Doubles);
    Floats scales[4];  // from translation z on
    transpose(load_floats(local + 6), load_floats(local + 16), load_floats(local + 26), load_floats(local + 36),
              scales);
    const Doubles sx = __builtin_convertvector(scales[1], Doubles);
    const Doubles sy = __builtin_convertvector(scales[2], Doubles);
    const Doubles sz = __builtin_convertvector(scales[3], Doubles);
    const Doubles x2 = x + x;
    const Doubles y2 = y + y;
    const Doubles z2 = z + z;
    const Doubles xx = x * x2, yy = y * y2, zz = z * z2;
    const Doubles xy = x * y2, xz = x * z2, yz = y * z2;
    store_columns((1.0 - (yy + zz)) * sx, (xy + w * z2) * sx, (xz - w * y2) * sx, to);
    store_columns((xy - w * z2) * sy, (1.0 - (xx + zz)) * sy, (yz + w * x2) * sy, to + 4);
    store_columns((xz + w * y2) * sz, (yz - w * x2) * sz, (1.0 - (xx + yy)) * sz, to + 8);
    for (std::size_t k = 0; k < 4; ++k) {
        const float* const place = local + 10 * k + 4;
        store(to + 16 * k + 12, Doubles{place[0], place[1], place[2], 1.0});
    }
}

/// A joint from its local matrix; its parent is there already.
inline void put_joint(const PoseBlock& block, std::size_t joint, const double* local) {
    const std::uint32_t parent = block.parents[joint];
    Doubles columns[4] = {load(local), load(local + 4), load(local + 8), load(local + 12)};
    if (parent != 0xffff'ffffu) {
        const double* const above = block.exact + 16 * std::size_t{parent};
        const Doubles a = load(above), b = load(above + 4), c = load(above + 8), d = load(above + 12);
        for (std::size_t k = 0; k < 3; ++k)
            columns[k] = (a * local[4 * k] + b * local[4 * k + 1]) + c * local[4 * k + 2];
        columns[3] = (a * local[12] + b * local[13]) + (c * local[14] + d);
    }
    for (std::size_t k = 0; k < 4; ++k) {
        store(block.exact + 16 * joint + 4 * k, columns[k]);
        store_floats(block.model + 16 * joint + 4 * k, __builtin_convertvector(columns[k], Floats));
    }
}

}  // namespace

void pose_avx2(const PoseBlock& block) {
    alignas(32) double local[4 * 16];
    std::size_t joint = 0;
    for (; block.joints - joint >= 4; joint += 4) {
        make_local(block.local + 10 * joint, local);
        for (std::size_t k = 0; k < 4; ++k) put_joint(block, joint + k, local + 16 * k);
    }
    if (joint == block.joints) return;
    float last[4 * 10]{};
    const std::size_t count = block.joints - joint;
    __builtin_memcpy(last, block.local + 10 * joint, count * 10 * sizeof(float));
    make_local(last, local);
    for (std::size_t k = 0; k < count; ++k) put_joint(block, joint + k, local + 16 * k);
}

bool palette_avx2(const PaletteBlock& block) {
    Floats sum{};  // stays zero as long as numbers are finite
    for (std::size_t entry = 0; entry < block.entries; ++entry) {
        const double* const joint = block.exact + 16 * std::size_t{block.joints[entry]};
        const double* const bind = block.inverse_bind + 16 * entry;
        const Doubles a = load(joint), b = load(joint + 4), c = load(joint + 8), d = load(joint + 12);
        Floats columns[4];
        for (std::size_t k = 0; k < 4; ++k) {
            const double* const from = bind + 4 * k;
            columns[k] = __builtin_convertvector((a * from[0] + b * from[1]) + (c * from[2] + d * from[3]), Floats);
        }
        Floats rows[4];
        transpose(columns[0], columns[1], columns[2], columns[3], rows);
        for (std::size_t row = 0; row < 3; ++row) {
            store_floats(block.palette[entry].rows[row], rows[row]);
            sum += 0.0f * rows[row];
        }
    }
    return sum[0] == 0.0f && sum[1] == 0.0f && sum[2] == 0.0f && sum[3] == 0.0f;
}

}  // namespace bendy

#endif
