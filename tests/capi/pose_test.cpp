// Posing and skinning through the C API: the same bits as by the C++ one, and numbers worked out here.
#include "capi/open_handles.h"
#include "source_folder.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

namespace bendy::test::pose_test {
namespace {

std::string seed(const char* name) {
    return (source_folder() / "tests/seeds" / name).string();
}

std::vector<float> skin_all(bendy_pose* pose, const bendy_model* model, const bendy_lod* lod = nullptr) {
    std::vector<float> positions(bendy_vertex_count(model) * 3);
    bendy_vertices out = BENDY_VERTICES_INIT;
    out.capacity = positions.size() / 3;
    out.positions = positions.data();
    bendy_error error = BENDY_ERROR_INIT;
    bendy_skin_options options = BENDY_SKIN_OPTIONS_INIT;
    options.lod = lod;
    EXPECT_EQ(bendy_skin(pose, &options, &out, &error), BENDY_OK) << error.message;
    return positions;
}

std::vector<float> skin_all(Pose& pose, const Model& model) {
    std::vector<glm::vec3> positions(model.vertex_count());
    EXPECT_TRUE(skin(pose, {.out = {.positions = positions}}));
    const float* first = &positions[0].x;
    return {first, first + positions.size() * 3};
}

TEST(CPose, RestPoseStandsWhereTheJointsAre) {
    const ModelHandle model = open_copy(two_joint_file());
    const PoseHandle pose = new_pose(model);
    EXPECT_EQ(skin_all(pose.get(), model.get()), (std::vector<float>{1, 2, 3, 2, 2, 3, 1, 3, 3}));
}

TEST(CPose, MatricesGoFromJointsToModelAndWorld) {
    const ModelHandle model = open_copy(two_joint_file());
    const PoseHandle pose = new_pose(model);
    std::array<float, 32> matrices{};
    ASSERT_EQ(bendy_joint_matrices(pose.get(), 0, 2, nullptr, matrices.data(), nullptr), BENDY_OK);
    EXPECT_EQ(matrices, (std::array<float, 32>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1,  //
                                               1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 3, 3, 1}));
    // A quarter turn about Z, which takes X to Y and Y to -X, and then 10 along X.
    const std::array<float, 16> world{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 10, 0, 0, 1};
    std::array<float, 16> tip{};
    ASSERT_EQ(bendy_joint_matrices(pose.get(), 1, 1, world.data(), tip.data(), nullptr), BENDY_OK);
    EXPECT_EQ(tip, (std::array<float, 16>{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 7, 1, 3, 1}));
}

TEST(CPose, LocalTransformsMoveWhatHangsOnThem) {
    const ModelHandle model = open_copy(two_joint_file());
    const PoseHandle pose = new_pose(model);
    bendy_transform root{};
    ASSERT_EQ(bendy_get_local(pose.get(), 0, 1, &root, nullptr), BENDY_OK);
    EXPECT_EQ(root.translation[2], 3.0f);
    root.translation[0] = -1.0f;
    root.scale[1] = 2.0f;
    ASSERT_EQ(bendy_set_local(pose.get(), 0, 1, &root, nullptr), BENDY_OK);
    EXPECT_EQ(skin_all(pose.get(), model.get()), (std::vector<float>{-1, 2, 3, 0, 2, 3, -1, 4, 3}));
    bendy_set_rest(pose.get(), nullptr);
    EXPECT_EQ(skin_all(pose.get(), model.get())[0], 1.0f);
}

TEST(CPose, SampledBlendedConstrainedAndReachingIsTheSameAsInCpp) {
    const auto expected = Model::open(seed("rope_rigged.bendy"));
    ASSERT_TRUE(expected.has_value());
    bendy_error error = BENDY_ERROR_INIT;
    const ModelHandle model(bendy_open(seed("rope_rigged.bendy").c_str(), nullptr, &error));
    ASSERT_NE(model, nullptr) << error.message;
    for (const float seconds : {0.1f, 0.7f}) {
        Pose cpp(*expected);
        Pose cpp_rest(*expected);
        EXPECT_TRUE(sample(cpp, &expected->clips()[0], seconds));
        EXPECT_TRUE(blend(cpp, cpp_rest, 0.25f));
        constrain(cpp);
        ReachOptions cpp_options;
        cpp_options.solver = Solver::ccd;
        cpp_options.iterations = 7;
        cpp_options.influence = 0.75f;
        const ReachResult cpp_result = *reach(cpp, &expected->chains()[0], glm::vec3(0.2f, 0.4f, 0.1f), cpp_options);

        const PoseHandle pose = new_pose(model);
        const PoseHandle rest = new_pose(model);
        ASSERT_EQ(bendy_sample(pose.get(), 0, seconds, &error), BENDY_OK) << error.message;
        ASSERT_EQ(bendy_blend(pose.get(), rest.get(), 0.25f, nullptr, &error), BENDY_OK) << error.message;
        ASSERT_EQ(bendy_constrain(pose.get(), &error), BENDY_OK) << error.message;
        bendy_reach_options options = BENDY_REACH_OPTIONS_INIT;
        options.solver = BENDY_SOLVER_CCD;
        options.iterations = 7;
        options.influence = 0.75f;
        const std::array<float, 3> target{0.2f, 0.4f, 0.1f};
        auto result = sized<bendy_reach_result>();
        ASSERT_EQ(bendy_reach(pose.get(), 0, target.data(), nullptr, &options, &result, &error), BENDY_OK)
            << error.message;
        EXPECT_EQ(result.distance, cpp_result.distance);
        EXPECT_EQ(result.status, static_cast<std::uint32_t>(cpp_result.status));
        EXPECT_EQ(result.iterations, cpp_result.iterations);
        EXPECT_EQ(skin_all(pose.get(), model.get()), skin_all(cpp, *expected));
    }
}

TEST(CPose, DefaultReachIsTheSameAsInCpp) {
    const auto expected = Model::open(seed("rope_rigged.bendy"));
    const ModelHandle model(bendy_open(seed("rope_rigged.bendy").c_str(), nullptr, nullptr));
    const std::array<float, 3> target{0.3f, 0.6f, 0.0f};
    const std::array<float, 4> turned{0.6f, 0.0f, 0.0f, 0.8f};
    const PoseHandle pose = new_pose(model);
    auto result = sized<bendy_reach_result>();
    ASSERT_EQ(bendy_reach(pose.get(), 0, target.data(), turned.data(), nullptr, &result, nullptr), BENDY_OK);
    Pose cpp(*expected);
    const ReachTarget cpp_target({0.3f, 0.6f, 0.0f}, glm::quat(0.8f, 0.6f, 0.0f, 0.0f));
    const ReachResult cpp_result = *reach(cpp, &expected->chains()[0], cpp_target);
    EXPECT_EQ(result.distance, cpp_result.distance);
    EXPECT_EQ(result.angle, cpp_result.angle);
    EXPECT_EQ(skin_all(pose.get(), model.get()), skin_all(cpp, *expected));
    bendy_reach_all(pose.get(), nullptr, 0.0f, nullptr);
    reach_all(cpp);
    EXPECT_EQ(skin_all(pose.get(), model.get()), skin_all(cpp, *expected));
}

TEST(CPose, ReachesOverTimeAsCppDoes) {
    const auto expected = Model::open(seed("rope_rigged.bendy"));
    const ModelHandle model(bendy_open(seed("rope_rigged.bendy").c_str(), nullptr, nullptr));
    const PoseHandle pose = new_pose(model);
    const ReachStateHandle state(bendy_reach_state_new(model.get(), nullptr));
    ASSERT_NE(state, nullptr);
    ReachState cpp_state(*expected);
    for (int frame = 0; frame < 8; ++frame) {
        if (frame == 3) {
            ASSERT_EQ(bendy_reach_state_forget(state.get(), 0, nullptr), BENDY_OK);
            ASSERT_TRUE(cpp_state.forget(&expected->chains()[0]));
        } else if (frame == 6) {
            ASSERT_EQ(bendy_reach_state_reset(state.get(), nullptr), BENDY_OK);
            cpp_state.reset();
        }
        const std::array<float, 3> target{frame % 2 == 0 ? 0.3f : -0.3f, 0.1f, 0.1f};
        ASSERT_EQ(bendy_set_rest(pose.get(), nullptr), BENDY_OK);
        bendy_reach_options options = BENDY_REACH_OPTIONS_INIT;
        options.state = state.get();
        options.seconds = 0.01f;
        options.speed_limit = 1.0f;
        auto result = sized<bendy_reach_result>();
        ASSERT_EQ(bendy_reach(pose.get(), 0, target.data(), nullptr, &options, &result, nullptr), BENDY_OK);
        Pose cpp(*expected);
        ReachOptions cpp_options;
        cpp_options.state = &cpp_state;
        cpp_options.seconds = 0.01f;
        cpp_options.speed_limit = 1.0f;
        const ReachResult cpp_result =
            *reach(cpp, &expected->chains()[0], glm::vec3(target[0], target[1], target[2]), cpp_options);
        EXPECT_EQ(result.distance, cpp_result.distance);
        EXPECT_EQ(skin_all(pose.get(), model.get()), skin_all(cpp, *expected));
    }
    const ModelHandle other(bendy_open(seed("rope_rigged.bendy").c_str(), nullptr, nullptr));
    const PoseHandle other_pose = new_pose(other);
    bendy_reach_options options = BENDY_REACH_OPTIONS_INIT;
    options.state = state.get();
    const std::array<float, 3> target{0.3f, 0.1f, 0.1f};
    bendy_error error{};
    EXPECT_EQ(bendy_reach(other_pose.get(), 0, target.data(), nullptr, &options, nullptr, &error), BENDY_BAD_ARGUMENT);
    EXPECT_STREQ(error.message, "state is of another model than pose");
}

/// Targets that a rope follows one after another: more than are solved at once.
std::vector<bendy_reach_request> requests_along_a_line(const bendy_reach_options* options) {
    std::vector<bendy_reach_request> requests(20, BENDY_REACH_REQUEST_INIT);
    for (std::size_t k = 0; k < requests.size(); ++k) {
        requests[k].chain = 0;
        requests[k].position[0] = 0.02f * static_cast<float>(k);
        requests[k].position[1] = 0.5f;
        requests[k].has_rotation = k % 2;
        requests[k].options = k % 3 == 0 ? options : nullptr;
    }
    return requests;
}

TEST(CPose, SeveralChainsReachAsOneAfterAnother) {
    const ModelHandle model(bendy_open(seed("rope_rigged.bendy").c_str(), nullptr, nullptr));
    bendy_reach_options options = BENDY_REACH_OPTIONS_INIT;
    options.influence = 0.5f;
    const auto requests = requests_along_a_line(&options);
    const PoseHandle together = new_pose(model);
    std::vector<bendy_reach_result> results(requests.size(), sized<bendy_reach_result>());
    ASSERT_EQ(bendy_reach_chains(together.get(), requests.data(), requests.size(), results.data(), nullptr), BENDY_OK);
    const PoseHandle single = new_pose(model);
    for (std::size_t k = 0; k < requests.size(); ++k) {
        auto result = sized<bendy_reach_result>();
        const float* const rotation = requests[k].has_rotation != 0 ? requests[k].rotation : nullptr;
        ASSERT_EQ(bendy_reach(single.get(), 0, requests[k].position, rotation, requests[k].options, &result, nullptr),
                  BENDY_OK);
        EXPECT_EQ(results[k].distance, result.distance) << k;
        EXPECT_EQ(results[k].angle, result.angle) << k;
        EXPECT_EQ(results[k].iterations, result.iterations) << k;
    }
    EXPECT_EQ(skin_all(together.get(), model.get()), skin_all(single.get(), model.get()));
}

TEST(CPose, ABadRequestMovesNothing) {
    const ModelHandle model(bendy_open(seed("rope_rigged.bendy").c_str(), nullptr, nullptr));
    const PoseHandle pose = new_pose(model);
    const auto rest = skin_all(pose.get(), model.get());
    const auto reach = [&](std::vector<bendy_reach_request> requests) {
        bendy_error error = BENDY_ERROR_INIT;
        EXPECT_EQ(bendy_reach_chains(pose.get(), requests.data(), requests.size(), nullptr, &error),
                  BENDY_BAD_ARGUMENT);
        EXPECT_EQ(skin_all(pose.get(), model.get()), rest);
        return std::string(error.message);
    };
    auto requests = requests_along_a_line(nullptr);
    requests[18].chain = 9;
    EXPECT_EQ(reach(requests), "chain 9 does not exist: the model has 2 chains");
    requests = requests_along_a_line(nullptr);
    requests[18].position[1] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(reach(requests), "position holds a number that is not finite");
    requests = requests_along_a_line(nullptr);
    requests[18].size = 4096;
    EXPECT_EQ(reach(requests), "requests have different sizes");
    EXPECT_EQ(bendy_reach_chains(pose.get(), nullptr, 0, nullptr, nullptr), BENDY_OK);
}

TEST(CPose, WhatAChainFollowsIsCarriedByDefault) {
    ModelSpec spec;
    spec.joints.resize(4);
    spec.joints[1].parent = 0;
    spec.joints[2].parent = 1;
    spec.joints[1].rest.translation = spec.joints[2].rest.translation = {0.0f, 1.0f, 0.0f};
    ChainRecord chain;
    chain.start = 0;
    chain.effector = 2;
    chain.target = 3;
    spec.chains.push_back(chain);
    const ModelHandle model = open_copy(build_file(spec));
    const std::array<float, 3> target{1.0f, 1.0f, 0.0f};
    const bendy_reach_options defaults = BENDY_REACH_OPTIONS_INIT;
    bendy_reach_options off = BENDY_REACH_OPTIONS_INIT;
    off.carry_target = 0;
    auto zeros = sized<bendy_reach_options>();
    zeros.influence = 1.0f;
    const auto followed = [&](const bendy_reach_options* options, bool is_alone) {
        const PoseHandle pose = new_pose(model);
        bendy_reach_request request = BENDY_REACH_REQUEST_INIT;
        request.chain = 0;
        std::copy(target.begin(), target.end(), request.position);
        request.options = options;
        EXPECT_EQ(is_alone ? bendy_reach(pose.get(), 0, target.data(), nullptr, options, nullptr, nullptr)
                           : bendy_reach_chains(pose.get(), &request, 1, nullptr, nullptr),
                  BENDY_OK);
        bendy_transform local{};
        EXPECT_EQ(bendy_get_local(pose.get(), 3, 1, &local, nullptr), BENDY_OK);
        return glm::vec3(local.translation[0], local.translation[1], local.translation[2]);
    };
    for (const bool is_alone : {true, false}) {
        for (const bendy_reach_options* const on : {static_cast<const bendy_reach_options*>(nullptr), &defaults})
            EXPECT_LE(glm::length(followed(on, is_alone) - glm::vec3(1.0f, 1.0f, 0.0f)), 1e-3f);
        for (const bendy_reach_options* const without : {&off, &zeros})
            EXPECT_EQ(followed(without, is_alone), glm::vec3(0.0f));
    }
}

// The library's defaults are the C++ ones.
TEST(CPose, DefaultOptionsAreTheRuntimes) {
    const bendy_reach_options options = BENDY_REACH_OPTIONS_INIT;
    const ReachOptions expected;
    EXPECT_EQ(options.restarts, expected.restarts);
    EXPECT_EQ(options.tolerance, expected.tolerance);
    EXPECT_EQ(options.influence, expected.influence);
    EXPECT_EQ(options.softness, expected.softness);
    EXPECT_EQ(options.gain, expected.gain);
    EXPECT_EQ(options.step_limit, expected.step_limit);
    EXPECT_EQ(options.ignore_constraints, expected.obey_constraints ? 0u : 1u);
    EXPECT_EQ(options.carry_target, expected.carry_target ? 1u : 0u);
}

TEST(CPose, DifferenceAddedGivesThePoseAgain) {
    const ModelHandle model = open_copy(two_joint_file());
    const PoseHandle rest = new_pose(model);
    const PoseHandle moved_pose = new_pose(model);
    bendy_transform transform{{0, 0, 0, 1}, {5, 2, 3}, {1, 1, 1}};
    bendy_set_local(moved_pose.get(), 0, 1, &transform, nullptr);
    ASSERT_EQ(bendy_make_additive(moved_pose.get(), rest.get(), nullptr), BENDY_OK);
    ASSERT_EQ(bendy_add(rest.get(), moved_pose.get(), 0.5f, nullptr, nullptr), BENDY_OK);
    EXPECT_EQ(skin_all(rest.get(), model.get())[0], 3.0f);  // half way from 1 to 5
    std::array<float, 2> mask{};
    ASSERT_EQ(bendy_mask_below(model.get(), 1, 1.0f, 0.0f, mask.data(), mask.size(), nullptr), BENDY_OK);
    EXPECT_EQ(mask, (std::array<float, 2>{0, 1}));
    ASSERT_EQ(bendy_add(rest.get(), moved_pose.get(), 1.0f, mask.data(), nullptr), BENDY_OK);
    EXPECT_EQ(skin_all(rest.get(), model.get())[0], 3.0f);
}

TEST(CPose, TargetWeightsMoveVertices) {
    const ModelHandle model = open_copy(sample_file());
    const PoseHandle pose = new_pose(model);
    const auto before = skin_all(pose.get(), model.get());
    std::array<float, 2> weights{0.5f, 2.0f};
    ASSERT_EQ(bendy_set_weights(pose.get(), 0, 2, weights.data(), nullptr), BENDY_OK);
    std::array<float, 2> read{};
    ASSERT_EQ(bendy_get_weights(pose.get(), 0, 2, read.data(), nullptr), BENDY_OK);
    EXPECT_EQ(read, weights);
    EXPECT_NE(skin_all(pose.get(), model.get()), before);
}

TEST(CPose, InterleavedVerticesAreWrittenAndNothingBetween) {
    const ModelHandle model = open_copy(two_joint_file());
    const PoseHandle pose = new_pose(model);
    constexpr float kUntouched = -77.0f;
    std::array<float, 23> buffer{};
    buffer.fill(kUntouched);
    bendy_vertices out = BENDY_VERTICES_INIT;
    out.capacity = 3;
    out.positions = &buffer[1];
    out.position_stride = 32;
    out.normals = &buffer[4];
    out.normal_stride = 32;
    bendy_error error = BENDY_ERROR_INIT;
    bendy_skin_options options = BENDY_SKIN_OPTIONS_INIT;
    options.mesh = 0;
    ASSERT_EQ(bendy_skin(pose.get(), &options, &out, &error), BENDY_OK) << error.message;
    const float u = kUntouched;
    EXPECT_EQ(buffer, (std::array<float, 23>{u, 1, 2, 3, 0, 0, 1, u, u, 2, 2, 3, 0, 0, 1, u, u, 1, 3, 3, 0, 0, 1}));
}

TEST(CPose, DualQuaternionsAreAMethodOfSkinning) {
    const Owned expected{sample_file()};
    const ModelHandle model = open_copy(sample_file());
    const PoseHandle pose = new_pose(model);
    ASSERT_EQ(bendy_sample(pose.get(), 0, 0.8f, nullptr), BENDY_OK);
    Pose cpp(*expected);
    ASSERT_TRUE(sample(cpp, &expected->clips()[0], 0.8f));
    std::vector<glm::vec3> wanted(expected->vertex_count());
    ASSERT_TRUE(skin(cpp, {.method = SkinningMethod::dual_quaternion, .out = {.positions = wanted}}));
    std::vector<glm::vec3> made(wanted.size());
    bendy_vertices out = BENDY_VERTICES_INIT;
    out.capacity = made.size();
    out.positions = &made[0].x;
    bendy_skin_options options = BENDY_SKIN_OPTIONS_INIT;
    options.method = BENDY_SKIN_DUAL_QUATERNION;
    bendy_error error = BENDY_ERROR_INIT;
    ASSERT_EQ(bendy_skin(pose.get(), &options, &out, &error), BENDY_OK) << error.message;
    EXPECT_EQ(made, wanted);
    ASSERT_TRUE(skin(cpp, {.out = {.positions = wanted}}));
    EXPECT_NE(made, wanted) << "or the pose does not tell the methods apart";
    options.method = 2;
    EXPECT_EQ(bendy_skin(pose.get(), &options, &out, &error), BENDY_BAD_ARGUMENT);
    EXPECT_STREQ(error.message, "method 2 is not a bendy_skin_method");
}

TEST(CPose, BoneMatricesAreThePalette) {
    const Owned expected{sample_file()};
    const ModelHandle model = open_copy(sample_file());
    const PoseHandle pose = new_pose(model);
    bendy_sample(pose.get(), 0, 0.8f, nullptr);
    Pose cpp(*expected);
    EXPECT_TRUE(sample(cpp, &expected->clips()[0], 0.8f));
    const auto palette = cpp.palette(0);
    std::vector<float> matrices(palette.size() * 16);
    ASSERT_EQ(bendy_bone_matrices(pose.get(), 0, matrices.data(), palette.size(), nullptr), BENDY_OK);
    for (std::size_t k = 0; k < matrices.size(); ++k) {
        const std::size_t row = k % 4;
        const float number = row < 3 ? palette[k / 16].rows[row][k % 16 / 4] : (k % 16 == 15 ? 1.0f : 0.0f);
        EXPECT_EQ(matrices[k], number) << k;
    }
}

TEST(CPose, LevelOfDetailIsTheSameAsInCpp) {
    const std::string path = seed("rope_lod.bendy");
    const auto expected = Model::open(path);
    const ModelHandle model(bendy_open(path.c_str(), nullptr, nullptr));
    const LodHandle lod(bendy_lod_new(model.get(), nullptr));
    Lod cpp(*expected);
    auto info = sized<bendy_lod_info>();
    ASSERT_EQ(bendy_get_lod(lod.get(), &info, nullptr), BENDY_OK);
    const std::uint64_t all = info.triangles;
    EXPECT_EQ(all, cpp.triangles());
    ASSERT_EQ(bendy_lod_set_share(lod.get(), 0.3f, nullptr), BENDY_OK);
    cpp.set_share(0.3f);
    ASSERT_EQ(bendy_get_lod(lod.get(), &info, nullptr), BENDY_OK);
    EXPECT_LT(info.triangles, all);
    EXPECT_EQ(info.triangles, cpp.triangles());
    EXPECT_EQ(info.error, cpp.error());
    const PoseHandle pose = new_pose(model);
    std::size_t count = 0;
    const std::uint32_t* indices = bendy_lod_indices(lod.get(), 0, &count, nullptr);
    ASSERT_EQ(count, cpp.indices(0).size());
    EXPECT_TRUE(std::equal(indices, indices + count, cpp.indices(0).begin()));
    auto submesh = sized<bendy_submesh>();
    ASSERT_EQ(bendy_lod_submesh(lod.get(), 0, &submesh, nullptr), BENDY_OK);
    EXPECT_EQ(submesh.count, cpp.submeshes()[0].count);
    const auto positions = skin_all(pose.get(), model.get(), lod.get());
    const std::uint32_t alive = bendy_lod_vertices(lod.get(), 0);
    EXPECT_EQ(alive, cpp.vertices(0));
    const auto full = skin_all(pose.get(), model.get());
    EXPECT_TRUE(std::equal(positions.begin(), positions.begin() + alive * 3, full.begin()));
    EXPECT_EQ(positions[alive * std::size_t{3}], 0.0f) << "vertices that are not alive are left as they are";
}

TEST(CPose, WorksAfterItsModelIsClosed) {
    const Buffer file = two_joint_file();
    bendy_model* model = bendy_open_borrowed(file.data(), file.size(), nullptr, nullptr);
    ASSERT_NE(model, nullptr);
    PoseHandle pose = new_pose(ModelHandle(model));  // closes it
    std::array<float, 9> positions{};
    bendy_vertices out = BENDY_VERTICES_INIT;
    out.capacity = 3;
    out.positions = positions.data();
    ASSERT_EQ(bendy_skin(pose.get(), nullptr, &out, nullptr), BENDY_OK);
    EXPECT_EQ(positions[8], 3.0f);
}

TEST(CPose, CopiedBytesMayGo) {
    Buffer file = two_joint_file();
    const ModelHandle model = open_copy(file);
    std::fill(file.begin(), file.end(), std::byte{0xff});
    EXPECT_EQ(skin_all(new_pose(model).get(), model.get())[1], 2.0f);
}

}  // namespace
}  // namespace bendy::test::pose_test
