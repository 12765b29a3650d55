#include "optimise/compact/compact_targets.h"

#include <gtest/gtest.h>
#include <glm/ext/vector_double3.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace bendy::converter::compact_targets_test {
namespace {

constexpr std::uint32_t kTargets = 24;
constexpr std::uint32_t kVertices = 24 * 8;
constexpr std::size_t kKeys = 100;
constexpr double kBound = 1e-4;

/// A face whose clip drives all targets at once.
/// \param apart  each target moves vertices of its own
Scene talking_face(bool apart, float heaviest, Interpolation interpolation = Interpolation::linear) {
    std::mt19937 random(7);
    const auto fraction = [&] { return static_cast<float>(random() % 10001) / 10000.0f; };
    Scene scene;
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.positions.resize(kVertices);
    for (std::uint32_t t = 0; t < kTargets; ++t) {
        MorphTarget& target = mesh.targets.emplace_back();
        target.positions.resize(kVertices);
        for (std::uint32_t v = 0; v < kVertices; ++v) {
            if (apart && v % kTargets != t) continue;
            target.positions[v] = {0.05f * fraction(), 0.05f * fraction(), 0.05f * fraction()};
        }
    }
    Track& track = scene.clips.emplace_back().tracks.emplace_back();
    track.path = TrackPath::weights;
    track.interpolation = interpolation;
    track.target = 0;
    track.components = kTargets;
    const bool is_cubic = interpolation == Interpolation::cubic;
    for (std::size_t k = 0; k < kKeys; ++k) {
        track.times.push_back(static_cast<float>(k) / 30.0f);
        if (is_cubic) track.values.insert(track.values.end(), kTargets, 100.0f);  // tangents are not weights
        for (std::uint32_t t = 0; t < kTargets; ++t) track.values.push_back(heaviest * fraction());
        if (is_cubic) track.values.insert(track.values.end(), kTargets, -100.0f);
    }
    return scene;
}

CompactMesh compacted(Scene& scene) {
    CompactMesh compact;
    compact.targets.resize(scene.meshes[0].targets.size());
    compact_targets(scene, 0, compact, kBound);
    return compact;
}

/// The farthest that a vertex is off at the weights of any key, in doubles.
double farthest(const Scene& exact, const Scene& scene) {
    const Track& track = exact.clips[0].tracks[0];
    const std::size_t row = track.values.size() / kKeys;
    const std::size_t first = row == kTargets ? 0 : kTargets;
    double farthest = 0.0;
    for (std::size_t k = 0; k < kKeys; ++k) {
        for (std::uint32_t v = 0; v < kVertices; ++v) {
            glm::dvec3 off(0.0);
            for (std::uint32_t t = 0; t < kTargets; ++t) {
                const double weight = track.values[k * row + first + t];
                off += weight * (glm::dvec3(scene.meshes[0].targets[t].positions[v]) -
                                 glm::dvec3(exact.meshes[0].targets[t].positions[v]));
            }
            farthest = std::max(farthest, glm::length(off));
        }
    }
    return farthest;
}

double step_of(const CompactMesh& compact) {
    return double{compact.targets[0].positions->boxes[0].step};
}

TEST(CompactTargets, TargetsThatShareNoVertexShareNoBound) {
    Scene scene = talking_face(true, 1.0f);
    const Scene exact = scene;
    const CompactMesh compact = compacted(scene);
    EXPECT_GT(step_of(compact), kBound);  // as for one target: 2 / sqrt(3) of the bound
    EXPECT_LE(farthest(exact, scene), kBound);
}

TEST(CompactTargets, TogetherTheyStayWithinTheBoundAtEveryKey) {
    for (const float heaviest : {0.2f, 1.0f, 5.0f}) {
        for (const Interpolation interpolation : {Interpolation::linear, Interpolation::cubic}) {
            Scene scene = talking_face(false, heaviest, interpolation);
            const Scene exact = scene;
            const CompactMesh compact = compacted(scene);
            EXPECT_LE(farthest(exact, scene), kBound);
            // The errors of a vertex seldom point the same way: the step is coarser than their sum allows.
            EXPECT_GT(step_of(compact), 2.0 * kBound / (heaviest * kTargets));
        }
    }
}

TEST(CompactTargets, EachAloneStaysWithinTheBound) {
    Scene scene = talking_face(false, 0.0f);
    const Scene exact = scene;
    compacted(scene);
    for (std::uint32_t t = 0; t < kTargets; ++t) {
        for (std::uint32_t v = 0; v < kVertices; ++v) {
            EXPECT_LE(glm::length(glm::dvec3(scene.meshes[0].targets[t].positions[v]) -
                                  glm::dvec3(exact.meshes[0].targets[t].positions[v])),
                      kBound);
        }
    }
}

TEST(CompactTargets, WeightsThatNoStepServesLeaveTheNumbersExact) {
    Scene scene = talking_face(false, 1e30f);
    const Scene exact = scene;
    const CompactMesh compact = compacted(scene);
    for (std::uint32_t t = 0; t < kTargets; ++t) {
        EXPECT_FALSE(compact.targets[t].positions);
        EXPECT_EQ(scene.meshes[0].targets[t].positions, exact.meshes[0].targets[t].positions);
    }
}

TEST(CompactTargets, RestWeightsCount) {
    Scene scene = talking_face(false, 0.0f);
    for (MorphTarget& target : scene.meshes[0].targets) target.rest_weight = 1.0f;
    const Scene exact = scene;
    compacted(scene);
    for (std::uint32_t v = 0; v < kVertices; ++v) {
        glm::dvec3 off(0.0);
        for (std::uint32_t t = 0; t < kTargets; ++t)
            off += glm::dvec3(scene.meshes[0].targets[t].positions[v]) -
                   glm::dvec3(exact.meshes[0].targets[t].positions[v]);
        EXPECT_LE(glm::length(off), kBound);
    }
}

}  // namespace
}  // namespace bendy::converter::compact_targets_test
