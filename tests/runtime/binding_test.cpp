#include <bendy/runtime/binding.h>

#include <bendy/runtime/sample.h>

#include "runtime/clip_model.h"
#include "runtime/local_joints.h"
#include "runtime/packed_model.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace bendy::binding_test {
namespace {

using test::Owned;

test::JointSpec joint(std::uint32_t parent, const std::string& name, float y) {
    return {parent, test::moved(0, y, 0), {}, name};
}

test::Node target_node(const std::string& name) {
    return test::make_container(FourCC("TARG"),
                                {test::make_leaf(FourCC("NAME"), std::as_bytes(std::span(name))),
                                 test::make_leaf(FourCC("TINF"), bytes_of(MorphTargetRecord{})),
                                 test::make_leaf(FourCC("POSI"), test::stream_payload<float>(3, {0, 1, 0}))});
}

test::MeshSpec mesh_with(const std::vector<std::string>& targets) {
    test::MeshSpec mesh;
    mesh.joint = 0;
    mesh.positions = {{0, 0, 0}};
    for (const std::string& name : targets) mesh.more.push_back(target_node(name));
    return mesh;
}

/// hips, spine, tail, one without a name; a clip that moves all of them, and two targets.
test::ModelSpec animated() {
    test::ModelSpec spec;
    spec.joints = {joint(kNone, "hips", 1), joint(0, "spine", 2), joint(0, "tail", 3), joint(0, "", 4)};
    spec.meshes = {mesh_with({"smile", "frown"})};
    test::ClipSpec clip;
    clip.name = "move";
    const std::vector<float> t{0.0f, 1.0f};
    clip.tracks = {{TrackPath::translation, 0, 3, t, {0, 10, 0, 0, 20, 0}},
                   {TrackPath::rotation, 1, 4, t, {0, 0, 0, 1, 0, 0, 1, 0}},
                   {TrackPath::translation, 1, 3, t, {5, 5, 5, 7, 7, 7}},
                   {TrackPath::scale, 1, 3, t, {1, 1, 1, 3, 3, 3}},
                   {TrackPath::rotation, 2, 4, t, {0, 0, 0, 1, 0, 0, 1, 0}},
                   {TrackPath::rotation, 3, 4, t, {0, 0, 0, 1, 0, 0, 1, 0}},
                   {TrackPath::weights, 0, 2, t, {0, 0, 0.5f, 1}}};
    test::ClipSpec other;
    other.name = "other";
    other.tracks = {{TrackPath::rotation, 0, 4, t, {0, 0, 0, 1, 0, 1, 0, 0}}};
    spec.more = {test::clip_node(clip), test::clip_node(other)};
    return spec;
}

/// In another order, with a joint between, other lengths, and a target more.
test::ModelSpec posed() {
    test::ModelSpec spec;
    spec.joints = {joint(kNone, "root", 0), joint(0, "hips", 0.5f), joint(1, "belly", 0.25f), joint(2, "spine", 1.5f),
                   joint(1, "", 4)};
    spec.meshes = {mesh_with({"wink", "smile"})};
    return spec;
}

TEST(Binding, MatchesByNameAndSaysWhatItCannot) {
    const Owned from(test::build_file(animated()));
    const Owned to(test::build_file(posed()));
    const Binding binding(*from, *to);
    const auto joints = binding.joints();
    EXPECT_EQ(std::vector<std::uint32_t>(joints.begin(), joints.end()),
              (std::vector<std::uint32_t>{1, 3, kNone, kNone}));
    const auto missed = binding.unmatched_joints();
    EXPECT_EQ(std::vector<std::uint32_t>(missed.begin(), missed.end()), (std::vector<std::uint32_t>{2, 3}));
    const auto targets = binding.targets();
    EXPECT_EQ(std::vector<std::uint32_t>(targets.begin(), targets.end()), (std::vector<std::uint32_t>{1, kNone}));
    const auto missed_targets = binding.unmatched_targets();
    EXPECT_EQ(std::vector<std::uint32_t>(missed_targets.begin(), missed_targets.end()),
              (std::vector<std::uint32_t>{1}));
}

TEST(Binding, WhatIsAnimatedComesOverTheRestIsAtRest) {
    const Owned from(test::build_file(animated()));
    const Owned to(test::build_file(posed()));
    Binding binding(*from, *to);
    Pose pose(*to);
    test::local_of(pose, 4)->translation = {9, 9, 9};
    pose.change_morph_weights()[0] = 9.0f;
    ASSERT_TRUE(sample(pose, binding, from->clip("move"), 1.0f));
    EXPECT_EQ(pose.local(0).translation, glm::vec3(0, 0, 0));
    EXPECT_EQ(pose.local(1).translation, glm::vec3(0, 20, 0));
    EXPECT_EQ(pose.local(2).translation, glm::vec3(0, 0.25f, 0));
    EXPECT_EQ(pose.local(3).translation, glm::vec3(7, 7, 7));
    EXPECT_EQ(pose.local(3).scale, glm::vec3(3, 3, 3));
    EXPECT_EQ(pose.local(3).rotation.z, 1.0f);
    EXPECT_EQ(pose.local(4).translation, glm::vec3(0, 4, 0));
    EXPECT_EQ(pose.morph_weights()[0], 0.0f);
    EXPECT_EQ(pose.morph_weights()[1], 0.5f);
    // Another clip animates less.
    ASSERT_TRUE(sample(pose, binding, from->clip("other"), 1.0f));
    EXPECT_EQ(pose.local(1).translation, glm::vec3(0, 0.5f, 0));
    EXPECT_EQ(pose.local(1).rotation.y, 1.0f);
    EXPECT_EQ(pose.local(3).rotation.w, 1.0f);
    EXPECT_EQ(pose.morph_weights()[1], 0.0f);
}

TEST(Binding, LimbsMayKeepTheirLengths) {
    const Owned from(test::build_file(animated()));
    const Owned to(test::build_file(posed()));
    BindingOptions options;
    options.translations = BoundTranslations::root_only;
    options.root_scale = 0.5f;
    Binding topmost(*from, *to, options);
    Pose pose(*to);
    ASSERT_TRUE(sample(pose, topmost, from->clip("move"), 1.0f));
    EXPECT_EQ(pose.local(1).translation, glm::vec3(0, 10, 0));    // hips: nothing matched above them
    EXPECT_EQ(pose.local(3).translation, glm::vec3(0, 1.5f, 0));  // the spine's own
    EXPECT_EQ(pose.local(3).rotation.z, 1.0f);
    options.root = to->joint("spine");
    options.root_scale = 1.0f;
    Binding down_to_spine(*from, *to, options);
    ASSERT_TRUE(sample(pose, down_to_spine, from->clip("move"), 1.0f));
    EXPECT_EQ(pose.local(1).translation, glm::vec3(0, 20, 0));
    EXPECT_EQ(pose.local(3).translation, glm::vec3(7, 7, 7));
}

TEST(Binding, RefusesWhatIsNotItsOwn) {
    const Owned from(test::build_file(animated()));
    const Owned to(test::build_file(posed()));
    Binding binding(*from, *to);
    Pose pose(*to);
    Pose of_other(*from);
    test::local_of(pose, 1)->translation.x = 7.0f;
    EXPECT_FALSE(sample(of_other, binding, from->clip("move"), 1.0f));
    EXPECT_FALSE(sample(pose, binding, nullptr, 1.0f));
    EXPECT_EQ(pose.local(1).translation, glm::vec3(0, 0.5f, 0));
    const Clip stranger;
    EXPECT_FALSE(sample(pose, binding, &stranger, 1.0f));
    EXPECT_FALSE(sample(pose, binding, from->clip("move"), std::numeric_limits<float>::quiet_NaN()));
}

TEST(Binding, OfDoubledNamesTheFirstCounts) {
    test::ModelSpec twice = animated();
    twice.joints[2].name = "spine";
    const Owned from(test::build_file(twice));
    test::ModelSpec target = posed();
    target.joints[4].name = "spine";
    const Owned to(test::build_file(target));
    const Binding binding(*from, *to);
    EXPECT_EQ(binding.joints()[1], 3u);
    EXPECT_EQ(binding.joints()[2], kNone);
}

TEST(Binding, ToTheSameSkeletonItIsSampling) {
    const Owned from(test::build_file(test::packed_spec(20, 30, 16)));
    const Owned to(test::build_file(test::packed_spec(20, 30, 16)));
    Binding binding(*from, *to);
    EXPECT_TRUE(binding.unmatched_joints().empty());
    Pose expected(*from);
    Pose pose(*to);
    for (const float seconds : {0.0f, 0.61f, 1.2f, 9.0f}) {
        ASSERT_TRUE(sample(expected, from->clip("packed"), seconds));
        ASSERT_TRUE(sample(pose, binding, from->clip("packed"), seconds));
        for (std::uint32_t k = 0; k < 20; ++k) {
            EXPECT_EQ(pose.local(k).rotation, expected.local(k).rotation);
            EXPECT_EQ(pose.local(k).translation, expected.local(k).translation);
            EXPECT_EQ(pose.local(k).scale, expected.local(k).scale);
        }
    }
}

}  // namespace
}  // namespace bendy::binding_test
