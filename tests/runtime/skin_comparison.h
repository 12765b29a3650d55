#pragma once

#include "plan/blocks.h"
#include "runtime/skin_in_doubles.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

// A kernel against doubles, for tests here and on other processors: no GoogleTest, no exceptions.
namespace bendy::test {

inline constexpr float kUntouched = -77.0f;
inline constexpr double kEpsilon = std::numeric_limits<float>::epsilon();

/// Numbers that begin at no better boundary than their own, in memory that ends where they do.
struct Unaligned {
    explicit Unaligned(std::size_t count, float value = 0.0f) : memory(count + 1, value) {}
    float* data() { return memory.data() + 1; }
    std::vector<float> memory;
};

/// Vertices of `influences` bones at random.
struct RandomBlock {
    RandomBlock(std::size_t vertices, std::size_t influences, unsigned seed)
        : positions(3 * vertices),
          normals(3 * vertices),
          tangents(4 * vertices),
          weights(influences * vertices),
          bones8(influences * vertices),
          bones16(influences * vertices),
          palette(40) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> number(-1.0f, 1.0f);
        for (PaletteMatrix& entry : palette) {
            const glm::quat turn = glm::normalize(glm::quat(number(random), number(random), number(random), 0.1f));
            glm::mat3 m = glm::mat3_cast(turn);
            for (int c = 0; c < 3; ++c) m[c] *= 1.0f + 0.5f * number(random);
            if (seed % 2 == 1) m[0] = -m[0];  // mirrored
            for (int row = 0; row < 3; ++row) {
                for (int column = 0; column < 3; ++column) entry.rows[row][column] = m[column][row];
                entry.rows[row][3] = 3.0f * number(random);
            }
        }
        for (std::size_t v = 0; v < vertices; ++v) {
            for (int c = 0; c < 3; ++c) positions.data()[3 * v + static_cast<std::size_t>(c)] = number(random);
            for (int c = 0; c < 3; ++c) normals.data()[3 * v + static_cast<std::size_t>(c)] = number(random);
            for (int c = 0; c < 3; ++c) tangents.data()[4 * v + static_cast<std::size_t>(c)] = number(random);
            tangents.data()[4 * v + 3] = v % 3 == 0 ? -1.0f : 1.0f;
            float sum = 0.0f;
            const std::size_t used = random() % influences + 1;
            for (std::size_t k = 0; k < influences; ++k) {
                const std::size_t at = v * influences + k;
                // Near joints, so that what is blended has a volume.
                bones16[at] = bones8[at] =
                    static_cast<std::uint8_t>(k == 0 ? random() % palette.size() : bones8[at - 1]);
                if (k % 2 == 1) bones16[at] = bones8[at] = static_cast<std::uint8_t>(random() % palette.size());
                const bool is_zero = k >= used || random() % 8 == 0;
                sum += weights.data()[at] = is_zero ? 0.0f : std::abs(number(random));
            }
            if (sum > 0.0f) {
                for (std::size_t k = 0; k < influences; ++k) weights.data()[v * influences + k] /= sum;
            }
        }
        block.vertices = vertices;
        block.influences = influences;
        block.palette = palette.data();
        block.positions = positions.data();
        block.normals = normals.data();
        block.tangents = tangents.data();
        block.weights = weights.data();
        block.bones8 = bones8.data();
    }

    Unaligned positions, normals, tangents, weights;
    std::vector<std::uint8_t> bones8;
    std::vector<std::uint16_t> bones16;
    std::vector<PaletteMatrix> palette;
    SkinBlock block{};
};

struct Output {
    Output(SkinBlock& block, std::size_t position_stride, std::size_t normal_stride, std::size_t tangent_stride)
        : positions(block.vertices * position_stride, kUntouched),
          normals(block.vertices * normal_stride, kUntouched),
          tangents(block.vertices * tangent_stride, kUntouched) {
        block.out_positions = {position_stride == 0 ? nullptr : positions.data(), position_stride};
        block.out_normals = {normal_stride == 0 ? nullptr : normals.data(), normal_stride};
        block.out_tangents = {tangent_stride == 0 ? nullptr : tangents.data(), tangent_stride};
    }
    Unaligned positions, normals, tangents;
};

/// The blended linear part's volume against what it could be at most: how much of the cofactors cancels.
inline double flatness(const RandomBlock& random, std::size_t vertex) {
    const SkinBlock& b = random.block;
    glm::dmat3 m(0.0);
    for (std::size_t k = 0; k < b.influences; ++k) {
        const std::size_t at = vertex * b.influences + k;
        for (int row = 0; row < 3; ++row) {
            for (int c = 0; c < 3; ++c)
                m[c][row] += double{b.weights[at]} * random.palette[random.bones8[at]].rows[row][c];
        }
    }
    return std::abs(glm::determinant(m));
}

/// The worst that a kernel did, in units in the last place: of positions, of the sum of what goes into a number; of
/// directions, of one, times the volume that the blended matrix keeps (what is left of the cofactors otherwise).
struct SkinErrors {
    double positions = 0.0, directions = 0.0;
    bool has_strayed = false;  ///< memory between and before the vertices was written
    static constexpr double kMostForPositions = 8.0;
    static constexpr double kMostForDirections = 32.0;
    [[nodiscard]] bool are_small() const {
        return !has_strayed && positions <= kMostForPositions && directions <= kMostForDirections;
    }
    void add(const SkinErrors& more) {
        positions = std::max(positions, more.positions);
        directions = std::max(directions, more.directions);
        has_strayed = has_strayed || more.has_strayed;
    }
};

/// The largest difference of a vertex's first `numbers` of `stride`; the others must be untouched.
inline double difference(Unaligned& found, Unaligned& expected, std::size_t vertex, std::size_t stride,
                         std::size_t numbers, bool& has_strayed) {
    double worst = 0.0;
    for (std::size_t c = 0; c < stride; ++c) {
        const double is = found.data()[vertex * stride + c];
        const double should = expected.data()[vertex * stride + c];
        if (c >= numbers) {
            has_strayed = has_strayed || is != double{kUntouched};
        } else {
            worst =
                std::isfinite(is) ? std::max(worst, std::abs(is - should)) : std::numeric_limits<double>::infinity();
        }
    }
    return worst;
}

/// Sum of the magnitudes of all that is added up for a position; of the row where it is largest.
inline double magnitude(const RandomBlock& random, std::size_t vertex) {
    const SkinBlock& b = random.block;
    const bool is_rigid = b.bones8 == nullptr && b.bones16 == nullptr;
    double most = 0.0;
    for (int row = 0; row < 3; ++row) {
        double sum = 0.0;
        for (std::size_t k = 0; k < (is_rigid ? 1 : b.influences); ++k) {
            const std::size_t at = vertex * b.influences + k;
            const float(&m)[4] = random.palette[is_rigid ? 0 : random.bones8[at]].rows[row];
            const double weight = is_rigid ? 1.0 : double{b.weights[at]};
            for (std::size_t c = 0; c < 3; ++c) sum += std::abs(weight * m[c] * b.positions[3 * vertex + c]);
            sum += std::abs(weight * m[3]);
        }
        most = std::max(most, sum);
    }
    return most;
}

/// Strides of the outputs; 0 where none is wanted.
inline SkinErrors errors_of(RandomBlock& random, SkinKernel* kernel, std::size_t positions, std::size_t normals,
                            std::size_t tangents) {
    SkinBlock plain = random.block;
    Output expected(plain, positions, normals, tangents);
    skin_in_doubles(plain);
    SkinBlock block = random.block;
    Output found(block, positions, normals, tangents);
    kernel(block);
    SkinErrors errors;
    const bool is_rigid = block.bones8 == nullptr && block.bones16 == nullptr;
    for (std::size_t v = 0; v < block.vertices; ++v) {
        if (positions != 0) {
            const double off = difference(found.positions, expected.positions, v, positions, 3, errors.has_strayed);
            const double unit = kEpsilon * magnitude(random, v);
            if (off != 0.0) errors.positions = std::max(errors.positions, off / unit);
        }
        const double off = std::max(difference(found.normals, expected.normals, v, normals, 3, errors.has_strayed),
                                    difference(found.tangents, expected.tangents, v, tangents, 4, errors.has_strayed));
        const double volume = is_rigid ? 0.1 : flatness(random, v);
        if (volume >= 1e-2 || !std::isfinite(off))
            errors.directions = std::max(errors.directions, off * volume / kEpsilon);
    }
    errors.has_strayed = errors.has_strayed || found.positions.memory.front() != kUntouched;
    return errors;
}

}  // namespace bendy::test
