#include "build_scene.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace bendy::converter::attach_rig_test {
namespace {

using namespace test;

/// The largest angle that marks which entry a joint took, in degrees; -1: none.
std::vector<int> marks_of(const Scene& scene) {
    std::vector<int> marks;
    for (const Joint& joint : scene.joints) {
        marks.push_back(joint.constraints.empty()
                            ? -1
                            : static_cast<int>(joint.constraints[0].rotation_max[0] * 180.0f / 3.14159265f + 0.5f));
    }
    return marks;
}

std::string mark(const std::string& key, int degrees) {
    return '"' + key + R"(": {"model": "largest_angle", "angle": )" + std::to_string(degrees) + "}";
}

TEST(AttachRig, NumberThenNameThenLastGlob) {
    Scene scene = make_row({"Hip", "Knee.L", "Knee.L", "Knee.R", ""});
    Report report;
    attach(scene,
           R"("joints": {)" + mark("#1", 10) + ", " + mark("Knee.L", 20) + ", " + mark("*", 30) + ", " +
               mark("Knee*", 40) + ", " + mark("Nobody", 50) + "}",
           report);
    EXPECT_EQ(marks_of(scene), (std::vector{30, 10, 20, 40, 30}));
    EXPECT_EQ(lines_of(report), std::vector<std::string>{"joints.Nobody: no joint takes 'Nobody'"});
}

TEST(AttachRig, AnEntryReplacesAndAnEmptyOneTakesAway) {
    Scene scene = make_row({"a", "b", "c"});
    for (Joint& joint : scene.joints) joint.constraints.resize(1);
    Report report;
    attach(scene, R"("joints": {"a": [], "b": [{"model": "free"}, {"model": "locked", "scope": "ik_only"}]})", report);
    EXPECT_TRUE(scene.joints[0].constraints.empty());
    EXPECT_EQ(scene.joints[1].constraints.size(), 2u);
    EXPECT_EQ(scene.joints[2].constraints.size(), 1u);
    EXPECT_TRUE(report.warnings().empty());
}

TEST(AttachRig, WhatIsClaimedStays) {
    Scene scene = make_row({"a", "b"});
    const JointIndex index(scene);
    Claims claims{std::vector<bool>(2), {}};
    Report report;
    const std::string chain = R"("chains": [{"name": "arm", "start": "a", "effector": "b", "priority": )";
    attach_rig(scene, parse(R"("joints": {"a": []}, )" + chain + "1}]"), index, claims, report);
    attach_rig(scene,
               parse(R"("joints": {)" + mark("*", 30) + "}, " + chain +
                     R"(2}, {"name": "leg", "start": "a", "effector": "a"}])"),
               index, claims, report);
    EXPECT_EQ(marks_of(scene), (std::vector{-1, 30}));
    ASSERT_EQ(scene.chains.size(), 2u);
    EXPECT_EQ(scene.chains[0].record.priority, 1);
    EXPECT_EQ(scene.chains[1].name, "leg");
}

TEST(AttachRig, ARestPoseOutsideIsFlaggedAndNamed) {
    Scene scene = make_row({"a", "b"});
    Report report;
    attach(scene,
           R"("joints": {"a": {"model": "hinge", "x": [10, 20]},)"
           R"( "b": {"model": "hinge", "x": [10, 20], "rest_outside": true}})",
           report);
    EXPECT_EQ(scene.joints[0].constraints[0].flags, kRestOutside);
    EXPECT_EQ(scene.joints[1].constraints[0].flags, kRestOutside);
    EXPECT_EQ(lines_of(report), std::vector<std::string>{"joints.a: the rest pose of joint 'a' is outside its limits"});
}

TEST(AttachRig, ChainsFindTheirJoints) {
    Scene scene = make_row({"root", "arm", "arm", "hand", "#3"});
    Report report;
    attach(scene,
           R"("chains": [{"name": "c", "start": "arm", "effector": "#3", "target": "#4", "pole": "root",)"
           R"( "weights": {"#2": 0.25, "h*": 0.5, "arm": 0.75, "x*": 1}}])",
           report);
    const Chain& chain = scene.chains.at(0);
    EXPECT_EQ(chain.record.start, 1u);
    EXPECT_EQ(chain.record.effector, 3u);
    EXPECT_EQ(chain.record.target, 4u);
    EXPECT_EQ(chain.record.pole, 0u);
    ASSERT_EQ(chain.weights.size(), 3u);
    std::vector<std::pair<std::uint32_t, float>> weights;
    for (const Chain::Weight& weight : chain.weights) weights.emplace_back(weight.joint, weight.weight);
    std::sort(weights.begin(), weights.end());
    EXPECT_EQ(weights, (std::vector<std::pair<std::uint32_t, float>>{{1, 0.75f}, {2, 0.25f}, {3, 0.5f}}));
    EXPECT_TRUE(report.warnings().empty());
}

TEST(AttachRig, ChainsThatCannotBeAreRefused) {
    Scene scene = make_scene({{"root"}, {"left", 0}, {"right", 0}});
    const auto error = [&](const std::string& members) {
        Report report;
        const std::string text = failure_of([&] {
            attach(scene, R"("joints": {"root": {"model": "locked"}}, "chains": [{"name": "c", )" + members + "}]",
                   report);
        });
        EXPECT_TRUE(scene.chains.empty() && scene.joints[0].constraints.empty());
        return text;
    };
    EXPECT_EQ(error(R"("start": "nobody", "effector": "left")"), "chains[0].start: there is no joint 'nobody'");
    EXPECT_EQ(error(R"("start": "Root", "effector": "left")"),
              "chains[0].start: there is no joint 'Root'; did you mean \"root\"?");
    EXPECT_EQ(error(R"("start": "root", "effector": "#3")"), "chains[0].effector: there is no joint '#3'");
    EXPECT_EQ(error(R"("start": "root", "effector": "left", "pole": "l*")"), "chains[0].pole: there is no joint 'l*'");
    EXPECT_EQ(error(R"("start": "left", "effector": "right")"),
              "chains[0].start: joint 'left' is neither 'right' itself nor above it");
    EXPECT_EQ(error(R"("start": "left", "effector": "root")"),
              "chains[0].start: joint 'left' is neither 'root' itself nor above it");
    EXPECT_EQ(error(R"("start": "root", "effector": "left", "weights": {"right": 1})"),
              "chains[0].weights.right: the chain has no such joint");
    EXPECT_EQ(error(R"("start": "root", "effector": "left", "weights": {"#2": 1})"),
              "chains[0].weights.'#2': the chain has no such joint");
}

TEST(AttachRig, ManyExactEntriesAndJointsAreNoTrouble) {
    constexpr std::size_t kJoints = 65'000;
    std::vector<std::string> names;
    std::string entries;
    for (std::size_t i = 0; i < kJoints; ++i) {
        names.push_back("joint " + std::to_string(i));
        entries += (i == 0 ? "" : ",") + mark(names.back(), 30);
    }
    Scene scene = make_row(names);
    Report report;
    attach(scene, R"("joints": {)" + entries + "}", report);
    EXPECT_EQ(scene.joints.back().constraints.size(), 1u);
    EXPECT_TRUE(report.warnings().empty());
}

TEST(AttachRig, ManyGlobsForManyJointsAreRefused) {
    constexpr std::size_t kJoints = 65'000;
    std::string entries;
    for (std::size_t i = 0; i < 100'000; ++i) entries += (i == 0 ? "\"*" : ",\"*") + std::to_string(i) + "?\":[]";
    Scene scene = make_row(std::vector<std::string>(kJoints, "x"));
    Report report;
    EXPECT_EQ(failure_of([&] { attach(scene, R"("joints": {)" + entries + "}", report); }),
              "its keys, chains and weights take too long to match with so many joints");
}

TEST(AttachRig, ManyWeightsOfManyChainsAreRefused) {
    constexpr std::size_t kJoints = 65'000;
    std::string chains;
    for (std::size_t i = 0; i < 1'000; ++i) {
        chains += (i == 0 ? R"({"name": ")" : R"(,{"name": ")") + std::to_string(i) +
                  R"(", "start": "#0", "effector": "#64999", "weights": {"*": 0.5}})";
    }
    Scene scene = make_row(std::vector<std::string>(kJoints, "x"));
    Report report;
    EXPECT_NE(failure_of([&] { attach(scene, R"("chains": [)" + chains + "]", report); }), "no error");
    EXPECT_TRUE(scene.chains.empty());
}

TEST(AttachRig, OfManyEntriesThatNoJointTakesTheFirstAreNamed) {
    std::string entries;
    for (std::size_t i = 0; i < 1'000; ++i) entries += (i == 0 ? "\"e" : ",\"e") + std::to_string(i) + "\":[]";
    Scene scene = make_row({"x"});
    Report report;
    attach(scene, R"("joints": {)" + entries + "}", report);
    const std::vector<std::string> lines = lines_of(report);
    ASSERT_EQ(lines.size(), 21u);
    EXPECT_EQ(lines[19], "joints.e19: no joint takes 'e19'");
    EXPECT_EQ(lines[20], "joints.e20: no joint takes this entry either (980 times)");
}

}  // namespace
}  // namespace bendy::converter::attach_rig_test
