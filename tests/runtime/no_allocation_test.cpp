#include <bendy/runtime.h>

#include "mutation/allocations.h"
#include "runtime/build_model.h"
#include "runtime/local_joints.h"
#include "runtime/packed_model.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace bendy::no_allocation_test {
namespace {

TEST(NoAllocation, TheCountCounts) {
    const std::uint64_t before = test::allocations().count;
    const std::vector<int> three(3);
    EXPECT_EQ(test::allocations().count - before, 1u);
    EXPECT_EQ(three.size(), 3u);
}

TEST(NoAllocation, PosingMakesNoneAfterSetUp) {
    const test::Owned model(test::sample_file());
    Pose pose(*model);
    Pose other(*model);
    std::vector<glm::vec3> positions(model->vertex_count());
    std::vector<glm::vec3> normals(model->vertex_count());
    std::vector<glm::vec4> tangents(model->vertex_count());
    const Vertices vertices{positions, normals, tangents};
    const Clip* run = model->clip("run");

    Lod lod(*model);
    ReachState state(*model);

    const std::uint64_t before = test::allocations().count;
    bool is_good = true;
    for (int frame = -2; frame < 20; ++frame) {
        is_good = sample(pose, run, 0.5f + 0.03f * static_cast<float>(frame)) && is_good;
        is_good = blend(pose, other, 0.5f) && make_additive(other, pose) && add(pose, other, 0.5f) && is_good;
        (void)pose.model_space();
        is_good = skin(pose, {.out = vertices}) && is_good;
        is_good = skin(pose, {.mesh = 0, .out = vertices}) && is_good;
        is_good = apply_morph_targets(model->meshes()[0], pose.morph_weights(), vertices) && is_good;
        lod.set_share(0.05f * static_cast<float>(frame));
        is_good = skin(pose, {.lod = &lod, .out = vertices}) && is_good;
        test::local_of(pose, 0)->translation.x += 1.0f;
        pose.change_morph_weights()[0] = 0.5f;
        is_good = skin(pose, {.out = vertices}) && is_good;
        pose.set_rest();
        is_good = !sample(pose, nullptr, 0.0f) && is_good;
        is_good = !skin(pose, {.out = {.positions = std::span(positions).first(1)}}) && is_good;
        constrain(pose);
        for (const Solver solver :
             {Solver::pull, Solver::two_bone, Solver::ccd, Solver::fabrik, Solver::aim, Solver::least_squares}) {
            ReachOptions options;
            options.solver = solver;
            const ReachTarget target({0.1f, 0.2f, 0.3f}, glm::quat(1.0f, 0.0f, 0.0f, 0.0f));
            is_good = reach(pose, model->chains().data(), target, options) && is_good;
            options.state = &state;
            is_good = reach(pose, model->chains().data(), target, options) && is_good;
        }
        reach_all(pose);
        is_good = model->joint("head") == 2 && model->clip("run") == run && is_good;
    }
    EXPECT_EQ(test::allocations().count - before, 0u);
    EXPECT_TRUE(is_good);
}

TEST(NoAllocation, PlayingACrowdMakesNone) {
    const test::Owned model(test::sample_file());
    Crowd crowd(*model, 2);
    constexpr std::size_t kMembers = 5;
    std::vector<float> positions(kMembers * model->vertex_count() * 3);
    std::vector<PaletteMatrix> palettes(kMembers * crowd.palette_size());
    std::vector<CrowdMember> members(kMembers);

    const std::uint64_t before = test::allocations().count;
    bool is_good = true;
    for (int frame = 0; frame < 20; ++frame) {
        for (std::size_t k = 0; k < kMembers; ++k) {
            members[k].clip = model->clip("run");
            members[k].seconds = 0.5f + 0.03f * static_cast<float>(frame);
            members[k].out.positions = {std::span(positions).subspan(k * model->vertex_count() * 3), 3};
            members[k].palette = std::span(palettes).subspan(k * crowd.palette_size());
        }
        is_good = crowd.play(members, static_cast<std::size_t>(frame) % 2) && is_good;
    }
    EXPECT_EQ(test::allocations().count - before, 0u);
    EXPECT_TRUE(is_good);
}

TEST(NoAllocation, WhatGamesAskForEachFrameMakesNone) {
    const test::Owned model(test::build_file(test::packed_spec(40, 50, 16)));
    const test::Owned skinned(test::sample_file());
    const Clip& clip = *model->clip("packed");
    const Clip& run = *skinned->clip("run");
    Pose pose(*model);
    Pose scratch(*model);
    Pose skinned_pose(*skinned);
    Pose skinned_scratch(*skinned);
    const RootPath path(*model, 2);
    Binding binding(*skinned, *skinned);
    const Bounds bounds(*skinned);
    prepare_skin(skinned_pose, SkinningMethod::dual_quaternion);
    Lod lod(*skinned);
    const Socket socket = make_socket(*skinned, "head");
    const std::vector<Marker> markers{{0.5f, "left"}, {1.0f, "right"}};
    std::vector<const Marker*> met(4);
    std::vector<glm::vec3> positions(skinned->vertex_count());
    std::vector<glm::vec3> normals(skinned->vertex_count());

    const std::uint64_t before = test::allocations().count;
    bool is_good = true;
    std::uint64_t count = 0;
    RootMotion character;
    Crossfade fade;
    Crossfade skinned_fade;
    for (int frame = 0; frame < 40; ++frame) {
        if (frame % 7 == 0) fade.play(clip, Playback(clip.start, clip.end, LoopMode::repeat), 0.5f);
        if (frame % 9 == 0) skinned_fade.play(run, 0.2f);
        fade.advance(0.05);
        skinned_fade.advance(0.3);
        for (const Playing& playing : fade.playing()) {
            character = compose(character, *path.over(*playing.clip, playing.played));
            visit_markers(markers, playing.played, [&](const Marker&) { ++count; });
            count += collect_markers(markers, playing.played, met);
        }
        is_good = sample(pose, fade, scratch) && sample(skinned_pose, skinned_fade, skinned_scratch) && is_good;
        is_good = path.extract(pose) && is_good;
        is_good = sample(skinned_pose, binding, &run, 0.7f) && is_good;
        is_good = !bounds.of(skinned_pose)->is_empty() && !bounds.of(skinned_pose, 0)->is_empty() && is_good;
        is_good = (*socket_matrix(skinned_pose, socket))[3].w == 1.0f && is_good;
        is_good = skin(skinned_pose, {.method = SkinningMethod::dual_quaternion,
                                      .out = {.positions = positions, .normals = normals}}) &&
                  is_good;
        lod.set_share(0.02f * static_cast<float>(frame));
        is_good = skin(skinned_pose,
                       {.lod = &lod, .method = SkinningMethod::dual_quaternion, .out = {.positions = positions}}) &&
                  is_good;
    }
    EXPECT_EQ(test::allocations().count - before, 0u);
    EXPECT_TRUE(is_good);
    EXPECT_GT(count, 0u);
}

TEST(NoAllocation, PlayingPackedClipsMakesNoneInOrderOrAtRandom) {
    const test::Owned model(test::build_file(test::packed_spec(40, 50, 16)));
    const test::Owned other(test::build_file(test::packed_spec(40, 50, 16)));
    Pose pose(*model);
    const Clip* clip = model->clip("packed");
    const Clip* of_other = other->clip("packed");
    std::uint32_t random = 1;

    const std::uint64_t before = test::allocations().count;
    bool is_good = true;
    for (int frame = 0; frame < 200; ++frame) {
        random = random * 1664525u + 1013904223u;
        is_good = sample(pose, clip, 0.4f + 0.013f * static_cast<float>(frame)) && is_good;
        is_good = sample(pose, clip, 0.4f + 2.5f * static_cast<float>(random >> 8) / 16777216.0f) && is_good;
        is_good = !sample(pose, of_other, 0.4f + 0.013f * static_cast<float>(frame)) && is_good;
    }
    EXPECT_EQ(test::allocations().count - before, 0u);
    EXPECT_TRUE(is_good);
}

}  // namespace
}  // namespace bendy::no_allocation_test
