#include <bendy/runtime/morph_targets.h>

#include "runtime/build_model.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace bendy::morph_targets_test {
namespace {

using test::Owned;

constexpr glm::vec3 kUntouched(-77.0f);

/// Memory for posed vertices in which it can be seen what was written.
struct Memory {
    explicit Memory(std::size_t vertices)
        : positions(vertices, kUntouched), normals(vertices, kUntouched), tangents(vertices, glm::vec4(-77.0f)) {}

    [[nodiscard]] Vertices all() { return {positions, normals, tangents}; }
    [[nodiscard]] bool is_untouched() const {
        for (const glm::vec3& v : positions) {
            if (v != kUntouched) return false;
        }
        for (const glm::vec3& v : normals) {
            if (v != kUntouched) return false;
        }
        for (const glm::vec4& v : tangents) {
            if (v != glm::vec4(-77.0f)) return false;
        }
        return true;
    }

    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec4> tangents;
};

using Weights = std::vector<float>;

// The sample file's mesh 0 has a dense target, up by 1 to 4 along z with normals up along y, and a sparse one that
// moves vertex 1 by 9 along x and vertex 3 by 9 along y, with tangents along z.

TEST(MorphTargets, WithoutWeightTheVerticesAreTheMeshes) {
    const Owned model(test::sample_file());
    Memory memory(4);
    ASSERT_TRUE(apply_morph_targets(model->meshes()[0], Weights{0, 0}, memory.all()));
    EXPECT_EQ(memory.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
    EXPECT_EQ(memory.normals, std::vector<glm::vec3>(4, {0, 0, 1}));
    EXPECT_EQ(memory.tangents, (std::vector<glm::vec4>{{1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, -1}, {1, 0, 0, -1}}));
}

TEST(MorphTargets, DenseTargetsMoveEveryVertex) {
    const Owned model(test::sample_file());
    Memory memory(4);
    ASSERT_TRUE(apply_morph_targets(model->meshes()[0], Weights{0.5f, 0}, memory.all()));
    EXPECT_EQ(memory.positions, (std::vector<glm::vec3>{{0, 0, 0.5f}, {1, 0, 1}, {0, 1, 1.5f}, {1, 1, 2}}));
    EXPECT_EQ(memory.normals, std::vector<glm::vec3>(4, {0, 0.5f, 1}));
    EXPECT_EQ(memory.tangents[2], glm::vec4(1, 0, 0, -1));
}

TEST(MorphTargets, SparseTargetsMoveTheirVerticesOnly) {
    const Owned model(test::sample_file());
    Memory memory(4);
    ASSERT_TRUE(apply_morph_targets(model->meshes()[0], Weights{0, 2}, memory.all()));
    EXPECT_EQ(memory.positions, (std::vector<glm::vec3>{{0, 0, 0}, {19, 0, 0}, {0, 1, 0}, {1, 19, 0}}));
    EXPECT_EQ(memory.normals, std::vector<glm::vec3>(4, {0, 0, 1}));
    EXPECT_EQ(memory.tangents, (std::vector<glm::vec4>{{1, 0, 0, 1}, {1, 0, 18, 1}, {1, 0, 0, -1}, {1, 0, 16, -1}}));
}

TEST(MorphTargets, TargetsAddUpWithAnyWeights) {
    const Owned model(test::sample_file());
    Memory memory(4);
    ASSERT_TRUE(apply_morph_targets(model->meshes()[0], Weights{-1, 3}, memory.all()));
    EXPECT_EQ(memory.positions, (std::vector<glm::vec3>{{0, 0, -1}, {28, 0, -2}, {0, 1, -3}, {1, 28, -4}}));
    EXPECT_EQ(memory.normals[1], glm::vec3(0, -1, 1));
    EXPECT_EQ(memory.tangents[3], glm::vec4(1, 0, 24, -1));
}

TEST(MorphTargets, WhatIsNotWantedIsNotNeeded) {
    const Owned model(test::sample_file());
    const Mesh& mesh = model->meshes()[0];
    Memory memory(4);
    ASSERT_TRUE(apply_morph_targets(mesh, Weights{1, 1}, {memory.positions, {}, {}}));
    EXPECT_EQ(memory.positions[1], glm::vec3(10, 0, 2));
    EXPECT_EQ(memory.normals[1], kUntouched);
    ASSERT_TRUE(apply_morph_targets(mesh, Weights{1, 1}, {{}, memory.normals, {}}));
    EXPECT_EQ(memory.normals[1], glm::vec3(0, 1, 1));
    ASSERT_TRUE(apply_morph_targets(mesh, Weights{1, 1}, {{}, {}, memory.tangents}));
    EXPECT_EQ(memory.tangents[1], glm::vec4(1, 0, 9, 1));
    EXPECT_TRUE(apply_morph_targets(mesh, Weights{1, 1}, {}));
}

TEST(MorphTargets, StreamsThatTheMeshLacksComeOutAsZeros) {
    const Owned model(test::sample_file());
    Memory memory(6);
    ASSERT_TRUE(apply_morph_targets(model->meshes()[1], {}, memory.all()));
    EXPECT_EQ(memory.positions[5], glm::vec3(2, 2, 2));
    EXPECT_EQ(memory.normals, std::vector<glm::vec3>(6, glm::vec3(0.0f)));
    EXPECT_EQ(memory.tangents, std::vector<glm::vec4>(6, glm::vec4(0.0f)));
}

TEST(MorphTargets, ATargetsNormalsCannotMoveThoseThatTheMeshLacks) {
    test::ModelSpec spec;
    spec.meshes.resize(1);
    spec.meshes[0].positions.resize(2);
    spec.meshes[0].more = {test::make_container(
        FourCC("TARG"), {test::make_leaf(FourCC("TINF"), bytes_of(MorphTargetRecord{})),
                         test::vector_stream(FourCC("NORM"), std::vector<glm::vec3>(2, {1, 0, 0})),
                         test::vector_stream(FourCC("TANG"), std::vector<glm::vec3>(2, {1, 0, 0}))})};
    const Owned model(test::build_file(spec));
    Memory memory(2);
    ASSERT_TRUE(apply_morph_targets(model->meshes()[0], Weights{1}, memory.all()));
    EXPECT_EQ(memory.normals[1], glm::vec3(0.0f));
    EXPECT_EQ(memory.tangents[1], glm::vec4(0.0f));
}

TEST(MorphTargets, TargetsMayLackAnyStream) {
    test::ModelSpec spec;
    spec.meshes.resize(1);
    spec.meshes[0].positions.resize(2);
    spec.meshes[0].normals.resize(2, {0, 0, 1});
    const test::Node info = test::make_leaf(FourCC("TINF"), bytes_of(MorphTargetRecord{}));
    spec.meshes[0].more = {
        test::make_container(FourCC("TARG"), {info}),
        test::make_container(FourCC("TARG"),
                             {info, test::vector_stream(FourCC("NORM"), std::vector<glm::vec3>(2, {1, 0, 0}))}),
        test::make_container(FourCC("TARG"),
                             {info, test::make_leaf(FourCC("INDX"), test::stream_payload<std::uint32_t>(1, {}))}),
    };
    const Owned model(test::build_file(spec));
    Memory memory(2);
    ASSERT_TRUE(apply_morph_targets(model->meshes()[0], Weights{1, 2, 3}, memory.all()));
    EXPECT_EQ(memory.positions[1], glm::vec3(0.0f));
    EXPECT_EQ(memory.normals[1], glm::vec3(2, 0, 1));
}

TEST(MorphTargets, SpansThatAreTooShortAreRefusedAndNothingIsWritten) {
    const Owned model(test::sample_file());
    const Mesh& mesh = model->meshes()[0];
    Memory memory(4);
    const auto shortened = [](auto& vectors) { return std::span(vectors).first(3); };
    EXPECT_FALSE(
        apply_morph_targets(mesh, Weights{1, 1}, {shortened(memory.positions), memory.normals, memory.tangents}));
    EXPECT_FALSE(
        apply_morph_targets(mesh, Weights{1, 1}, {memory.positions, shortened(memory.normals), memory.tangents}));
    EXPECT_FALSE(
        apply_morph_targets(mesh, Weights{1, 1}, {memory.positions, memory.normals, shortened(memory.tangents)}));
    EXPECT_FALSE(apply_morph_targets(mesh, Weights{1}, memory.all()));
    EXPECT_FALSE(apply_morph_targets(mesh, {}, memory.all()));
    EXPECT_TRUE(memory.is_untouched());
}

TEST(MorphTargets, FirstVerticesTakeNothingOfTheOthers) {
    const Owned model(test::sample_file());
    Memory memory(4);
    ASSERT_TRUE(
        apply_morph_targets(model->meshes()[0], Weights{0, 1}, 3, memory.all()));  // the sparse target moves 1 and 3
    EXPECT_EQ(memory.positions, (std::vector<glm::vec3>{{0, 0, 0}, {10, 0, 0}, {0, 1, 0}, kUntouched}));
}

TEST(MorphTargets, LongerSpansKeepWhatIsBehindTheVertices) {
    const Owned model(test::sample_file());
    Memory memory(6);
    ASSERT_TRUE(apply_morph_targets(model->meshes()[0], Weights{1, 1, 5, 5}, memory.all()));
    EXPECT_EQ(memory.positions[3], glm::vec3(1, 10, 4));
    for (std::size_t v = 4; v < 6; ++v) {
        EXPECT_EQ(memory.positions[v], kUntouched);
        EXPECT_EQ(memory.normals[v], kUntouched);
        EXPECT_EQ(memory.tangents[v], glm::vec4(-77.0f));
    }
}

}  // namespace
}  // namespace bendy::morph_targets_test
