#include <bendy/runtime/skin.h>

#include <bendy/runtime/sample.h>

#include "pose/pose_state.h"
#include "runtime/build_model.h"
#include "runtime/local_joints.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace bendy::skin_test {
namespace {

using test::Owned;

constexpr glm::vec3 kUntouched(-77.0f);

struct Posed {
    explicit Posed(std::size_t vertices)
        : positions(vertices, kUntouched), normals(vertices, kUntouched), tangents(vertices, glm::vec4(-77.0f)) {}
    /// The mesh in this pose.
    Posed(const Model& model, std::uint32_t mesh, Pose& pose) : Posed(model.meshes()[mesh].vertices) {
        EXPECT_TRUE(skin(pose, {.mesh = mesh, .out = all()}));
    }

    [[nodiscard]] Vertices all() { return {positions, normals, tangents}; }

    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec4> tangents;
};

void expect_near(const glm::vec3& vector, const glm::dvec3& expected, double tolerance = 1e-6) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(vector[c], expected[c], tolerance) << "component " << c;
}

/// A skinned mesh: each vertex has `influences` bones out of `palette`.
template <class Bone, class Weight>
test::MeshSpec skinned(const std::vector<glm::vec3>& positions, std::uint16_t influences,
                       const std::vector<Bone>& bones, const std::vector<Weight>& weights, const test::Node& palette) {
    test::MeshSpec mesh;
    mesh.positions = positions;
    mesh.more = {test::make_leaf(FourCC("BONE"), test::stream_payload<Bone>(influences, bones)),
                 test::make_leaf(FourCC("WGHT"),
                                 test::stream_payload<Weight>(influences, weights, !std::is_same_v<Weight, float>)),
                 palette};
    return mesh;
}

// --- by hand

TEST(Skin, AVertexFollowsItsBonesByTheirWeights) {
    // Two joints at the origin; joint 1 is moved up by 8. Three quarters of that reach the vertex.
    test::ModelSpec spec;
    spec.joints.resize(2);
    spec.joints[1].parent = 0;
    spec.meshes = {skinned<std::uint8_t, float>({{1, 2, 3}}, 2, {0, 1}, {0.25f, 0.75f},
                                                test::palette_leaf({0, 1}, {glm::mat4(1.0f), glm::mat4(1.0f)}))};
    const Owned model(test::build_file(spec));
    Pose pose(*model);
    EXPECT_EQ(Posed(*model, 0, pose).positions[0], glm::vec3(1, 2, 3));
    test::local_of(pose, 1)->translation = {0, 8, 0};
    EXPECT_EQ(Posed(*model, 0, pose).positions[0], glm::vec3(1, 8, 3));
}

TEST(Skin, PaletteEntriesNameJointsAndBringTheirInverseBind) {
    // Bone 0 is joint 1, whose matrices cancel; bone 1 is joint 0, whose inverse bind matrix doubles.
    glm::mat4 down(1.0f);
    down[3] = {0, -5, 0, 1};
    glm::mat4 twice(2.0f);
    twice[3][3] = 1.0f;
    test::ModelSpec spec;
    spec.joints.resize(2);
    spec.joints[1] = {0, test::moved(0, 5, 0), {}, ""};
    spec.meshes = {skinned<std::uint8_t, float>({{1, 2, 3}, {1, 2, 3}}, 1, {0, 1}, {1, 1},
                                                test::palette_leaf({1, 0}, {down, twice}))};
    const Owned model(test::build_file(spec));
    Pose pose(*model);
    const Posed posed(*model, 0, pose);
    EXPECT_EQ(posed.positions[0], glm::vec3(1, 2, 3));
    EXPECT_EQ(posed.positions[1], glm::vec3(2, 4, 6));
}

TEST(Skin, TheSamplesVerticesByHand) {
    // Joints 0 and 1 stand at y = 1 and 1.5; their inverse bind matrices go down by 0 and 1. The first target weighs
    // 1/8.
    const Owned model(test::sample_file());
    Pose pose(*model);
    const Posed posed(*model, 0, pose);
    EXPECT_EQ(posed.positions[0], glm::vec3(0, 1, 0.125f));
    EXPECT_EQ(posed.positions[1], glm::vec3(1, 0.75f + 0.125f, 0.25f));
    EXPECT_EQ(posed.positions[2], glm::vec3(0, 1 + 0.5f * 1 + 0.5f * 0.5f, 0.375f));
    EXPECT_EQ(posed.positions[3], glm::vec3(1, 1 + 0.5f, 0.5f));
    expect_near(posed.normals[0], glm::dvec3(0, 0.125, 1) / std::sqrt(1.0 + 1.0 / 64.0));
    EXPECT_EQ(posed.tangents[2], glm::vec4(1, 0, 0, -1));

    ASSERT_TRUE(
        sample(pose, model->clip("run"), 1.0f));  // hip to (3, 3, 3), spine turned half round z, weights 1 and 1/4
    const Posed ran(*model, 0, pose);
    expect_near(ran.positions[0], {3, 3, 4});
    // Vertex 1 at (1 + 9/4, 0, 2): joint 0 takes it to (6.25, 3, 5), joint 1 to (3 - 3.25, 3.5 + 1, 5).
    expect_near(ran.positions[1], glm::dvec3(0.75 * 6.25 + 0.25 * -0.25, 0.75 * 3 + 0.25 * 4.5, 5));
}

TEST(Skin, TakesAStalePoseUpToDate) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    test::local_of(pose, 0)->translation = {100, 0, 0};
    EXPECT_EQ(Posed(*model, 1, pose).positions[0], glm::vec3(100, 0.75f, 0));
    EXPECT_TRUE(PoseState::of(pose).stale.is_empty());
}

TEST(Skin, LargeTranslationsCancel) {
    // A character far from the origin, bound where it stands: in floats, its vertices would lose all below a
    // centimetre.
    constexpr float kFar = 123'456.7f;
    glm::mat4 back(1.0f);
    back[3] = {-kFar, -kFar, -kFar, 1};
    test::ModelSpec spec;
    spec.joints.resize(2);
    spec.joints[0].rest = test::turned(40, 1);
    spec.joints[1] = {0, test::moved(kFar, kFar, kFar), {}, ""};
    spec.meshes = {
        skinned<std::uint8_t, float>({{0.125f, 0.001f, -0.3f}}, 1, {0}, {1}, test::palette_leaf({1}, {back}))};
    const Owned model(test::build_file(spec));
    Pose pose(*model);
    const double angle = 40.0 * M_PI / 180.0;
    const glm::dvec3 p(0.125, 0.001, -0.3);
    expect_near(Posed(*model, 0, pose).positions[0],
                {std::cos(angle) * p.x + std::sin(angle) * p.z, p.y, -std::sin(angle) * p.x + std::cos(angle) * p.z},
                1e-6);
}

TEST(Skin, MeshesOfOnePaletteAndOfOthersEachFollowTheirOwn) {
    glm::mat4 back(1.0f);
    back[3] = {-1, 0, 0, 1};
    test::ModelSpec spec;
    spec.joints.resize(2);
    spec.joints[0].rest = test::moved(1, 0, 0);
    spec.joints[1] = {0, test::moved(0, 5, 0), {}, ""};
    const auto mesh = [&](std::uint32_t joint, const glm::mat4& bind) {
        return skinned<std::uint8_t, float>({{1, 2, 3}}, 1, {0}, {1}, test::palette_leaf({joint}, {bind}));
    };
    const glm::mat4 none(1.0f);
    spec.meshes = {mesh(0, none), mesh(0, none), mesh(1, none), mesh(1, back), mesh(1, back), mesh(0, none)};
    const Owned model(test::build_file(spec));
    Pose pose(*model);
    const std::vector<glm::vec3> expected{{2, 2, 3}, {2, 2, 3}, {2, 7, 3}, {1, 7, 3}, {1, 7, 3}, {2, 2, 3}};
    for (const std::uint32_t number : {0u, 1u, 2u, 3u, 4u, 5u, 1u, 4u, 0u, 3u})
        EXPECT_EQ(Posed(*model, number, pose).positions[0], expected[number]) << number;
    test::local_of(pose, 0)->translation.x = 11.0f;
    for (const std::uint32_t number : {4u, 1u})
        EXPECT_EQ(Posed(*model, number, pose).positions[0], expected[number] + glm::vec3(10, 0, 0)) << number;
}

// --- against the plain formula

/// Random numbers for a mesh with many influences.
class ManyInfluences {
public:
    static constexpr std::uint32_t kVertices = 40;
    static constexpr std::uint16_t kInfluences = 8;
    static constexpr std::uint32_t kJoints = 9;
    static constexpr std::uint32_t kPalette = 6;

    explicit ManyInfluences(unsigned seed) : random_(seed) {
        spec.joints.resize(kJoints);
        for (std::uint32_t joint = 0; joint < kJoints; ++joint) {
            spec.joints[joint].parent = joint % 3 == 0 ? kNone : joint - 1;
            RestRecord& rest = spec.joints[joint].rest;
            const glm::quat turn = glm::normalize(glm::quat(number(), number(), number(), number()));
            rest.rotation = {turn.x, turn.y, turn.z, turn.w};
            rest.translation = {number(), number(), number()};
            rest.scale = {1.0f + 0.3f * number(), 1.0f + 0.3f * number(), 1.0f + 0.3f * number()};
            rest.shear = {0.2f * number(), 0.0f, 0.1f * number()};
        }
        for (std::uint32_t entry = 0; entry < kPalette; ++entry) {
            joints.push_back((entry * 4 + 1) % kJoints);
            glm::mat4 matrix(1.0f);
            for (int column = 0; column < 4; ++column) {
                for (int row = 0; row < 3; ++row) matrix[column][row] += 0.3f * number();
            }
            inverse_bind.push_back(matrix);
        }
        for (std::uint32_t vertex = 0; vertex < kVertices; ++vertex) {
            positions.emplace_back(number(), number(), number());
            normals.push_back(glm::normalize(glm::vec3(number(), number(), number())));
            tangents.emplace_back(glm::normalize(glm::cross(normals.back(), glm::vec3(number(), number(), number()))),
                                  vertex % 2 == 0 ? 1.0f : -1.0f);
            for (std::uint32_t k = 0; k < kInfluences; ++k) bones.push_back(below(kPalette));
        }
    }

    /// Weights in `steps` whole parts of 1.
    template <class Weight>
    std::vector<Weight> integer_weights(std::uint32_t steps) {
        std::vector<Weight> weights;
        for (std::uint32_t vertex = 0; vertex < kVertices; ++vertex) {
            std::uint32_t left = steps;
            for (std::uint32_t k = 0; k < kInfluences; ++k) {
                const std::uint32_t share = k + 1 == kInfluences ? left : below(left / 2 + 1);
                weights.push_back(static_cast<Weight>(share));
                left -= share;
            }
        }
        return weights;
    }

    float number() { return std::uniform_real_distribution<float>(-1.0f, 1.0f)(random_); }

    /// Poses the mesh and holds every vertex against sum(w_i J_i B_i v).
    void check(const std::vector<double>& weights) const {
        const Owned model(test::build_file(spec));
        Pose pose(*model);
        const Posed posed(*model, 0, pose);
        for (std::uint32_t vertex = 0; vertex < kVertices; ++vertex) {
            glm::dvec3 position(0.0);
            glm::dmat3 linear(0.0);
            for (std::uint32_t k = 0; k < kInfluences; ++k) {
                const std::size_t at = std::size_t{vertex} * kInfluences + k;
                const glm::dmat4 joint(pose.model_space()[joints[bones[at]]]);
                const glm::dmat4 bind(inverse_bind[bones[at]]);
                position += weights[at] * glm::dvec3(joint * (bind * glm::dvec4(glm::dvec3(positions[vertex]), 1.0)));
                linear += weights[at] * glm::dmat3(joint) * glm::dmat3(bind);
            }
            expect_near(posed.positions[vertex], position, 2e-5);
            const glm::dvec3 normal =
                glm::normalize(glm::transpose(glm::inverse(linear)) * glm::dvec3(normals[vertex]));
            if (std::abs(glm::determinant(linear)) > 0.05) expect_near(posed.normals[vertex], normal, 1e-4);
            const glm::dvec3 tangent = glm::normalize(linear * glm::dvec3(glm::vec3(tangents[vertex])));
            expect_near(glm::vec3(posed.tangents[vertex]), tangent, 1e-4);
            EXPECT_EQ(posed.tangents[vertex].w,
                      glm::determinant(linear) < 0.0 ? -tangents[vertex].w : tangents[vertex].w);
        }
    }

    template <class Bone, class Weight>
    void add_mesh(const std::vector<Weight>& weights) {
        spec.meshes = {skinned<Bone, Weight>(positions, kInfluences, std::vector<Bone>(bones.begin(), bones.end()),
                                             weights, test::palette_leaf(joints, inverse_bind))};
        spec.meshes[0].normals = normals;
        spec.meshes[0].tangents = tangents;
    }

    test::ModelSpec spec;
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec4> tangents;
    std::vector<std::uint32_t> joints, bones;
    std::vector<glm::mat4> inverse_bind;

private:
    std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random_() % count); }

    std::mt19937 random_;
};

template <class Bone, class Weight>
void check_types(std::uint32_t steps) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
        ManyInfluences mesh(seed);
        const auto weights = mesh.integer_weights<std::uint16_t>(steps);
        std::vector<double> exact;
        std::vector<Weight> stored;
        for (const std::uint16_t weight : weights) {
            exact.push_back(static_cast<double>(weight) / steps);
            stored.push_back(std::is_same_v<Weight, float> ? static_cast<Weight>(exact.back())
                                                           : static_cast<Weight>(weight));
        }
        mesh.add_mesh<Bone, Weight>(stored);
        mesh.check(exact);
    }
}

TEST(Skin, EightInfluencesWithByteBonesAndByteWeights) {
    check_types<std::uint8_t, std::uint8_t>(255);
}
TEST(Skin, EightInfluencesWithByteBonesAndShortWeights) {
    check_types<std::uint8_t, std::uint16_t>(65535);
}
TEST(Skin, EightInfluencesWithShortBonesAndByteWeights) {
    check_types<std::uint16_t, std::uint8_t>(255);
}
TEST(Skin, EightInfluencesWithShortBonesAndFloatWeights) {
    check_types<std::uint16_t, float>(1024);
}

TEST(Skin, MoreInfluencesThanAnyoneNeeds) {
    // 300 bones, each moves the vertex by its own number along x: the mean of 0 .. 299.
    constexpr std::uint16_t kBones = 300;
    test::ModelSpec spec;
    std::vector<std::uint32_t> joints(kBones);
    std::vector<std::uint16_t> bones(kBones);
    for (std::uint16_t joint = 0; joint < kBones; ++joint) {
        spec.joints.push_back({kNone, test::moved(joint, 0, 0), {}, ""});
        joints[joint] = bones[joint] = joint;
    }
    spec.meshes = {
        skinned<std::uint16_t, float>({{0, 1, 0}}, kBones, bones, std::vector<float>(kBones, 1.0f / kBones),
                                      test::palette_leaf(joints, std::vector<glm::mat4>(kBones, glm::mat4(1.0f))))};
    const Owned model(test::build_file(spec));
    Pose pose(*model);
    expect_near(Posed(*model, 0, pose).positions[0], {149.5, 1, 0}, 1e-3);
}

// --- normals, tangents, mirrors, degenerate matrices

/// A rigid mesh of one vertex on a joint.
test::ModelSpec one_vertex(const RestRecord& rest, const glm::vec3& normal, const glm::vec4& tangent) {
    test::ModelSpec spec;
    spec.joints.resize(1);
    spec.joints[0].rest = rest;
    spec.meshes.resize(1);
    spec.meshes[0].joint = 0;
    spec.meshes[0].positions = {{1, 1, 1}};
    spec.meshes[0].normals = {normal};
    spec.meshes[0].tangents = {tangent};
    return spec;
}

Posed pose_of(const test::ModelSpec& spec) {
    const Owned model(test::build_file(spec));
    Pose pose(*model);
    return {*model, 0, pose};
}

TEST(Skin, NormalsStayPerpendicularWhereTheSurfaceIsStretched) {
    const float half = std::sqrt(0.5f);
    const Posed posed = pose_of(one_vertex(test::scaled(2, 1, 1), {half, half, 0}, {half, -half, 0, 1}));
    expect_near(posed.normals[0], glm::dvec3(1, 2, 0) / std::sqrt(5.0));
    expect_near(glm::vec3(posed.tangents[0]), glm::dvec3(2, -1, 0) / std::sqrt(5.0));
    EXPECT_EQ(posed.tangents[0].w, 1.0f);
}

TEST(Skin, AMirrorTurnsTheHandednessAndKeepsNormalsOutside) {
    const Posed x = pose_of(one_vertex(test::scaled(-1, 1, 1), {1, 0, 0}, {0, 1, 0, 1}));
    EXPECT_EQ(x.positions[0], glm::vec3(-1, 1, 1));
    EXPECT_EQ(x.normals[0], glm::vec3(-1, 0, 0));
    EXPECT_EQ(x.tangents[0], glm::vec4(0, 1, 0, -1));
    const Posed flat = pose_of(one_vertex(test::scaled(-1, 1, 1), {0, 0, 1}, {1, 0, 0, -1}));
    EXPECT_EQ(flat.normals[0], glm::vec3(0, 0, 1));
    EXPECT_EQ(flat.tangents[0], glm::vec4(-1, 0, 0, 1));
    const Posed twice =
        pose_of(one_vertex(test::scaled(-1, -1, 1), {1, 0, 0}, {0, 1, 0, 1}));  // a half turn, no mirror
    EXPECT_EQ(twice.normals[0], glm::vec3(-1, 0, 0));
    EXPECT_EQ(twice.tangents[0], glm::vec4(0, -1, 0, 1));
    const Posed all = pose_of(one_vertex(test::scaled(-1, -1, -1), {1, 0, 0}, {0, 1, 0, -1}));
    EXPECT_EQ(all.normals[0], glm::vec3(-1, 0, 0));
    EXPECT_EQ(all.tangents[0], glm::vec4(0, -1, 0, 1));
}

TEST(Skin, TheBitangentMovesWithTheSurface) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> number(-2.0f, 2.0f);
    for (int round = 0; round < 200; ++round) {
        RestRecord rest;
        rest.scale = {number(random), number(random), number(random)};
        const double volume = double{rest.scale[0]} * rest.scale[1] * rest.scale[2];
        if (std::abs(volume) < 0.1) continue;
        const glm::quat turn =
            glm::normalize(glm::quat(number(random), number(random), number(random), number(random)));
        rest.rotation = {turn.x, turn.y, turn.z, turn.w};
        const glm::vec3 normal = glm::normalize(glm::vec3(number(random), number(random), number(random)));
        const glm::vec3 tangent =
            glm::normalize(glm::cross(normal, glm::vec3(number(random), number(random), number(random))));
        const float handedness = round % 2 == 0 ? 1.0f : -1.0f;
        const glm::vec3 bitangent = handedness * glm::cross(normal, tangent);

        const Posed posed = pose_of(one_vertex(rest, normal, glm::vec4(tangent, handedness)));
        const glm::vec3 turned = turn * (glm::vec3(rest.scale[0], rest.scale[1], rest.scale[2]) * bitangent);
        const glm::vec3 found = posed.tangents[0].w * glm::cross(posed.normals[0], glm::vec3(posed.tangents[0]));
        EXPECT_GT(glm::dot(found, turned), 0.0f) << round;
        EXPECT_NEAR(glm::dot(posed.normals[0], turned), 0.0f, 1e-5) << round;
        EXPECT_NEAR(glm::dot(posed.normals[0], glm::vec3(posed.tangents[0])), 0.0f, 1e-5) << round;
        EXPECT_NEAR(glm::length(posed.normals[0]), 1.0f, 1e-5);
        // The outside stays the outside.
        const glm::vec3 outwards = turn * (glm::vec3(rest.scale[0], rest.scale[1], rest.scale[2]) * normal);
        EXPECT_GT(glm::dot(posed.normals[0], outwards), 0.0f) << round;
    }
}

TEST(Skin, WithoutVolumeThereIsNoNan) {
    const auto is_number = [](const auto& v) {
        for (int c = 0; c < v.length(); ++c) {
            if (!std::isfinite(v[c])) return false;
        }
        return true;
    };
    for (const RestRecord& rest :
         {test::scaled(0, 0, 0), test::scaled(0, 1, 1), test::scaled(1, 0, 1), test::scaled(1, 1, 0),
          test::scaled(0, 0, 1), test::scaled(-1, 0, 1), test::scaled(1e-30f, 1e-30f, 1e-30f)}) {
        for (const glm::vec3 normal : {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1), glm::vec3(0.0f)}) {
            const Posed posed = pose_of(one_vertex(rest, normal, glm::vec4(normal, 1.0f)));
            EXPECT_TRUE(is_number(posed.positions[0]) && is_number(posed.normals[0]) && is_number(posed.tangents[0]));
        }
    }
    // Flattened along z, the surface still faces z.
    EXPECT_EQ(pose_of(one_vertex(test::scaled(3, 2, 0), {0, 0, 1}, {1, 0, 0, 1})).normals[0], glm::vec3(0, 0, 1));
}

TEST(Skin, SmallAndLargeScalesKeepNormals) {
    for (const float scale : {1e-9f, 1e-6f, 0.01f, 100.0f, 1e6f, 1e9f}) {
        const Posed posed = pose_of(one_vertex(test::scaled(scale, scale, -scale), {0.6f, 0.8f, 0}, {0, 0, 1, 1}));
        expect_near(posed.normals[0], {0.6, 0.8, 0}, 1e-5);
        expect_near(glm::vec3(posed.tangents[0]), {0, 0, -1}, 1e-5);
        EXPECT_EQ(posed.tangents[0].w, -1.0f) << scale;
    }
}

TEST(Skin, WeightsThatCancelGiveNoNan) {
    // Two bones that look in opposite directions, half each: the blended matrix has no volume.
    test::ModelSpec spec;
    spec.joints.resize(2);
    spec.joints[1].rest = test::scaled(-1, -1, -1);
    spec.meshes = {skinned<std::uint8_t, float>({{1, 2, 3}}, 2, {0, 1}, {0.5f, 0.5f},
                                                test::palette_leaf({0, 1}, {glm::mat4(1.0f), glm::mat4(1.0f)}))};
    spec.meshes[0].normals = {{0, 0, 1}};
    spec.meshes[0].tangents = {{1, 0, 0, 1}};
    const Posed posed = pose_of(spec);
    EXPECT_EQ(posed.positions[0], glm::vec3(0.0f));
    EXPECT_EQ(posed.normals[0], glm::vec3(0.0f));
    EXPECT_EQ(glm::vec3(posed.tangents[0]), glm::vec3(0.0f));
}

// --- morph targets

TEST(Skin, AppliesMorphTargetsBeforeItSkins) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    test::local_of(pose, 0)->rotation = glm::quat(0, 0, 0, 1);  // half round z: x and y change signs
    pose.change_morph_weights()[0] = 0.0f;
    pose.change_morph_weights()[1] = 1.0f;
    const Posed posed(*model, 0, pose);
    expect_near(posed.positions[3], {-1, 1 - 0.5 + 1 - 10, 0});  // (1, 10, 0), wholly on joint 1
    EXPECT_EQ(posed.positions[0], glm::vec3(0, 1, 0));
    expect_near(glm::vec3(posed.tangents[1]), glm::dvec3(-1, 0, 9) / std::sqrt(82.0));
    EXPECT_EQ(posed.tangents[3].w, -1.0f);
}

// --- rigid meshes

TEST(Skin, ARigidMeshMovesWithItsJoint) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    const Posed posed(*model, 1, pose);
    EXPECT_EQ(posed.positions[1], glm::vec3(1, 1.75f, 0));  // joint 2
    EXPECT_EQ(posed.positions[5], glm::vec3(2, 3.5f, 2));   // a point that joint 1 moves
    EXPECT_EQ(posed.normals[0], glm::vec3(0.0f));           // the mesh has none
}

/// Three joints at x = 1, 2 and 3; a rigid mesh of joint 0 with vertices of all, and one that no polygon uses.
test::ModelSpec parts() {
    test::ModelSpec spec;
    spec.joints = {
        {kNone, test::moved(1, 0, 0), {test::submesh(0, 0, 1, kNone, Topology::points)}, ""},
        {kNone, test::moved(2, 0, 0), {test::submesh(0, 1, 2, kNone, Topology::points)}, ""},
        {kNone, test::moved(3, 0, 0), {test::submesh(0, 3, 0), test::submesh(0, 3, 2, kNone, Topology::lines)}, ""}};
    spec.meshes.resize(1);
    spec.meshes[0].joint = 0;
    spec.meshes[0].positions.resize(6);
    spec.meshes[0].indices = {5, 1, 1, 4, 0};
    return spec;
}

TEST(Skin, TheVerticesOfARigidMeshMoveWithTheJointsOfTheirPolygons) {
    const Owned model(test::build_file(parts()));
    Pose pose(*model);
    const Posed posed(*model, 0, pose);
    const std::vector<float> expected{3, 2, 1, 1, 3, 1};  // 2 and 3 are unused: the mesh's own joint
    for (std::uint32_t vertex = 0; vertex < 6; ++vertex) {
        EXPECT_EQ(posed.positions[vertex], glm::vec3(expected[vertex], 0, 0)) << vertex;
        EXPECT_EQ(static_cast<float>(model->rigid_mover(0, vertex)) + 1.0f, expected[vertex]) << vertex;
    }
}

TEST(Skin, VerticesThatNothingMovesStay) {
    test::ModelSpec spec = parts();
    spec.meshes[0].joint = kNone;
    spec.meshes[0].positions.assign(6, {0, 5, 0});
    spec.meshes[0].normals.assign(6, {0, 1, 0});
    const Owned model(test::build_file(spec));
    Pose pose(*model);
    const Posed posed(*model, 0, pose);
    EXPECT_EQ(model->rigid_mover(0, 2), kNone);
    EXPECT_EQ(posed.positions[2], glm::vec3(0, 5, 0));
    EXPECT_EQ(posed.normals[2], glm::vec3(0, 1, 0));
    EXPECT_EQ(posed.positions[5], glm::vec3(1, 5, 0));

    test::ModelSpec loose;  // no joint at all
    loose.meshes.resize(1);
    loose.meshes[0].positions = {{1, 2, 3}};
    EXPECT_EQ(pose_of(loose).positions[0], glm::vec3(1, 2, 3));
}

// --- the caller's memory

TEST(Skin, AllMeshesStandOneAfterAnother) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    ASSERT_TRUE(sample(pose, model->clip("run"), 0.7f));
    Posed all(model->vertex_count());
    ASSERT_TRUE(skin(pose, {.out = all.all()}));
    for (std::uint32_t mesh = 0; mesh < model->meshes().size(); ++mesh) {
        const Posed one(*model, mesh, pose);
        for (std::size_t v = 0; v < one.positions.size(); ++v) {
            EXPECT_EQ(all.positions[model->first_vertex(mesh) + v], one.positions[v]);
            EXPECT_EQ(all.normals[model->first_vertex(mesh) + v], one.normals[v]);
            EXPECT_EQ(all.tangents[model->first_vertex(mesh) + v], one.tangents[v]);
        }
    }
}

TEST(Skin, AnyStreamMayBeLeftOut) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    Posed all(model->vertex_count());
    ASSERT_TRUE(skin(pose, {.out = all.all()}));
    Posed some(model->vertex_count());
    ASSERT_TRUE(skin(pose, {.out = {.positions = some.positions}}));
    EXPECT_EQ(some.positions, all.positions);
    EXPECT_EQ(some.normals[0], kUntouched);
    ASSERT_TRUE(skin(pose, {.out = {{}, some.normals, {}}}));
    EXPECT_EQ(some.normals, all.normals);
    EXPECT_EQ(some.tangents[0], glm::vec4(-77.0f));
    ASSERT_TRUE(skin(pose, {.out = {{}, {}, some.tangents}}));
    EXPECT_EQ(some.tangents, all.tangents);
    EXPECT_TRUE(skin(pose, {}));
}

TEST(Skin, SpansThatAreTooShortAreRefusedAndNothingIsWritten) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    Posed out(model->vertex_count());
    const auto cut = [](auto& vectors, std::size_t count) { return std::span(vectors).first(count); };
    const std::size_t one_less = out.positions.size() - 1;
    EXPECT_FALSE(skin(pose, {.out = {cut(out.positions, one_less), out.normals, out.tangents}}));
    EXPECT_FALSE(skin(pose, {.out = {out.positions, cut(out.normals, one_less), out.tangents}}));
    EXPECT_FALSE(skin(pose, {.out = {out.positions, out.normals, cut(out.tangents, one_less)}}));
    for (std::uint32_t mesh = 0; mesh < 2; ++mesh) {
        const std::size_t few = model->meshes()[mesh].vertices - 1;
        EXPECT_FALSE(skin(pose, {.mesh = mesh, .out = {cut(out.positions, few), out.normals, out.tangents}}));
        EXPECT_FALSE(skin(pose, {.mesh = mesh, .out = {out.positions, cut(out.normals, few), out.tangents}}));
        EXPECT_FALSE(skin(pose, {.mesh = mesh, .out = {out.positions, out.normals, cut(out.tangents, few)}}));
    }
    EXPECT_EQ(out.positions, std::vector<glm::vec3>(model->vertex_count(), kUntouched));
    EXPECT_EQ(out.normals, std::vector<glm::vec3>(model->vertex_count(), kUntouched));
    EXPECT_EQ(out.tangents, std::vector<glm::vec4>(model->vertex_count(), glm::vec4(-77.0f)));
}

TEST(Skin, LongerSpansKeepWhatIsBehind) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    Posed out(model->vertex_count() + 2);
    ASSERT_TRUE(skin(pose, {.out = out.all()}));
    EXPECT_NE(out.positions[model->vertex_count() - 1], kUntouched);
    EXPECT_EQ(out.positions[model->vertex_count()], kUntouched);
    EXPECT_EQ(out.normals.back(), kUntouched);
    EXPECT_EQ(out.tangents.back(), glm::vec4(-77.0f));
}

TEST(Skin, ADeepChainSkins) {
    const Owned model([] {
        test::ModelSpec spec;
        constexpr std::uint32_t kDeep = 10'000;
        for (std::uint32_t joint = 0; joint < kDeep; ++joint)
            spec.joints.push_back({joint == 0 ? kNone : joint - 1, test::moved(0, 0.5f, 0), {}, ""});
        spec.meshes.resize(1);
        spec.meshes[0].joint = kDeep - 1;
        spec.meshes[0].positions = {{1, 0, 0}};
        return test::build_file(spec);
    }());
    Pose pose(*model);
    EXPECT_EQ(Posed(*model, 0, pose).positions[0], glm::vec3(1, 5000, 0));
}

}  // namespace
}  // namespace bendy::skin_test
