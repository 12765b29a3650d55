#pragma once

#include "kernels/kernel_table.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <type_traits>
#include <utility>
#include <vector>

// The kernels for posing against doubles, for tests here and on other processors: no GoogleTest, no exceptions.
namespace bendy::test {

/// Worst errors, in units in the last place of the largest number that goes into one.
struct PoseErrors {
    double pose = 0.0, palette = 0.0, sample = 0.0, unpack = 0.0, mix = 0.0, add = 0.0, decode = 0.0;
    bool finds_infinity = true;  ///< the palette kernel's answer
    bool poses_match = true;     ///< poses side by side, or joint by joint, have the bits of whole ones

    static constexpr double kMostForPose = 2.0;  // for each joint on the way
    static constexpr double kMostForPalette = 3.0;
    static constexpr double kMostForSample = 4.0;
    static constexpr double kMostForUnpack = 8.0;
    static constexpr double kMostForBlends = 4.0;
    static constexpr double kMostForDecoding =
        4.0;  // one for each rounding: before + weight * (minimum + step * integer)
    [[nodiscard]] bool are_small() const {
        return pose <= kMostForPose && palette <= kMostForPalette && sample <= kMostForSample &&
               unpack <= kMostForUnpack && mix <= kMostForBlends && add <= kMostForBlends &&
               decode <= kMostForDecoding && finds_infinity && poses_match;
    }
};

class PoseComparison {
public:
    explicit PoseComparison(const KernelTable& kernels) : kernels_(kernels) {}

    PoseErrors run() {
        for (const std::size_t joints : {1u, 2u, 3u, 4u, 5u, 7u, 8u, 9u, 16u, 31u}) {
            compare_matrices(joints);
            compare_poses(joints);
            compare_blends(joints);
        }
        for (const float angle : {0.0f, 0.3f, 1.5f, 3.0f}) {
            compare_samples(angle);
            compare_timed_samples(angle);
            for (const std::uint32_t tracks : {1u, 3u, 4u, 5u, 8u}) compare_unpacking(angle, tracks);
        }
        compare_splines();
        compare_decoding<std::uint8_t>();
        compare_decoding<std::int8_t>();
        compare_decoding<std::uint16_t>();
        compare_decoding<std::int16_t>();
        compare_decoding<std::uint32_t>();
        return errors_;
    }

private:
    static constexpr double kUnit = 0x1p-24;
    static constexpr float kOutside = 0.5f;  ///< each number of a lane without a joint: a unit rotation
    using Floats = std::vector<float>;

    float number() { return numbers_(random_); }
    glm::quat rotation() { return glm::normalize(glm::quat(number(), number(), number(), number())); }
    static void note(double& worst, double found, double expected, double largest) {
        const double error = std::abs(found - expected) / (kUnit * largest);
        if (!std::isnan(worst) && !(error <= worst)) worst = error;  // what is not a number stays
    }

    /// The numbers of joints in blocks.
    class Blocks {
    public:
        explicit Blocks(std::size_t joints, float all = 0.0f)
            : floats_(kBlockFloats * ((joints + kBlockJoints - 1) / kBlockJoints), all) {}
        float* data() { return floats_.data(); }
        [[nodiscard]] const float* data() const { return floats_.data(); }
        float& at(std::size_t joint, std::size_t number) { return floats_[place_of(joint, number)]; }
        [[nodiscard]] float at(std::size_t joint, std::size_t number) const { return floats_[place_of(joint, number)]; }
        [[nodiscard]] glm::dquat rotation_of(std::size_t joint) const {
            return {at(joint, 3), at(joint, 0), at(joint, 1), at(joint, 2)};
        }
        [[nodiscard]] glm::dmat4 matrix_of(std::size_t joint) const {
            glm::dmat4 matrix = glm::mat4_cast(rotation_of(joint));
            for (int c = 0; c < 3; ++c) matrix[c] *= double{at(joint, 7 + static_cast<std::size_t>(c))};
            matrix[3] = glm::dvec4(at(joint, 4), at(joint, 5), at(joint, 6), 1.0);
            return matrix;
        }
        static std::uint32_t place_of(std::size_t joint, std::size_t number) {
            return static_cast<std::uint32_t>(joint / kBlockJoints * kBlockFloats + number * kBlockJoints +
                                              joint % kBlockJoints);
        }

    private:
        Floats floats_;
    };

    /// The lanes after the last joint are set too, to what a kernel must leave alone or may read.
    Blocks random_pose(std::size_t joints) {
        Blocks local(joints, kOutside);
        for (std::size_t k = 0; k < joints; ++k) {
            const glm::quat q = rotation();
            const std::array<float, 10> numbers{q.x,
                                                q.y,
                                                q.z,
                                                q.w,
                                                number(),
                                                number(),
                                                number(),
                                                1.0f + 0.3f * number(),
                                                1.0f + 0.3f * number(),
                                                -1.0f + 0.3f * number()};
            for (std::size_t c = 0; c < numbers.size(); ++c) local.at(k, c) = numbers[c];
        }
        return local;
    }
    static glm::dquat rotation_at(const float* at) { return {at[3], at[0], at[1], at[2]}; }
    /// The largest a number of the product can be before signs cancel.
    static glm::dmat4 without_signs(glm::dmat4 matrix) {
        for (int c = 0; c < 4; ++c) matrix[c] = glm::abs(matrix[c]);
        return matrix;
    }

    void compare_matrices(std::size_t joints) {
        const Blocks local = random_pose(joints);
        std::vector<std::uint32_t> parents(joints, 0xffff'ffffu), order(joints), entries(joints);
        for (std::uint32_t k = 0; k < joints; ++k) {
            order[k] = k;
            entries[k] = static_cast<std::uint32_t>(joints) - 1 - k;
            if (k % 7 != 0) parents[k] = k - 1 - (k % 3 == 2 ? 1 : 0);
        }
        Floats model(16 * ((joints + kBlockJoints - 1) / kBlockJoints * kBlockJoints));
        kernels_.pose({joints, local.data(), parents.data(), order.data(), model.data()});
        std::vector<glm::dmat4> expected(joints), sums(joints);
        std::vector<double> depth(joints, 1.0);
        for (std::size_t k = 0; k < joints; ++k) {
            expected[k] = local.matrix_of(k);
            sums[k] = without_signs(expected[k]);
            for (int c = 0; c < 3; ++c) sums[k][c] += glm::dvec4(glm::dvec3(1.3), 0.0);
            if (parents[k] != 0xffff'ffffu) {
                expected[k] = expected[parents[k]] * expected[k];
                sums[k] = sums[parents[k]] * sums[k];
                depth[k] = depth[parents[k]] + 1.0;
            }
            for (int c = 0; c < 4; ++c) {
                for (int r = 0; r < 3; ++r)
                    note(errors_.pose, model[16 * k + 4 * std::size_t(c) + std::size_t(r)], expected[k][c][r],
                         depth[k] * sums[k][c][r]);
            }
        }
        compare_subtree(local, parents, model);
        compare_palette(model, entries);
    }

    /// The last joints again, from the matrices of the others.
    void compare_subtree(const Blocks& local, const std::vector<std::uint32_t>& parents, Floats model) {
        const auto end = static_cast<std::uint32_t>(parents.size());
        const Floats expected = model;
        for (std::uint32_t first = 0; first < end; first += 3) {
            std::fill_n(model.data() + 16 * first, 16 * (end - first), -9.0f);
            kernels_.pose_subtree({end, local.data(), parents.data(), nullptr, model.data()}, first, end);
            if (std::memcmp(model.data(), expected.data(), 16 * end * sizeof(float)) != 0) errors_.poses_match = false;
        }
    }

    void compare_palette(Floats& model, const std::vector<std::uint32_t>& joints) {
        std::vector<PaletteMatrix> bind(joints.size()), palette(joints.size());
        for (PaletteMatrix& entry : bind) {
            for (auto& row : entry.rows) {
                for (float& each : row) each = number();
            }
        }
        const PaletteBlock block{joints.size(), model.data(), joints.data(), bind.data(), palette.data()};
        errors_.finds_infinity = kernels_.palette(block) && errors_.finds_infinity;
        for (std::size_t k = 0; k < joints.size(); ++k) {
            const float* const m = &model[16 * std::size_t{joints[k]}];
            for (std::size_t row = 0; row < 3; ++row) {
                for (std::size_t column = 0; column < 4; ++column) {
                    double sum = column == 3 ? m[12 + row] : 0.0f;
                    double largest = std::abs(sum);
                    for (std::size_t i = 0; i < 3; ++i) {
                        const double product = double{m[4 * i + row]} * bind[k].rows[i][column];
                        sum += product;
                        largest += std::abs(product);
                    }
                    note(errors_.palette, palette[k].rows[row][column], sum, largest);
                }
            }
        }
        model[16 * std::size_t{joints.back()} + 13] = INFINITY;
        errors_.finds_infinity = !kernels_.palette(block) && errors_.finds_infinity;
    }

    /// Eight poses side by side, the last two the same.
    void compare_poses(std::size_t joints) {
        constexpr std::size_t kPoses = PosesBlock::kPoses;
        std::vector<Blocks> poses;
        for (std::size_t k = 0; k + 1 < kPoses; ++k) poses.push_back(random_pose(joints));
        for (std::size_t k = 0; k < joints; k += 2) {  // products with zeros, of both signs
            for (std::size_t c = 0; c < 7; ++c) poses[1].at(k, c) = c == 3 ? 1.0f : c % 2 == 0 ? 0.0f : -0.0f;
        }
        std::vector<std::uint32_t> parents(joints, 0xffff'ffffu), order(joints), entries(joints + 2);
        for (std::uint32_t k = 0; k < joints; ++k) {
            order[k] = k;
            if (k % 7 != 0) parents[k] = k - 1 - (k % 3 == 2 ? 1 : 0);
        }
        for (std::uint32_t& joint : entries) joint = static_cast<std::uint32_t>(random_() % joints);
        std::vector<PaletteMatrix> bind(entries.size()), expected(entries.size());
        for (PaletteMatrix& entry : bind) {
            for (auto& row : entry.rows) {
                for (float& each : row) each = random_() % 4 == 0 ? -0.0f : number();
            }
        }
        std::vector<std::vector<PaletteMatrix>> palettes(kPoses - 1, expected), matrices = palettes;
        Floats together(kMatrixLanes * joints);
        PosesBlock block{joints, {}, parents.data(), together.data()};
        PalettesBlock skinned{entries.size(), together.data(), entries.data(), bind.data(), {}};
        PalettesBlock own{entries.size(), together.data(), entries.data(), nullptr, {}};
        for (std::size_t k = 0; k < kPoses; ++k) {
            const std::size_t pose = std::min(k, poses.size() - 1);
            block.local[k] = poses[pose].data();
            skinned.palette[k] = palettes[pose].data();
            own.palette[k] = matrices[pose].data();
        }
        kernels_.poses(block);
        kernels_.palettes(skinned);
        kernels_.palettes(own);
        Floats model(16 * ((joints + kBlockJoints - 1) / kBlockJoints * kBlockJoints));
        for (std::size_t pose = 0; pose < poses.size(); ++pose) {
            kernels_.pose({joints, poses[pose].data(), parents.data(), order.data(), model.data()});
            (void)kernels_.palette({entries.size(), model.data(), entries.data(), bind.data(), expected.data()});
            const std::size_t bytes = entries.size() * sizeof(PaletteMatrix);
            if (std::memcmp(palettes[pose].data(), expected.data(), bytes) != 0) errors_.poses_match = false;
            for (std::size_t entry = 0; entry < entries.size(); ++entry) {
                for (std::size_t row = 0; row < 3; ++row) {
                    for (std::size_t column = 0; column < 4; ++column)
                        expected[entry].rows[row][column] = model[16 * std::size_t{entries[entry]} + 4 * column + row];
                }
            }
            if (std::memcmp(matrices[pose].data(), expected.data(), bytes) != 0) errors_.poses_match = false;
        }
    }

    static glm::dquat slerp(const glm::dquat& a, glm::dquat b, double u) {
        double dot = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
        if (dot < 0.0) b = -b;
        const double angle = std::acos(std::min(std::abs(dot), 1.0));
        if (angle < 1e-7) return a * (1.0 - u) + b * u;
        return a * (std::sin(angle * (1.0 - u)) / std::sin(angle)) + b * (std::sin(angle * u) / std::sin(angle));
    }
    static void note_rotation(double& worst, const glm::dquat& found, const glm::dquat& expected) {
        note(worst, found.x, expected.x, 1.0);
        note(worst, found.y, expected.y, 1.0);
        note(worst, found.z, expected.z, 1.0);
        note(worst, found.w, expected.w, 1.0);
    }

    /// Two groups of rotations, and three vectors; a turn of `angle` between keys.
    void compare_samples(float angle) {
        constexpr std::size_t kTracks = 11, kKeys = 3;
        std::vector<Floats> rotations(kTracks), vectors(3);
        for (Floats& keys : rotations) {
            glm::quat q = rotation();
            for (std::size_t key = 0; key < kKeys; ++key, q = -q) {
                keys.insert(keys.end(), {q.x, q.y, q.z, q.w});
                q = glm::normalize(q * glm::angleAxis(angle * number(), glm::normalize(glm::vec3(1, number(), 0.5))));
            }
        }
        for (Floats& keys : vectors) {
            for (std::size_t k = 0; k < 3 * kKeys; ++k) keys.push_back(number());
        }
        // Eleven rotations in two blocks; vectors by group and one by one.
        std::vector<TrackGroup> groups = groups_of(rotations);
        TrackGroup vector_group{{}, {}, 5, Blocks::place_of(0, 4)};
        for (std::size_t k = 0; k < 8; ++k) {
            vector_group.keys[k] = vectors[k % 3].data();
            if (k % 3 != 2) vector_group.has_track[k] = kAllBits;
        }
        const VectorTrack track{vectors[2].data(), Blocks::place_of(10, 7)};
        for (const float u : {0.0f, 0.125f, 0.7f, 1.0f}) {
            Blocks local(kTracks, -9.0f);
            kernels_.sample({groups.data(), 2, &vector_group, 1, &track, 1, 1, u, 0.0f, local.data()});
            for (std::size_t k = 0; k < kTracks; ++k) {
                const glm::dquat left = rotation_at(&rotations[k][4]), right = rotation_at(&rotations[k][8]);
                note_rotation(errors_.sample, local.rotation_of(k), u == 1.0f ? right : slerp(left, right, u));
            }
            const auto note_vector = [&](const Floats& keys, std::size_t joint, std::size_t first) {
                for (std::size_t c = 0; c < 3; ++c)
                    note(errors_.sample, local.at(joint, first + c),
                         (1.0 - double{u}) * keys[3 + c] + double{u} * keys[6 + c], 1.0);
            };
            for (std::size_t k = 0; k < 8; ++k) {
                if (k % 3 != 2) note_vector(vectors[k % 3], k, 4);
            }
            note_vector(vectors[2], 10, 7);
            for (const auto& [joint, number] : {std::pair{2, 4}, {5, 5}, {0, 7}, {11, 3}, {15, 0}})  // without a track
                note(errors_.sample, local.at(std::size_t(joint), std::size_t(number)), -9.0, 1e-9);
        }
    }

    /// A group of rotations and one of vectors, each lane at another moment between keys of its own; a lane without a
    /// track.
    void compare_timed_samples(float angle) {
        constexpr std::size_t kFree = 6;  // the lane without a track
        constexpr float kMoments[kBlockJoints]{0.0f, 0.125f, 0.7f, 1.0f, -0.5f, 1.5f, 0.3f, 0.9f};
        std::vector<Floats> rotations(kBlockJoints), vectors(kBlockJoints);
        for (Floats& keys : rotations) {
            const glm::quat q = rotation();
            const glm::quat next =
                -glm::normalize(q * glm::angleAxis(angle * number(), glm::normalize(glm::vec3(1, number(), 0.5))));
            keys = {q.x, q.y, q.z, q.w, next.x, next.y, next.z, next.w};
        }
        for (Floats& keys : vectors) {
            for (std::size_t k = 0; k < 6; ++k) keys.push_back(number());
        }
        for (const bool is_rotation : {true, false}) {
            TrackGroup group{{}, {}, kBlockJoints - 1, Blocks::place_of(0, is_rotation ? 0 : 7)};
            Blocks local(kBlockJoints, -9.0f);
            TimedBlock block{&group, {}, {}, {}, 2.0f, is_rotation, local.data()};
            for (std::size_t k = 0; k < kBlockJoints; ++k) {
                group.has_track[k] = k == kFree ? 0 : kAllBits;
                block.keys[k] = (is_rotation ? rotations : vectors)[k].data();
                block.left[k] = 2.0f - 0.5f * kMoments[k];
                block.right[k] = block.left[k] + 0.5f;
            }
            kernels_.sample_timed(block);
            for (std::size_t k = 0; k < kBlockJoints; ++k) {
                const double u = std::clamp((2.0 - block.left[k]) / (double{block.right[k]} - block.left[k]), 0.0, 1.0);
                const glm::dquat left = rotation_at(rotations[k].data()), right = rotation_at(&rotations[k][4]);
                if (k != kFree && is_rotation)
                    note_rotation(errors_.sample, local.rotation_of(k), u == 1.0 ? right : slerp(left, right, u));
                for (std::size_t c = 0; c < 3; ++c) {
                    const double vector = (1.0 - u) * vectors[k][c] + u * vectors[k][3 + c];
                    const bool is_set = k != kFree && !is_rotation;
                    note(errors_.sample, local.at(k, 7 + c), is_set ? vector : -9.0, is_set ? 1.0 : 1e-9);
                }
                if (k == kFree) note(errors_.sample, local.at(k, 0), -9.0, 1e-9);
            }
        }
    }

    /// Groups of rotation tracks for joints in order.
    std::vector<TrackGroup> groups_of(const std::vector<Floats>& rotations) {
        std::vector<TrackGroup> groups((rotations.size() + kBlockJoints - 1) / kBlockJoints);
        for (std::size_t k = 0; k < groups.size() * kBlockJoints; ++k) {
            TrackGroup& group = groups[k / kBlockJoints];
            group.place = Blocks::place_of(k - k % kBlockJoints, 0);
            group.keys[k % kBlockJoints] = rotations[std::min(k, rotations.size() - 1)].data();
            if (k >= rotations.size()) continue;
            group.has_track[k % kBlockJoints] = kAllBits;
            ++group.count;
        }
        return groups;
    }

    /// Two groups of cubic rotations, and two vectors.
    void compare_splines() {
        constexpr std::size_t kTracks = 11, kKeys = 3;
        constexpr double kSeconds = 0.4;
        std::vector<Floats> rotations(kTracks), vectors(2);
        for (Floats& keys : rotations) {
            glm::quat q = rotation();
            for (std::size_t key = 0; key < kKeys; ++key) {
                for (std::size_t c = 0; c < 4; ++c) keys.push_back(number());
                keys.insert(keys.end(), {q.x, q.y, q.z, q.w});
                for (std::size_t c = 0; c < 4; ++c) keys.push_back(number());
                q = glm::normalize(q * glm::angleAxis(number(), glm::normalize(glm::vec3(1, number(), 0.5))));
            }
        }
        for (Floats& keys : vectors) {
            for (std::size_t k = 0; k < 9 * kKeys; ++k) keys.push_back(number());
        }
        std::vector<TrackGroup> groups = groups_of(rotations);
        std::vector<VectorTrack> moved{{vectors[0].data(), Blocks::place_of(0, 4)},
                                       {vectors[1].data(), Blocks::place_of(10, 7)}};
        for (const float at : {0.125f, 0.5f, 0.9f}) {
            const double u = at, v = 1.0 - u;
            // The same curve by Bernstein's polynomials: the tangents end a third of the interval from their keys.
            const auto spline = [&](const Floats& keys, std::size_t n, std::size_t c) {
                const float* const left = &keys[3 * n + n];
                const float* const right = &keys[6 * n + n];
                const double p0 = left[c], p3 = right[c];
                const double p1 = p0 + kSeconds / 3.0 * left[n + c];
                const double p2 = p3 - kSeconds / 3.0 * keys[6 * n + c];
                return v * v * v * p0 + 3.0 * v * v * u * p1 + 3.0 * v * u * u * p2 + u * u * u * p3;
            };
            Blocks local(kTracks, -9.0f);
            kernels_.sample_cubic(
                {groups.data(), 2, nullptr, 0, moved.data(), 2, 1, at, static_cast<float>(kSeconds), local.data()});
            for (std::size_t k = 0; k < kTracks; ++k) {
                const auto& keys = rotations[k];
                const glm::dquat q(spline(keys, 4, 3), spline(keys, 4, 0), spline(keys, 4, 1), spline(keys, 4, 2));
                note_rotation(errors_.sample, local.rotation_of(k), glm::normalize(q));
            }
            for (std::size_t k = 0; k < 2; ++k) {
                for (std::size_t c = 0; c < 3; ++c)
                    note(errors_.sample, local.data()[moved[k].place + c * kBlockJoints], spline(vectors[k], 3, c),
                         1.0);
            }
            note(errors_.sample, local.at(1, 7), -9.0, 1e-9);  // without a track
        }
    }

    /// Numbers of all magnitudes, the smallest and the largest among them.
    template <class T>
    std::vector<T> random_integers(std::size_t count) {
        std::vector<T> integers(count);
        for (T& each : integers) {
            each = static_cast<T>(random_() >> random_() % 32);
            if (random_() % 6 == 0)
                each = random_() % 2 == 0 ? std::numeric_limits<T>::min() : std::numeric_limits<T>::max();
        }
        return integers;
    }

    template <class T>
    void compare_decoding() {
        for (std::size_t count : {1u, 2u, 5u, 7u, 8u, 9u, 16u, 40u}) {
            compare_boxes<T>(count);
            if constexpr (sizeof(T) < 4) {
                for (const std::size_t width : {3u, 4u}) compare_displacing<T>(count, width);
            }
            if constexpr (std::is_signed_v<T>) {
                for (const std::size_t width : {2u, 3u}) compare_directions<T>(count, width);
            }
        }
    }

    template <class T>
    void compare_boxes(std::size_t count) {
        const std::vector<T> integers = random_integers<T>(3 * count);
        BoxedBlock block{{integers.data(), sizeof(T), std::is_signed_v<T>}, integers.size(), {}, {}, nullptr};
        for (std::size_t k = 0; k < BoxedBlock::kPattern; ++k) {
            block.minimum[k] = k < 3 ? number() : block.minimum[k - 3];
            block.step[k] = k < 3 ? std::ldexp(number(), -8 * static_cast<int>(sizeof(T))) : block.step[k - 3];
        }
        Floats decoded(integers.size() + 1, kOutside);
        block.to = decoded.data();
        kernels_.decode_boxed(block);
        for (std::size_t k = 0; k < integers.size(); ++k) {
            const double moved = double{block.step[k % 3]} * static_cast<double>(integers[k]);
            note(errors_.decode, decoded[k], block.minimum[k % 3] + moved,
                 std::abs(double{block.minimum[k % 3]}) + std::abs(moved));
        }
        note(errors_.decode, decoded.back(), kOutside, 1e-9);
    }

    /// Runs of 1, 2, 3, ... entries, with a vertex between them that stays.
    template <class T>
    void compare_displacing(std::size_t count, std::size_t width) {
        std::vector<MorphRun> runs;
        std::uint32_t entries = 0;
        std::uint32_t vertices = 1;
        for (std::uint32_t length = 1; entries < count; ++length) {
            const auto some = std::min(length, static_cast<std::uint32_t>(count) - entries);
            runs.push_back({entries, vertices, some});
            entries += some;
            vertices += some + 1;
        }
        const std::vector<T> integers = random_integers<T>(3 * count);
        Floats floats(3 * count), before(width * vertices);
        for (float& each : floats) each = number();
        for (float& each : before) each = number();
        DisplaceBlock block{runs.data(), runs.size(), number(), nullptr, width, nullptr, {}, {}, {}};
        block.integers = {integers.data(), sizeof(T), std::is_signed_v<T>};
        for (std::size_t c = 0; c < 3; ++c) {
            block.minimum[c] = number();
            block.step[c] = std::ldexp(number(), -8 * static_cast<int>(sizeof(T)));
        }
        for (const bool is_boxed : {false, true}) {
            Floats moved = before;
            block.to = moved.data();
            block.floats = is_boxed ? nullptr : floats.data();
            kernels_.displace(block);
            std::vector<double> expected(before.begin(), before.end()), size(before.size(), 1e-9);
            for (const auto& [entry, vertex, length] : runs) {
                for (std::size_t k = 0; k < std::size_t{length} * 3; ++k) {
                    const std::size_t from = std::size_t{entry} * 3 + k;
                    const std::size_t to = (vertex + k / 3) * width + k % 3;
                    const double least = is_boxed ? double{block.minimum[k % 3]} : 0.0;
                    const double more = is_boxed ? double{block.step[k % 3]} * static_cast<double>(integers[from])
                                                 : double{floats[from]};
                    expected[to] += block.weight * (least + more);
                    size[to] = std::abs(before[to]) + std::abs(block.weight) * (std::abs(least) + std::abs(more));
                }
            }
            for (std::size_t k = 0; k < moved.size(); ++k) note(errors_.decode, moved[k], expected[k], size[k]);
        }
    }

    template <class T>
    void compare_directions(std::size_t count, std::size_t width) {
        std::vector<T> integers = random_integers<T>(width * count);
        constexpr T kNone = std::numeric_limits<T>::min();
        if (count > 2) integers[width] = integers[width + 1] = kNone;
        Floats decoded((width + 1) * count + 1, kOutside);
        kernels_.decode_directions({{integers.data(), sizeof(T), true}, count, width, decoded.data()});
        for (std::size_t k = 0; k < count; ++k) {
            const T* const element = &integers[width * k];
            const auto normalised = [](T integer) {
                return std::max(double{static_cast<double>(integer)} / std::numeric_limits<T>::max(), -1.0);
            };
            const double a = normalised(element[0]), b = normalised(element[1]);
            glm::dvec3 expected(a, b, 1.0 - std::abs(a) - std::abs(b));
            if (expected.z < 0.0) {
                expected.x = (1.0 - std::abs(b)) * (a < 0.0 ? -1.0 : 1.0);
                expected.y = (1.0 - std::abs(a)) * (b < 0.0 ? -1.0 : 1.0);
            }
            expected = element[0] == kNone && element[1] == kNone ? glm::dvec3(0.0) : glm::normalize(expected);
            const float* const found = &decoded[(width + 1) * k];
            for (int c = 0; c < 3; ++c) note(errors_.decode, found[c], expected[c], 1.0);
            if (width == 3) note(errors_.decode, found[3], normalised(element[2]), 1.0);
        }
        note(errors_.decode, decoded.back(), kOutside, 1e-9);
    }

    void compare_blends(std::size_t joints) {
        const Blocks from = random_pose(joints), other = random_pose(joints);
        Floats mask(joints);
        for (float& each : mask) each = std::abs(number());
        for (const float* const weights :
             {static_cast<const float*>(mask.data()), static_cast<const float*>(nullptr)}) {
            Blocks mixed = from, added = from;
            kernels_.mix({joints, mixed.data(), other.data(), 0.75f, weights});
            kernels_.add({joints, added.data(), other.data(), 0.75f, weights});
            for (std::size_t k = 0; k < joints; ++k) {
                const double u = 0.75 * (weights == nullptr ? 1.0f : weights[k]);
                const glm::dquat a = from.rotation_of(k), b = other.rotation_of(k);
                note_rotation(errors_.mix, mixed.rotation_of(k), nlerp(a, b, u));
                note_rotation(errors_.add, added.rotation_of(k), a * nlerp(glm::dquat(1, 0, 0, 0), b, u));
                for (std::size_t c = 4; c < 10; ++c) {
                    const double to = from.at(k, c), by = other.at(k, c);
                    note(errors_.mix, mixed.at(k, c), (1.0 - u) * to + u * by, 1.3);
                    note(errors_.add, added.at(k, c), c < 7 ? to + u * by : to * (1.0 - u + u * by), 2.0);
                }
            }
            for (std::size_t k = joints; k % kBlockJoints != 0; ++k)
                note(errors_.mix, mixed.at(k, 4), kOutside, 1e-9);  // where no joint is
        }
    }
    static glm::dquat nlerp(const glm::dquat& a, const glm::dquat& b, double u) {
        const double dot = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
        return glm::normalize(a * (1.0 - u) + b * (dot < 0.0 ? -u : u));
    }

    /// One group of rotations and one of vectors, twelve bits a number, in two frames.
    void compare_unpacking(float angle, std::uint32_t tracks) {
        constexpr std::uint32_t kBits = 12;
        const float step = angle / 4096.0f;
        std::vector<UnpackGroup> groups(2);
        std::vector<UnpackPart> parts(2);
        std::vector<UnpackWindows> windows(6);
        // The tables, a frame, the next frame.
        const std::size_t size_of_tables = std::size_t{2} * 6 * tracks, size_of_frame = (6 * kBits * tracks + 7) / 8;
        std::vector<unsigned char> payload(size_of_tables + 2 * size_of_frame);
        unsigned char* const left = payload.data() + size_of_tables;
        unsigned char* const right = left + size_of_frame;
        std::array<std::array<std::array<std::int32_t, 8>, 6>, 2> numbers{};  // [frame][component][lane]
        std::uint32_t bit = 0;
        for (std::uint32_t component = 0; component < 6; ++component) {
            UnpackGroup& group = groups[component / 3];
            for (std::uint32_t lane = 0; lane < 8; ++lane) {
                const std::uint32_t width = lane < tracks ? kBits : 0;
                if (lane == 0) windows[component].low = bit / 8;
                if (lane == 4) windows[component].high = bit / 8;
                const std::uint32_t window = lane < 4 ? windows[component].low : windows[component].high;
                windows[component].bytes[lane] = static_cast<std::uint8_t>(bit / 8 - window);
                windows[component].left[lane] = static_cast<std::uint8_t>(32 - bit % 8 - width);
                windows[component].right[lane] = static_cast<std::uint8_t>(32 - width);
                const auto base = static_cast<std::int16_t>(number() * 3000.0f);
                if (lane < tracks) {
                    std::memcpy(&payload[2 * (component * tracks + lane)], &base, sizeof base);
                    numbers[0][component][lane] = base + put(left, bit);
                    numbers[1][component][lane] = base + put(right, bit);
                    group.steps[component % 3][lane] = step;
                }
                bit += width;
            }
        }
        for (std::uint32_t k = 0; k < 2; ++k) {
            UnpackGroup& group = groups[k];
            group.is_rotation = k == 0;
            group.count = tracks;
            group.parts = 1;
            parts[k].place = Blocks::place_of(0, k == 0 ? 0 : 4);
            group.bases = k * 3 * tracks * 2;
            group.stride = tracks * 2;
            for (std::uint32_t lane = 0; lane < 8; ++lane) {
                const std::uint32_t track = std::min(lane, tracks - 1);
                parts[k].lanes[lane] = static_cast<std::int32_t>(track);
                parts[k].has_track[lane] = lane < tracks ? kAllBits : 0;
                group.places[lane] = Blocks::place_of(track, k == 0 ? 0 : 4);
                const glm::quat q = rotation();
                for (int c = 0; c < 4; ++c) group.rest[c][lane] = q[c];
            }
        }
        for (const bool is_near_end : {true, false}) {
            if (!is_near_end) payload.resize(payload.size() + UnpackBlock::kReadPast);
            for (const float u : {0.0f, 0.3f, 0.9f}) {
                Blocks local(tracks);
                UnpackBlock block{};
                block.groups = groups.data();
                block.group_count = 2;
                block.parts = parts.data();
                block.windows = windows.data();
                block.tables = payload.data();
                block.left = payload.data() + size_of_tables;
                block.right = block.left + size_of_frame;
                block.end = payload.data() + payload.size();
                block.fraction = u;
                block.is_near_end = is_near_end;
                block.local = local.data();
                kernels_.unpack(block);
                for (std::uint32_t lane = 0; lane < tracks; ++lane) expect_unpacked(groups, numbers, lane, u, local);
            }
        }
    }
    std::int32_t put(unsigned char* frame, std::uint32_t bit) {
        const auto value = static_cast<std::uint32_t>(random_() % 4096);
        for (std::uint32_t k = 0; k < 12; ++k) {
            if ((value >> k & 1u) != 0) frame[(bit + k) / 8] |= static_cast<unsigned char>(1u << (bit + k) % 8);
        }
        return static_cast<std::int32_t>(value);
    }
    static glm::dquat exp(const glm::dvec3& v) {
        const double length = glm::length(v);
        if (length < 1e-9) return {1.0, v.x / 2, v.y / 2, v.z / 2};
        return {std::cos(length / 2), v * (std::sin(length / 2) / length)};
    }
    void expect_unpacked(const std::vector<UnpackGroup>& groups,
                         const std::array<std::array<std::array<std::int32_t, 8>, 6>, 2>& numbers, std::uint32_t lane,
                         double u, const Blocks& local) {
        std::array<std::array<glm::dvec3, 2>, 2> at{};  // [group][frame]
        for (std::size_t k = 0; k < 2; ++k) {
            for (std::size_t frame = 0; frame < 2; ++frame) {
                const auto value = [&](std::size_t c) {
                    return double{groups[k].steps[c][lane]} * numbers[frame][3 * k + c][lane];
                };
                at[k][frame] = {value(0), value(1), value(2)};
            }
        }
        const auto& rest = groups[0].rest;
        const glm::dquat q = glm::dquat(rest[3][lane], rest[0][lane], rest[1][lane], rest[2][lane]) *
                             slerp(exp(at[0][0]), exp(at[0][1]), u);
        note_rotation(errors_.unpack, local.rotation_of(lane), q);
        const glm::dvec3 moved = (1.0 - u) * at[1][0] + u * at[1][1];
        for (std::uint32_t c = 0; c < 3; ++c) {
            const double expected = groups[1].rest[c][lane] + moved[static_cast<int>(c)];
            note(errors_.unpack, local.at(lane, 4 + c), expected, 2.0 + std::abs(expected));
        }
    }

    const KernelTable& kernels_;
    std::mt19937 random_{12};
    std::uniform_real_distribution<float> numbers_{-1.0f, 1.0f};
    PoseErrors errors_;
};

}  // namespace bendy::test
