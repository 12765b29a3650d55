#pragma once

#include "runtime/dual_in_doubles.h"
#include "runtime/skin_comparison.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

// A kernel for dual quaternions against doubles, for tests here and on other processors: no GoogleTest, no
// exceptions.
namespace bendy::test {

/// Motions for a RandomBlock's bones; all numbers are floats, so that both ways begin with the same.
struct RandomDuals {
    RandomDuals(bool is_stretched, unsigned seed) : motions(kBones), rounded(kBones), stretches(kBones) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> number(-1.0f, 1.0f);
        for (std::size_t bone = 0; bone < kBones; ++bone) {
            const glm::quat turn =
                glm::normalize(glm::quat(number(random), number(random), number(random), number(random)));
            const glm::quat dual =
                0.5f * (glm::quat(0.0f, 3.0f * number(random), number(random), number(random)) * turn);
            motions[bone].real = turn;
            motions[bone].dual = dual;
            rounded[bone] = {{turn.x, turn.y, turn.z, turn.w}, {dual.x, dual.y, dual.z, dual.w}};
            if (!is_stretched) continue;
            for (int row = 0; row < 3; ++row) {
                for (int c = 0; c <= row; ++c) {  // symmetric, and of some volume
                    const float share = (row == c ? 1.0f : 0.0f) + 0.2f * number(random);
                    motions[bone].stretch[c][row] = motions[bone].stretch[row][c] = share;
                }
                motions[bone].shift[row] = number(random);
            }
            for (int row = 0; row < 3; ++row) {
                for (int c = 0; c < 3; ++c)
                    stretches[bone].rows[row][c] = static_cast<float>(motions[bone].stretch[c][row]);
                stretches[bone].rows[row][3] = static_cast<float>(motions[bone].shift[row]);
            }
        }
    }

    static constexpr std::size_t kBones = 40;  // as in RandomBlock
    std::vector<StretchedMotion> motions;
    std::vector<DualMotion> rounded;
    std::vector<PaletteMatrix> stretches;
};

/// The length of the sum of a vertex' rotations: what rounding is divided by. 0 if one of them is so nearly at right
/// angles to the heaviest that its side hangs on rounding.
inline double length_of_sum(const RandomBlock& random, const RandomDuals& duals, std::size_t vertex) {
    const SkinBlock& b = random.block;
    const auto bone = [&](std::size_t at) { return b.bones8 != nullptr ? std::size_t{b.bones8[at]} : b.bones16[at]; };
    const std::size_t first = vertex * b.influences;
    std::size_t heaviest = first;
    for (std::size_t at = first; at < first + b.influences; ++at) {
        if (b.weights[at] > b.weights[heaviest]) heaviest = at;
    }
    glm::dquat sum(0.0, 0.0, 0.0, 0.0);
    for (std::size_t at = first; at < first + b.influences; ++at) {
        const glm::dquat& real = duals.motions[bone(at)].real;
        const double side = glm::dot(real, duals.motions[bone(heaviest)].real);
        if (b.weights[at] > 0.0f && std::abs(side) < 1e-5) return 0.0;
        sum = sum + (side < 0.0 ? -1.0 : 1.0) * b.weights[at] * real;
    }
    return glm::length(sum);
}

/// The worst that a kernel did, in units in the last place: of positions, of a size that all numbers keep to; of
/// directions, of one; both times the length of the vertex' sum.
struct DualErrors {
    double positions = 0.0, directions = 0.0;
    bool has_strayed = false;  ///< memory between and before the vertices was written
    static constexpr double kMostForPositions = 8.0;
    static constexpr double kMostForDirections = 16.0;
    [[nodiscard]] bool are_small() const {
        return !has_strayed && positions <= kMostForPositions && directions <= kMostForDirections;
    }
    void add(const DualErrors& more) {
        positions = std::max(positions, more.positions);
        directions = std::max(directions, more.directions);
        has_strayed = has_strayed || more.has_strayed;
    }
};

/// Strides of the outputs; 0 where none is wanted.
inline DualErrors dual_errors_of(RandomBlock& random, bool is_stretched, DualKernel* kernel, std::size_t positions,
                                 std::size_t normals, std::size_t tangents) {
    constexpr float kScale = 1.5f;
    constexpr double kSize = 10.0;  // of 1.5 times a place between -1.7 and 1.7, a shift and a translation up to 3.5
    const RandomDuals duals(is_stretched, static_cast<unsigned>(random.block.vertices));
    SkinBlock plain = random.block;
    Output expected(plain, positions, normals, tangents);
    dual_in_doubles(plain, duals.motions, kScale, is_stretched);
    DualBlock block{random.block, duals.rounded.data(), kScale};
    block.vertices.palette = is_stretched ? duals.stretches.data() : nullptr;
    Output found(block.vertices, positions, normals, tangents);
    kernel(block);
    DualErrors errors;
    for (std::size_t v = 0; v < random.block.vertices; ++v) {
        const double length = length_of_sum(random, duals, v);
        const double place = difference(found.positions, expected.positions, v, positions, 3, errors.has_strayed);
        const double turn = std::max(difference(found.normals, expected.normals, v, normals, 3, errors.has_strayed),
                                     difference(found.tangents, expected.tangents, v, tangents, 4, errors.has_strayed));
        const bool has_no_weights = std::all_of(random.block.weights + v * random.block.influences,
                                                random.block.weights + (v + 1) * random.block.influences,
                                                [](float weight) { return weight == 0.0f; });
        const double least = has_no_weights ? 1.0 : length;
        if (least < 0.01 && std::isfinite(place) && std::isfinite(turn)) continue;
        errors.positions = std::max(errors.positions, place * least / (kSize * kEpsilon));
        errors.directions = std::max(errors.directions, turn * least / kEpsilon);
    }
    errors.has_strayed = errors.has_strayed || found.positions.memory.front() != kUntouched;
    return errors;
}

}  // namespace bendy::test
