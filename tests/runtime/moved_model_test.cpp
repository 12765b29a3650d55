#include <bendy/runtime.h>

#include "format/sample_file.h"
#include "runtime/build_model.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace bendy::moved_model_test {
namespace {

/// A character as a game keeps it: all of it moves when the game's list of them grows.
struct Character {
    test::Buffer bytes;
    Model model;
    Pose pose;
    Pose scratch;
    Lod lod;
    Bounds bounds;
    Binding binding;
    Crowd crowd;
    RootPath path;
    Crossfade fade;
    Socket socket;
    std::vector<glm::vec3> positions;
};

Character make_character() {
    test::Buffer bytes = test::sample_file();
    Model model = *Model::from_memory(bytes);
    Pose pose(model);
    Character made{std::move(bytes),
                   model,
                   pose,
                   Pose(model),
                   Lod(model),
                   Bounds(model),
                   Binding(model, model),
                   Crowd(model),
                   RootPath(model, 0),
                   {},
                   make_socket(model, "head"),
                   std::vector<glm::vec3>(model.vertex_count())};
    made.fade.play(*model.clip("run"), 0.0f);
    return made;
}

/// Everything that refers to the model, at a time.
std::vector<glm::vec3> play(Character& character, double seconds) {
    Character& c = character;
    std::vector<glm::vec3> all;
    const auto keep = [&](const glm::vec3& v) { all.push_back(v); };
    const auto keep_positions = [&] { all.insert(all.end(), c.positions.begin(), c.positions.end()); };
    c.fade.advance(seconds);
    EXPECT_TRUE(sample(c.pose, c.fade, c.scratch));
    keep(glm::vec3(c.path.extract(c.pose)->translation));
    EXPECT_TRUE(blend(c.pose, c.scratch, 0.25f));
    for (const Chain& chain : c.pose.model().chains()) EXPECT_TRUE(reach(c.pose, &chain, glm::vec3(0.1f, 1.0f, 0.2f)));
    constrain(c.pose);
    for (const glm::mat4& joint : c.pose.model_space()) keep(glm::vec3(joint[3]));
    keep(glm::vec3((*socket_matrix(c.pose, c.socket))[3]));
    keep(c.bounds.of(c.pose)->maximum);
    c.lod.set_share(0.5f);
    for (const SkinningMethod method : {SkinningMethod::linear, SkinningMethod::dual_quaternion}) {
        EXPECT_TRUE(skin(c.pose, {.method = method, .out = {.positions = c.positions}}));
        keep_positions();
        EXPECT_TRUE(skin(c.pose, {.lod = &c.lod, .method = method, .out = {.positions = c.positions}}));
        keep_positions();
    }
    const Clip* clip = c.fade.playing().front().clip;
    EXPECT_TRUE(sample(c.pose, c.binding, clip, 0.7f));
    for (const glm::mat4& joint : c.pose.model_space()) keep(glm::vec3(joint[3]));
    const CrowdMember member{clip, 0.8f, &c.lod, {.positions = c.positions}, {}};
    EXPECT_TRUE(c.crowd.play({&member, 1}));
    keep_positions();
    return all;
}

TEST(MovedModel, WhatWasMadeOfItGoesOn) {
    Character stays = make_character();
    std::vector<Character> list;
    list.push_back(make_character());
    for (int k = 0; k < 6; ++k) {
        const std::vector<glm::vec3> expected = play(stays, 0.03);
        EXPECT_EQ(play(list.front(), 0.03), expected);
        list.push_back(make_character());  // the list grows, and all in it are moved
    }
}

TEST(MovedModel, PosesKeepWhatTheyNeedWhenTheModelIsGone) {
    const test::Buffer bytes = test::sample_file();
    auto model = std::make_unique<Model>(*Model::from_memory(bytes));
    Pose pose(*model);
    const Clip* run = model->clip("run");
    std::vector<glm::vec3> expected(model->vertex_count());
    ASSERT_TRUE(sample(pose, run, 0.6f));
    ASSERT_TRUE(skin(pose, {.out = {.positions = expected}}));
    Model elsewhere = std::move(*model);
    model.reset();
    EXPECT_EQ(pose.model(), elsewhere);
    std::optional<Pose> moved(std::move(pose));
    elsewhere = *Model::from_memory(bytes);  // the character is the pose's alone now
    EXPECT_NE(moved->model(), elsewhere) << "a file that is opened twice makes two characters";
    moved->set_rest();
    ASSERT_TRUE(sample(*moved, run, 0.6f));
    std::vector<glm::vec3> found(expected.size());
    ASSERT_TRUE(skin(*moved, {.out = {.positions = found}}));
    EXPECT_EQ(found, expected);
}

TEST(MovedModel, PosesOfCopiesAreOfOneModel) {
    const test::Buffer bytes = test::sample_file();
    const Model model = *Model::from_memory(bytes);
    const Model copy = model;
    const Model other = *Model::from_memory(bytes);
    Pose pose(model);
    EXPECT_TRUE(blend(pose, Pose(copy), 0.5f));
    EXPECT_EQ(blend(pose, Pose(other), 0.5f).error(), CallError::other_model);
    const Lod lod(copy);
    const Lod of_other(other);
    EXPECT_TRUE(skin(pose, {.lod = &lod}));
    EXPECT_EQ(skin(pose, {.lod = &of_other}).error(), CallError::other_model);
    EXPECT_EQ(skin(pose, {.mesh = static_cast<std::uint32_t>(model.meshes().size())}).error(), CallError::out_of_range);
}

}  // namespace
}  // namespace bendy::moved_model_test
