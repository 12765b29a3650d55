#include <bendy/runtime/constrain.h>
#include <bendy/runtime/retarget.h>

#include "mutation/allocations.h"
#include "retarget/target_names.h"
#include "runtime/human_model.h"
#include "runtime/local_joints.h"
#include "runtime/posed_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

// Directions and turns are judged by joint matrices alone; where the bodies face is said by the tests.
namespace bendy::retarget_test {
namespace {

using test::angle_of;
using test::HumanModel;
using test::HumanSpec;
using test::kDirections;
using test::made;

constexpr float kHand = 0.03f;  // metres: half the edge of a hand
constexpr float kInf = std::numeric_limits<float>::infinity();
const std::vector<std::pair<std::string, std::string>> kLimbs{
    {"leftArm", "leftForeArm"},    {"leftForeArm", "leftHand"}, {"rightArm", "rightForeArm"},
    {"rightForeArm", "rightHand"}, {"leftUpLeg", "leftLeg"},    {"leftLeg", "leftFoot"},
    {"rightUpLeg", "rightLeg"},    {"rightLeg", "rightFoot"}};

/// A human and a pose of it.
class Human : public test::PosedBody<HumanModel> {
public:
    explicit Human(const HumanSpec& spec) : PosedBody(HumanModel(spec), spec.facing) {}
};

template <typename Body>
double worst_direction(Body& source, Body& target) {
    double worst = 0.0;
    for (const auto& [from, to] : kLimbs)
        worst = std::max(worst, glm::length(source.way(from, to) - target.way(from, to)));
    return worst;
}

TEST(Retarget, LimbsHaveTheSourcesDirections) {
    const std::vector<HumanSpec> targets{
        {.axes = 2},
        {.facing = 90.0, .axes = 3},
        {.facing = 37.0, .axes = 0},
        {.is_z_up = true, .axes = 4},
        {.arms_down = 50.0, .axes = 5},
        {.thigh = 0.3, .shin = 0.5, .hip_width = 0.3, .axes = 6},
        {.facing = 90.0, .is_detached = true, .axes = 8},
        {.is_detached = true, .has_loose_arms = true, .axes = 9},
        {.facing = 90.0, .is_detached = true, .has_loose_spine = true, .axes = 10},
        {.facing = 180.0,
         .is_z_up = true,
         .arms_down = 30.0,
         .spine = 1,
         .has_neck = false,
         .has_toes = false,
         .has_fingers = false,
         .axes = 7},
    };
    for (const HumanSpec& from : {HumanSpec{}, HumanSpec{.facing = -90.0, .is_z_up = true, .arms_down = 45.0}}) {
        Human source(from);
        for (const HumanSpec& to : targets) {
            Human target(to);
            Retarget retargeted = made(source, target, kDirections);
            for (unsigned seed = 0; seed < 20; ++seed) {
                source.pose_at_random(seed, 0.4);
                RetargetState state;
                ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
                EXPECT_LT(worst_direction(source, target), 2e-5) << seed << ", axes " << to.axes;
            }
        }
    }
}

TEST(Retarget, JointsTurnAsTheSources) {
    Human source(HumanSpec{});
    for (const HumanSpec& to : {HumanSpec{.axes = 2}, HumanSpec{.facing = 90.0, .axes = 3},
                                HumanSpec{.is_z_up = true, .thigh = 0.9, .shin = 0.84, .axes = 4}}) {
        Human target(to);
        Retarget retargeted = made(source, target, kDirections);
        for (unsigned seed = 0; seed < 10; ++seed) {
            source.pose_at_random(seed, 0.4);
            RetargetState state;
            ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
            for (const char* name : {"hips", "spine0", "spine2", "neck", "head", "leftShoulder", "leftArm",
                                     "rightForeArm", "leftHand", "leftMiddle2", "rightLeg", "leftFoot", "rightToes"})
                EXPECT_LT(angle_of(source.turn(name), target.turn(name)), 2e-5) << name;
        }
    }
}

TEST(Retarget, AnArmThatHangsAtRestTurnsAboutItsAxisAsOneThatIsStretchedOut) {
    Human source(HumanSpec{.axes = 0});
    Human target(HumanSpec{.arms_down = 60.0, .axes = 2});
    Retarget retargeted = made(source, target, kDirections);
    RetargetState state;
    source.turn_by("leftHand", {1, 0, 0}, 40.0);
    ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
    // From rest the target's arm is lifted by 60 degrees, then its hand turned by 40.
    const glm::dquat lifted = glm::angleAxis(M_PI / 3.0, glm::dvec3(0, 0, 1));
    EXPECT_LT(angle_of(target.turn("leftArm"), lifted), 1e-5);
    EXPECT_LT(angle_of(target.turn("leftHand"), glm::angleAxis(40.0 * M_PI / 180.0, glm::dvec3(1, 0, 0)) * lifted),
              1e-5);
}

TEST(Retarget, BonesOfAnOddRestPoseHaveTheSourcesDirections) {
    const std::vector<std::pair<std::string, std::string>> kTrunk{
        {"spine0", "spine1"},     {"spine1", "spine2"},        {"spine2", "neck"},
        {"neck", "head"},         {"leftShoulder", "leftArm"}, {"rightShoulder", "rightArm"},
        {"leftFoot", "leftToes"}, {"rightFoot", "rightToes"}};
    Human plain(HumanSpec{.axes = 2});
    for (const HumanSpec& spec :
         {HumanSpec{.collars_up = 90.0}, HumanSpec{.feet_down = 55.0}, HumanSpec{.bent = 40.0}, HumanSpec{.bent = 18.0},
          HumanSpec{.facing = 90.0, .collars_up = 60.0, .feet_down = 60.0, .bent = 35.0}}) {
        Human odd(spec);
        for (const auto& [source, target] : {std::pair(&plain, &odd), std::pair(&odd, &plain)}) {
            Retarget retargeted = made(*source, *target, kDirections);
            for (unsigned seed = 0; seed < 10; ++seed) {
                source->pose_at_random(seed, 0.4);
                RetargetState state;
                ASSERT_TRUE(retarget(target->pose(), retargeted, source->pose(), state));
                EXPECT_LT(worst_direction(*source, *target), 2e-5);
                for (const auto& [from, to] : kTrunk)
                    EXPECT_LT(glm::length(source->way(from, to) - target->way(from, to)), 2e-5) << from;
            }
        }
    }
}

/// As CMU's, whose neck begins where the spine's last joint is.
TEST(Retarget, ABoneWithoutLengthPointsAsTheOneBeforeIt) {
    HumanModel odd(HumanSpec{.bent = 40.0, .axes = 3});
    odd.spec.joints[odd.joint("neck")].rest.translation = {0.0f, 0.0f, 0.0f};
    test::PosedBody<HumanModel> source(odd, 0.0), target(HumanModel(HumanSpec{}), 0.0);
    Retarget retargeted = made(source, target, kDirections);
    RetargetState state;
    ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
    EXPECT_LT(glm::length(source.way("spine1", "spine2") - target.way("spine2", "neck")), 2e-5);
}

TEST(Retarget, BonesThatDifferAsThoseOfRigsDoTurnAsTheSources) {
    Human source(HumanSpec{});
    Human target(HumanSpec{.collars_up = 30.0, .feet_down = 20.0, .bent = 10.0, .axes = 2});
    Retarget retargeted = made(source, target, kDirections);
    for (unsigned seed = 0; seed < 10; ++seed) {
        source.pose_at_random(seed, 0.4);
        RetargetState state;
        ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
        for (const char* name : {"spine0", "spine2", "neck", "head", "leftShoulder", "rightShoulder", "leftFoot"})
            EXPECT_LT(angle_of(source.turn(name), target.turn(name)), 2e-5) << name;
    }
}

TEST(Retarget, RotationsOfTheSameRigMeanTheSameHoweverItRests) {
    HumanModel walking(HumanSpec{.axes = 3});
    std::uint32_t turned = 0;
    for (auto& joint : walking.spec.joints) {  // as in a frame of a walk
        const auto& q = joint.rest.rotation;
        const double angle = 0.3 * std::sin(static_cast<double>(++turned));
        if (turned < 3) continue;
        const glm::dquat own = glm::dquat(q[3], q[0], q[1], q[2]) * glm::angleAxis(angle, glm::dvec3(0.6, 0.8, 0.0));
        joint.rest.rotation = {static_cast<float>(own.x), static_cast<float>(own.y), static_cast<float>(own.z),
                               static_cast<float>(own.w)};
    }
    walking.spec.joints[1].rest.translation[1] -= 0.2f;  // crouched
    test::PosedBody<HumanModel> source(walking, 0.0), target(HumanModel(HumanSpec{.axes = 3}), 0.0);
    for (const bool is_back : {false, true}) {
        test::PosedBody<HumanModel>& from = is_back ? target : source;
        test::PosedBody<HumanModel>& to = is_back ? source : target;
        Retarget retargeted = made(from, to, kDirections);
        EXPECT_FLOAT_EQ(retargeted.scale(), 1.0f);
        for (unsigned seed = 0; seed < 10; ++seed) {
            from.pose_at_random(seed, 0.4);
            RetargetState state;
            ASSERT_TRUE(retarget(to.pose(), retargeted, from.pose(), state));
            for (const char* name :
                 {"hips", "spine1", "head", "leftShoulder", "rightHand", "leftMiddle2", "rightFoot", "leftToes"}) {
                EXPECT_LT(glm::length(from.place(name) - to.place(name)), 2e-5) << name;
                const glm::dquat wanted(from.pose().local(from.joint(name)).rotation);
                EXPECT_LT(angle_of(wanted, glm::dquat(to.pose().local(to.joint(name)).rotation)), 2e-5) << name;
            }
        }
    }
}

TEST(Retarget, OfTheSameRigAndRestEachStandsOnItsOwnGround) {
    HumanModel raised(HumanSpec{.axes = 3});
    raised.spec.joints[1].rest.translation[1] += 0.05f;  // the hips
    test::PosedBody<HumanModel> source(raised, 0.0), target(HumanModel(HumanSpec{.axes = 3}), 0.0);
    const double stands = target.place("hips").y;
    Retarget retargeted = made(source, target, kDirections);
    RetargetState state;
    ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
    EXPECT_NEAR(target.place("hips").y, stands, 1e-5);
}

TEST(Retarget, WhatOneOfTheTwoDoesNotHaveGoesAlong) {
    const HumanSpec whole{.axes = 2};
    for (const HumanSpec& half :
         {HumanSpec{.has_arms = false}, HumanSpec{.has_hands = false}, HumanSpec{.has_head = false},
          HumanSpec{.has_arms = false, .has_head = false, .has_neck = false}}) {
        for (const auto& [from, to] : {std::pair(whole, half), std::pair(half, whole)}) {
            Human source(from), target(to);
            Retarget retargeted = made(source, target, kDirections);
            for (unsigned seed = 0; seed < 5; ++seed) {
                source.pose_at_random(seed, 0.3);
                RetargetState state;
                ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
                for (const char* side : {"left", "right"}) {
                    const std::string s = side;
                    EXPECT_LT(glm::length(source.way(s + "UpLeg", s + "Leg") - target.way(s + "UpLeg", s + "Leg")),
                              2e-5);
                    if (!half.has_arms) continue;
                    EXPECT_LT(glm::length(source.way(s + "Arm", s + "ForeArm") - target.way(s + "Arm", s + "ForeArm")),
                              2e-5);
                }
                EXPECT_LT(angle_of(source.turn("spine2"), target.turn("spine2")), 2e-5);
                if (from.has_arms || !to.has_arms) continue;
                EXPECT_LT(angle_of(target.turn("leftHand"), target.turn("spine2")), 2e-5) << "at rest";
            }
        }
    }
}

TEST(Retarget, PartsThatHangOnAControlGoWithTheBody) {
    for (const HumanSpec& spec :
         {HumanSpec{.is_detached = true, .has_loose_arms = true, .axes = 2},
          HumanSpec{.is_detached = true, .has_loose_spine = true, .axes = 3},
          HumanSpec{.is_detached = true, .has_loose_arms = true, .has_loose_spine = true, .axes = 4}}) {
        Human source(HumanSpec{}), target(spec);
        const std::vector<std::pair<std::string, std::string>> kSeams{
            {"hips", "spine0"}, {"spine2", "leftShoulder"}, {"spine2", "rightShoulder"}, {"spine2", "neck"}};
        const auto place_on = [&](const std::string& carrier, const std::string& joint) {
            return glm::conjugate(target.turn(carrier)) * (target.place(joint) - target.place(carrier));
        };
        std::vector<glm::dvec3> rest;
        for (const auto& [carrier, joint] : kSeams) rest.push_back(place_on(carrier, joint));
        Retarget retargeted = made(source, target, kDirections);
        for (unsigned seed = 0; seed < 10; ++seed) {
            source.pose_at_random(seed, 0.4);
            RetargetState state;
            ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
            for (std::size_t k = 0; k < kSeams.size(); ++k)
                EXPECT_LT(glm::length(place_on(kSeams[k].first, kSeams[k].second) - rest[k]), 2e-5) << kSeams[k].second;
        }
    }
}

TEST(Retarget, TheHipsTravelWithTheLengthOfTheLegs) {
    Human source(HumanSpec{});
    Human target(HumanSpec{.facing = 90.0, .is_z_up = true, .thigh = 0.9, .shin = 0.84, .axes = 3});
    Retarget retargeted = made(source, target, kDirections);
    EXPECT_NEAR(retargeted.scale(), 2.0f, 1e-3f);
    const glm::dvec3 rest = target.place("hips");
    source.pose_at_random(3, 0.3);
    RetargetState state;
    ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
    const double scale = retargeted.scale();
    const auto middle = [](Human& human) { return 0.5 * (human.place("leftUpLeg") + human.place("rightUpLeg")); };
    const glm::dvec3 travelled = middle(source) - glm::dvec3(0, 0.95, 0);
    EXPECT_LT(glm::length(middle(target) - glm::dvec3(0, 1.82, 0) - scale * travelled), 2e-4);
    EXPECT_GT(glm::length(target.place("hips") - rest), 0.1);
}

TEST(Retarget, ColumnsOfOtherNumbersShareTheirTurn) {
    for (const std::uint32_t from : {1u, 2u, 3u}) {
        Human source(HumanSpec{.spine = from, .axes = 2});
        const std::string last = "spine" + std::to_string(from - 1);
        source.turn_by("hips", {0, 1, 0}, 20.0);
        source.turn_by("spine0", {1, 0, 0}, 30.0);
        source.turn_by("head", {0, 0, 1}, 25.0);
        for (const std::uint32_t to : {1u, 2u, 3u}) {
            Human target(HumanSpec{.spine = to, .has_neck = to != 2, .axes = 3});
            Retarget retargeted = made(source, target, kDirections);
            RetargetState state;
            ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
            EXPECT_LT(angle_of(source.turn(last), target.turn("spine" + std::to_string(to - 1))), 2e-5);
            EXPECT_LT(angle_of(source.turn("head"), target.turn("head")), 2e-5);
        }
    }
    Human source(HumanSpec{.spine = 1});
    Human target(HumanSpec{.spine = 3, .axes = 3});
    source.turn_by("spine0", {1, 0, 0}, 30.0);
    Retarget retargeted = made(source, target, kDirections);
    RetargetState state;
    ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
    for (int k = 0; k < 3; ++k) {
        const glm::dquat part = glm::angleAxis((k + 1) * 10.0 * M_PI / 180.0, glm::dvec3(1, 0, 0));
        EXPECT_LT(angle_of(target.turn("spine" + std::to_string(k)), part), 2e-5);
    }
}

TEST(Retarget, AMissingNeckGivesItsTurnToTheHead) {
    Human source(HumanSpec{.has_neck = false});
    Human target(HumanSpec{.axes = 3});
    source.turn_by("head", {0, 1, 0}, 40.0);
    Retarget retargeted = made(source, target, kDirections);
    RetargetState state;
    ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
    EXPECT_LT(angle_of(target.turn("neck"), glm::angleAxis(20.0 * M_PI / 180.0, glm::dvec3(0, 1, 0))), 2e-5);
    EXPECT_LT(angle_of(target.turn("head"), source.turn("head")), 2e-5);
}

TEST(Retarget, PosesOfTheSameBuildAreCopiedBitByBit) {
    const HumanSpec spec{.axes = 9, .prefix = "a_"};
    Human source(spec);
    for (const std::string prefix : {"a_", "b_"}) {
        HumanSpec other = spec;
        other.prefix = prefix;
        Human target(other);
        Retarget retargeted = made(source, target);
        RetargetState state;
        for (unsigned seed = 0; seed < 10; ++seed) {
            source.pose_at_random(seed, 0.2);
            test::local_of(source.pose(), source.joint("sword"))->scale = {2, 3, 4};
            test::local_of(source.pose(), source.joint("root"))->translation = {1, 2, 3};
            const auto done = retarget(target.pose(), retargeted, source.pose(), state);
            ASSERT_TRUE(done);
            EXPECT_EQ(done->lowered, 0.0f);
            const auto from = source.pose().local_blocks();
            const auto to = target.pose().local_blocks();
            EXPECT_EQ(std::memcmp(from.data(), to.data(), from.size_bytes()), 0) << seed;
        }
    }
}

TEST(Retarget, ThereAndBackIsTheSamePose) {
    Human source(HumanSpec{});
    Human target(HumanSpec{.facing = 90.0, .is_z_up = true, .arms_down = 40.0, .thigh = 0.7, .axes = 3});
    Human back(HumanSpec{});
    Retarget there = made(source, target, kDirections);
    Retarget and_back = made(target, back, kDirections);
    for (unsigned seed = 0; seed < 10; ++seed) {
        source.pose_at_random(seed, 0.3);
        RetargetState state;
        ASSERT_TRUE(retarget(target.pose(), there, source.pose(), state));
        ASSERT_TRUE(retarget(back.pose(), and_back, target.pose(), state));
        for (const JointRole& role : source.model().roles()) {
            EXPECT_LT(angle_of(glm::dquat(source.pose().local(role.joint).rotation),
                               glm::dquat(back.pose().local(role.joint).rotation)),
                      1e-4)
                << source.model().joints()[role.joint].name;
        }
        EXPECT_LT(glm::length(source.place("hips") - back.place("hips")), 1e-4);
    }
}

TEST(Retarget, PropsOfTheSameNameComeAlong) {
    Human source(HumanSpec{.prefix = "a_"});
    Human target(HumanSpec{.is_z_up = true, .thigh = 0.9, .shin = 0.84, .axes = 3, .prefix = "b_"});
    const glm::dvec3 rest = target.place("sword") - target.place("leftHand");
    const glm::dvec3 source_rest = source.place("sword") - source.place("leftHand");
    source.turn_by("sword", {0, 1, 0}, 50.0);
    test::local_of(source.pose(), source.joint("sword"))->translation += glm::vec3(0.1, 0.0, 0.02);
    test::local_of(source.pose(), source.joint("sword"))->scale *= 3.0f;
    const glm::dvec3 moved = source.place("sword") - source.place("leftHand") - source_rest;
    Retarget retargeted = made(source, target, kDirections);
    RetargetState state;
    ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
    EXPECT_EQ(retargeted.joints()[target.joint("sword")], source.joint("sword"));
    EXPECT_LT(angle_of(source.turn("sword"), target.turn("sword")), 1e-5);
    EXPECT_LT(glm::length(target.place("sword") - target.place("leftHand") - rest - double{retargeted.scale()} * moved),
              1e-5);
    EXPECT_NEAR(target.pose().local(target.joint("sword")).scale.y, 3.0f, 1e-5f);
}

test::Node target_node(const std::string& name) {
    return test::make_container(FourCC("TARG"),
                                {test::make_leaf(FourCC("NAME"), std::as_bytes(std::span(name))),
                                 test::make_leaf(FourCC("TINF"), bytes_of(MorphTargetRecord{})),
                                 test::make_leaf(FourCC("POSI"), test::stream_payload<float>(3, {0, 1, 0}))});
}

TEST(Retarget, MorphTargetsOfTheSameNameComeAlong) {
    const auto with_face = [](const HumanSpec& human, const std::vector<std::string>& names) {
        test::ModelSpec spec = HumanModel(human).spec;
        test::MeshSpec mesh;
        mesh.joint = 0;
        mesh.positions = {{0, 0, 0}};
        for (const std::string& name : names) mesh.more.push_back(target_node(name));
        spec.meshes.push_back(mesh);
        return test::build_file(spec);
    };
    const test::Owned source(with_face({}, {"smile", "frown"}));
    const test::Owned target(with_face({.axes = 2}, {"blink", "frown"}));
    auto retargeted = Retarget::make(*source, *target);
    ASSERT_TRUE(retargeted);
    Pose from(*source), to(*target);
    from.change_morph_weights()[0] = 0.25f;
    from.change_morph_weights()[1] = 0.75f;
    RetargetState state;
    ASSERT_TRUE(retarget(to, *retargeted, from, state));
    EXPECT_EQ(to.morph_weights()[0], 0.0f);
    EXPECT_EQ(to.morph_weights()[1], 0.75f);
    EXPECT_EQ(retargeted->morph_targets()[0], kNone);
}

TEST(Retarget, MorphTargetsFollowInOtherSpellings) {
    EXPECT_EQ(target_key("eyeBlinkLeft"), target_key("EyeBlink_L"));
    EXPECT_EQ(target_key("eyeBlinkLeft"), target_key("Head.eye blink.l"));
    EXPECT_EQ(target_key("jawOpen"), target_key("blendShape1.jawOpen"));
    EXPECT_EQ(target_key("jawRight"), target_key("ARKit_jaw_R"));
    EXPECT_NE(target_key("mouthSmileLeft"), target_key("mouthSmileRight"));
    EXPECT_NE(target_key("A.Smile"), target_key("B.Smile"));  // not of ARKit
    EXPECT_EQ(target_key("A.Smile"), target_key("a_smile"));
    EXPECT_EQ(target_key("._"), "");
}

/// An elbow that bends by an angle of any axis at most.
ConstraintRecord largest_bend(double degrees) {
    ConstraintRecord record;
    record.model = static_cast<std::uint8_t>(ConstraintModel::largest_angle);
    record.rotation_max = {static_cast<float>(degrees * M_PI / 180.0), kInf, kInf};
    return record;
}

TEST(Retarget, StaysInsideTheTargetsConstraints) {
    Human source(HumanSpec{});
    Human target(HumanSpec{.axes = 3, .elbows = {largest_bend(30.0)}});
    Retarget retargeted = made(source, target);
    RetargetState state;
    source.turn_by("leftForeArm", {0, 1, 0}, -20.0);
    auto done = retarget(target.pose(), retargeted, source.pose(), state);
    ASSERT_TRUE(done);
    EXPECT_EQ(done->turned, 0.0f);
    EXPECT_EQ(done->turned_joint, kNone);
    EXPECT_LT(worst_direction(source, target), 2e-5);
    source.turn_by("leftForeArm", {0, 1, 0}, -60.0);
    done = retarget(target.pose(), retargeted, source.pose(), state);
    ASSERT_TRUE(done);
    EXPECT_NEAR(done->turned, 50.0 * M_PI / 180.0, 1e-3);
    EXPECT_EQ(done->turned_joint, target.joint("leftForeArm"));
    EXPECT_GT(done->missed, 0.0f);
    for (const Constraint& constraint : target.model().constraints()) {
        const JointTransform& rest = target.model().joints()[constraint.joint].rest;
        const glm::quat local = target.pose().local(constraint.joint).rotation;
        EXPECT_LT(violation(constraint, to_constraint_space(constraint, rest.rotation, local)), 1e-5);
    }
    RetargetOptions without;
    without.limits = Limits::off;
    Retarget free = made(source, target, without);
    done = retarget(target.pose(), free, source.pose(), state);
    ASSERT_TRUE(done);
    EXPECT_EQ(done->turned, 0.0f);
    EXPECT_LT(worst_direction(source, target), 2e-5);
}

/// Brings a foot to a place, in axes of the body, level as at rest.
void put_foot(Human& human, const std::string& side, const glm::dvec3& place) {
    ReachOptions options;
    options.pole = glm::vec3(human.to_model(human.place(side + "Leg") + glm::dvec3(0, 0, 0.5)));
    const Chain* chain = human.model().chain(side == "left" ? "0" : "1");
    const auto reached = reach(human.pose(), chain, glm::vec3(human.to_model(place)), options);
    ASSERT_TRUE(reached && reached->status == ReachStatus::reached);
    human.level(side + "Foot");
}

/// Both feet stay on the ground while the hips sway, sink and turn.
void sway(Human& human, double phase) {
    human.pose().set_rest();
    const glm::dvec3 left = human.place("leftFoot"), right = human.place("rightFoot");
    human.turn_by("hips", {0, 1, 0}, 15.0 * std::sin(phase));
    test::local_of(human.pose(), human.joint("hips"))->translation +=
        glm::vec3(0.06 * std::sin(phase), -0.1 + 0.04 * std::cos(phase), 0.05 * std::sin(2.0 * phase));
    put_foot(human, "left", left);
    put_foot(human, "right", right);
}

/// Also in the constraints' tests: other builds.
const std::vector<HumanSpec> kBuilds{
    {.axes = 2},
    {.facing = 90.0, .thigh = 0.35, .shin = 0.5, .hip_width = 0.35, .axes = 3},
    {.is_z_up = true, .arms_down = 40.0, .thigh = 0.5, .shin = 0.35, .hip_width = 0.12, .axes = 4},
    {.facing = 180.0, .thigh = 0.2, .shin = 0.22, .hip_width = 0.3, .has_toes = false, .axes = 5},
    {.thigh = 0.5, .shin = 0.35, .is_detached = true, .axes = 6},
    {.thigh = 0.5, .shin = 0.35, .is_detached = true, .has_split_thighs = true, .axes = 7},
};

TEST(Retarget, ProposedLimitsAreSoftAndAuthoredOnesAreHard) {
    const double radian = M_PI / 180.0;
    for (const bool is_proposed : {false, true}) {
        ConstraintRecord bend = largest_bend(30.0);
        if (is_proposed) bend.flags = kProposed;
        Human source(HumanSpec{}), target(HumanSpec{.elbows = {bend}});
        const auto beyond = [&](Limits limits, double degrees) {
            Retarget retargeted = made(source, target, {RestPoses::measured, limits, false});
            source.pose().set_rest();
            source.turn_by("leftForeArm", {0, 1, 0}, -degrees);
            RetargetState state;
            const auto done = retarget(target.pose(), retargeted, source.pose(), state);
            EXPECT_TRUE(done);
            const std::uint32_t elbow = target.joint("leftForeArm");
            const glm::quat rest = target.model().joints()[elbow].rest.rotation,
                            now = target.pose().local(elbow).rotation;
            const double turned = angle_of(glm::dquat(rest), glm::dquat(now)) / radian;
            EXPECT_NEAR(done->turned / radian, degrees - turned, 0.01);
            return turned - 30.0;
        };
        EXPECT_NEAR(beyond(Limits::hard, 80.0), 0.0, 1e-3);
        EXPECT_NEAR(beyond(Limits::off, 80.0), 50.0, 1e-3);
        EXPECT_NEAR(beyond(Limits::soft, 80.0), is_proposed ? 50.0 / (1.0 + 50.0 / 15.0) : 0.0, 1e-3);
        EXPECT_NEAR(beyond(Limits::soft, 31.0), is_proposed ? 1.0 / (1.0 + 1.0 / 15.0) : 0.0, 1e-3);
        EXPECT_LT(beyond(Limits::soft, 170.0), 15.0);
    }
}

TEST(Retarget, AnElbowThatBendsToOneSideIsTurnedByTheShoulder) {
    ConstraintRecord hinge;
    hinge.model = static_cast<std::uint8_t>(ConstraintModel::hinge);
    hinge.rotation_min = {-0.1f, 0.0f, 0.0f};
    hinge.rotation_max = {2.5f, 0.0f, 0.0f};
    hinge.frame = {0.0f, 0.0f, -std::sqrt(0.5f), std::sqrt(0.5f)};  // its X is -Y: it bends the left forearm forwards
    Human source(HumanSpec{.axes = 0}), target(HumanSpec{.axes = 0, .elbows = {hinge}});
    Retarget retargeted = made(source, target, {RestPoses::measured, Limits::hard, false});
    const auto off = [&](double about, double bend) {
        source.pose().set_rest();
        source.turn_by("leftForeArm", {0, -1, 0}, bend);
        source.turn_by("leftForeArm", {1, 0, 0}, about);
        RetargetState state;
        EXPECT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
        EXPECT_LT(glm::length(source.way("leftArm", "leftForeArm") - target.way("leftArm", "leftForeArm")), 1e-5);
        return glm::degrees(glm::length(source.way("leftForeArm", "leftHand") - target.way("leftForeArm", "leftHand")));
    };
    double last = 0.0;
    for (int about = -100; about <= 100; about += 5) {
        const double now = off(about, 70.0);
        EXPECT_LT(now, 2.0) << about;
        EXPECT_LT(std::abs(now - last), 2.0) << about;
        last = now;
    }
    for (int bend = 0; bend <= 140; bend += 5) EXPECT_LT(off(60.0, bend), 9.0) << bend;
    EXPECT_LT(off(60.0, 20.0), 2.0);
    EXPECT_GT(off(180.0, 70.0), 20.0);  // backwards it does not bend, and its shoulder does not turn half round
}

TEST(Retarget, AForearmThatTurnsRightRoundDoesNotJumpAtItsLimits) {
    ConstraintRecord bend;
    bend.model = static_cast<std::uint8_t>(ConstraintModel::swing_twist_pyramid);
    bend.rotation_min = {-1.5f, -kInf, -kInf};
    bend.rotation_max = {1.5f, kInf, kInf};
    Human source(HumanSpec{.axes = 0}), target(HumanSpec{.axes = 0, .elbows = {bend}});
    Retarget retarget = made(source, target, {RestPoses::measured, Limits::hard, false});
    RetargetState state;
    double step = 0.0;
    glm::dquat last(1, 0, 0, 0);
    for (int degrees = 0; degrees <= 360; degrees += 5) {
        source.pose().set_rest();
        source.turn_by("leftForeArm", glm::dvec3(1, 0, 0), degrees);
        ASSERT_TRUE(bendy::retarget(target.pose(), retarget, source.pose(), state));
        const glm::dquat now(target.pose().local(target.joint("leftForeArm")).rotation);
        if (degrees > 0) step = std::max(step, angle_of(last, now));
        last = now;
        EXPECT_LT(glm::length(source.way("leftForeArm", "leftHand") - target.way("leftForeArm", "leftHand")), 1e-5);
    }
    EXPECT_LT(step, 3.0 * 5.0 * M_PI / 180.0);
}

TEST(Retarget, FeetOfACrouchingBodyDoNotSinkIntoTheGround) {
    Human source(HumanSpec{}), target(HumanSpec{.thigh = 0.9, .shin = 0.3, .axes = 2});
    Retarget retarget = made(source, target);
    const double rest = target.place("leftFoot").y;
    const auto crouch = [&](double degrees) {
        source.pose().set_rest();
        for (const char* side : {"left", "right"}) {
            source.turn_by(std::string(side) + "UpLeg", glm::dvec3(1, 0, 0), -degrees);
            source.turn_by(std::string(side) + "Leg", glm::dvec3(1, 0, 0), 2.0 * degrees);
            source.level(std::string(side) + "Foot");
        }
        const double sunk = source.place("leftFoot").y;
        test::local_of(source.pose(), source.joint("hips"))->translation.y -= static_cast<float>(sunk - 0.08);
    };
    RetargetState state;
    for (double degrees = 0.0; degrees <= 60.0; degrees += 2.0) {
        crouch(degrees);
        ASSERT_TRUE(bendy::retarget(target.pose(), retarget, source.pose(), state));
        EXPECT_GT(target.place("leftFoot").y, rest - 0.02) << degrees;
    }
}

/// A human with soles, palms, and a seat so far below the hips; they are triangles of their joints.
test::PosedBody<HumanModel> with_skin(HumanSpec human, double seat, double palm) {
    human.axes = 0;
    HumanModel model(human);
    const auto triangle = [&](const std::string& joint, const glm::vec3& place) {
        const glm::vec3 x(0.1f, 0, 0), z(0, 0, 0.1f);
        model.spec.meshes.push_back({model.joint(joint), {place + x, place - x, place - z}, {}, {}, {0, 1, 2}, {}});
    };
    triangle("hips", {0, -seat, 0});
    for (const char* side : {"left", "right"}) {
        triangle(std::string(side) + "Foot", {0, -0.08, 0});
        triangle(std::string(side) + "Hand", {0, -palm, 0});
    }
    return {std::move(model), 0.0};
}

TEST(Retarget, WhoSitsIsOnTheGroundHoweverThick) {
    auto source = with_skin({}, 0.1, 0.03), target = with_skin({.thigh = 0.5, .shin = 0.35}, 0.25, 0.03);
    Retarget retargeted = made(source, target), free = made(source, target, kDirections);
    const auto seat_at = [&](Retarget& retarget, double height) {  // of the source's seat above the ground
        source.pose().set_rest();
        for (const char* side : {"left", "right"}) source.turn_by(std::string(side) + "UpLeg", {1, 0, 0}, -90.0);
        test::local_of(source.pose(), source.joint("hips"))->translation.y +=
            static_cast<float>(height + 0.1 - source.place("hips").y);
        RetargetState state;
        const auto done = bendy::retarget(target.pose(), retarget, source.pose(), state);
        EXPECT_TRUE(done);
        const float contact = done->contacts[static_cast<std::size_t>(Contact::body)];
        EXPECT_EQ(contact, &retarget == &free || height > 0.4 ? 0.0f : height < 0.1 ? 1.0f : contact);
        return target.place("hips").y - 0.25;
    };
    EXPECT_NEAR(seat_at(retargeted, 0.0), 0.0, 1e-4);
    EXPECT_NEAR(seat_at(retargeted, -0.1), 0.0, 1e-4);
    EXPECT_LT(seat_at(free, 0.0), -0.1);
    EXPECT_EQ(seat_at(retargeted, 0.6), seat_at(free, 0.6));
    double last = seat_at(retargeted, 0.0);
    for (int step = 1; step <= 60; ++step) {
        const double now = seat_at(retargeted, 0.01 * step);
        EXPECT_LT(std::abs(now - last), 0.035) << step;
        last = now;
    }
}

TEST(Retarget, HandsOnTheGroundStayWhereTheyAre) {
    auto source = with_skin({}, 0.1, 0.03), target = with_skin({.thigh = 0.43, .shin = 0.4}, 0.1, 0.05);
    Retarget retargeted = made(source, target);
    RetargetState state;
    glm::dvec3 laid{0.0};
    for (int frame = 0; frame < 40; ++frame) {
        source.pose().set_rest();
        source.turn_by("hips", {1, 0, 0}, 80.0);  // face down, the arms towards the ground
        for (const double side : {1.0, -1.0}) {
            const std::string name = side > 0.0 ? "left" : "right";
            source.turn_by(name + "Arm", {0, 0, 1}, -side * (80.0 + std::sin(0.1 * frame)));
            source.level(name + "Hand");
            source.turn_by(name + "UpLeg", {1, 0, 0}, -10.0);
        }
        test::local_of(source.pose(), source.joint("hips"))->translation.y +=
            static_cast<float>(0.03 - source.place("leftHand").y);
        ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
        const glm::dvec3 hand = target.place("leftHand");
        EXPECT_NEAR(hand.y, 0.05, 1e-3) << frame;
        if (frame == 0) laid = hand - source.place("leftHand") * double{retargeted.scale()};
        const glm::dvec3 slid = hand - source.place("leftHand") * double{retargeted.scale()} - laid;
        EXPECT_LT(std::hypot(slid.x, slid.z), 1e-3) << frame;
    }
}

TEST(Retarget, HandsThatHoldOneThingStayTogether) {
    Human source(HumanSpec{.axes = 0}), target(HumanSpec{.collar = 0.2, .axes = 2});
    const auto apart = [&](const RetargetOptions& options, double forward) {
        Retarget retargeted = made(source, target, options);
        RetargetState state;
        source.pose().set_rest();
        for (const double side : {1.0, -1.0}) {
            const std::string name = side > 0.0 ? "left" : "right";
            source.turn_by(name + "Arm", {0, 1, 0}, -side * forward);
            source.turn_by(name + "ForeArm", {0, 1, 0}, -side * 60.0);
        }
        const auto done = bendy::retarget(target.pose(), retargeted, source.pose(), state);
        EXPECT_TRUE(done);
        const glm::dvec3 wanted = source.place("rightHand") - source.place("leftHand");
        return glm::length(target.place("rightHand") - target.place("leftHand") - wanted);
    };
    EXPECT_LT(apart({}, 75.0), 1e-3);
    EXPECT_GT(apart(kDirections, 75.0), 0.05);
    EXPECT_EQ(apart({}, 20.0), apart(kDirections, 20.0));
}

/// A human with boxes for chest and hips, of these half edges, and for hands, feet and the sword.
test::PosedBody<HumanModel> with_trunk(HumanSpec human, const glm::vec3& half) {
    human.axes = 0;
    HumanModel model(human);
    const auto box = [&](const std::string& joint, const glm::vec3& edges) {
        std::vector<glm::vec3> corners;
        for (const float x : {-edges.x, edges.x}) {
            for (const float y : {-edges.y, 0.0f, 0.5f * edges.y, edges.y}) {
                for (const float z : {-edges.z, edges.z}) corners.emplace_back(x, y, z);
            }
        }
        model.spec.meshes.push_back({model.joint(joint), std::move(corners), {}, {}, {0, 1, 2, 5, 6, 7}, {}});
    };
    box("spine2", half);
    box("hips", half);
    box("sword", {0.02f, 0.02f, 0.3f});
    for (const char* side : {"left", "right"}) {
        box(std::string(side) + "Hand", glm::vec3(kHand));
        box(std::string(side) + "Foot", glm::vec3(0.04f));
    }
    return {std::move(model), 0.0};
}

TEST(Retarget, AHandOnTheChestLiesOnADeeperOne) {
    auto source = with_trunk({}, {0.25, 0.2, 0.12}), target = with_trunk({.collar = 0.16}, {0.25, 0.2, 0.22});
    Retarget retargeted = made(source, target), free = made(source, target, kDirections);
    ContactWeights contacts{};
    // Returns how far the hand is in front of the chest. bent: degrees, of the elbow
    const auto gap = [&](Retarget& by, double bent) {
        source.pose().set_rest();
        source.turn_by("leftArm", {0, 1, 0}, -30.0);
        source.turn_by("leftForeArm", {0, 1, 0}, -bent);
        RetargetState state;
        const auto done = retarget(target.pose(), by, source.pose(), state);
        EXPECT_TRUE(done);
        contacts = done->contacts;
        return target.place("leftHand").z - target.place("spine2").z - 0.22 - kHand;
    };
    const auto hand = static_cast<std::size_t>(Contact::left_hand_body);
    EXPECT_NEAR(gap(retargeted, 145.0), 0.0, 0.01);
    EXPECT_EQ(contacts[hand], 1.0f);
    EXPECT_EQ(contacts[hand + 1], 0.0f);
    EXPECT_LT(gap(free, 145.0), -0.05);
    EXPECT_EQ(contacts[hand], 0.0f);
    EXPECT_EQ(gap(retargeted, 80.0), gap(free, 80.0));
    EXPECT_EQ(contacts[hand], 0.0f);
    double last = gap(retargeted, 80.0);
    for (double bent = 80.5; bent <= 145.0; bent += 0.5) {
        const double now = gap(retargeted, bent);
        EXPECT_LT(std::abs(now - last), 0.01) << bent;
        EXPECT_GT(now, -0.01) << bent;
        last = now;
    }
}

TEST(Retarget, AHandOnWhatTheOtherOneHoldsStaysThere) {
    auto source = with_trunk({}, {0.15, 0.2, 0.12}), target = with_trunk({.collar = 0.2}, {0.15, 0.2, 0.12});
    ContactWeights contacts{};
    const auto off = [&](const RetargetOptions& options) {
        Retarget retargeted = made(source, target, options);
        source.pose().set_rest();
        source.turn_by("leftArm", {0, 1, 0}, -80.0);
        source.turn_by("leftForeArm", {0, 1, 0}, -20.0);
        source.turn_by("rightArm", {0, 1, 0}, 70.0);
        source.turn_by("rightForeArm", {0, 1, 0}, 45.0);
        RetargetState state;
        const auto done = retarget(target.pose(), retargeted, source.pose(), state);
        EXPECT_TRUE(done);
        contacts = done->contacts;
        const glm::dvec3 way = source.place("rightHand") - source.place("sword");
        return glm::length(target.place("rightHand") - target.place("sword") - way);
    };
    const auto left = static_cast<std::size_t>(Contact::left_hand_body);
    EXPECT_LT(off({}), 0.01);
    EXPECT_EQ(contacts[left], 0.0f) << "it holds the sword";
    EXPECT_EQ(contacts[left + 1], 1.0f);
    EXPECT_GT(off(kDirections), 0.1);
}

TEST(Retarget, AHandThatHangsIsNotInsideOfABroaderBody) {
    auto source = with_trunk({}, {0.15, 0.2, 0.12}), target = with_trunk({}, {0.22, 0.2, 0.2});
    Retarget retargeted = made(source, target), free = made(source, target, kDirections);
    const auto gap = [&](Retarget& by, double down, double& off) {
        source.pose().set_rest();
        source.turn_by("leftArm", {0, 0, 1}, -down);
        RetargetState state;
        EXPECT_TRUE(retarget(target.pose(), by, source.pose(), state));
        off = worst_direction(source, target);
        return target.place("leftHand").x - 0.22 - kHand;
    };
    double off = 0.0;
    EXPECT_LT(gap(free, 85.0, off), -0.04);
    EXPECT_GT(gap(retargeted, 85.0, off), 0.0);
    EXPECT_GT(gap(retargeted, 40.0, off), 0.0);
    EXPECT_LT(off, 2e-5) << "a hand that is outside anyway";
    double last = gap(retargeted, 40.0, off);
    for (double down = 40.5; down <= 85.0; down += 0.5) {
        const double now = gap(retargeted, down, off);
        EXPECT_LT(std::abs(now - last), 0.01) << down;
        last = now;
    }
}

TEST(Retarget, AJointThatJumpsTurnsQuicklyIfItIsKnownHowLongTheFrameTook) {
    ConstraintRecord bend;
    bend.model = static_cast<std::uint8_t>(ConstraintModel::swing_twist_pyramid);
    bend.rotation_min = {-kInf, -1.0f, -0.3f};
    bend.rotation_max = {kInf, 1.0f, 0.3f};
    Human source(HumanSpec{.axes = 0}), target(HumanSpec{.axes = 0, .elbows = {bend}});
    Retarget retarget = made(source, target, {RestPoses::measured, Limits::hard, false});
    const auto largest_step = [&](float seconds) {
        RetargetState state;
        double step = 0.0, left = 0.0;
        glm::dquat last(1, 0, 0, 0);
        for (int frame = 0; frame <= 80; ++frame) {
            source.pose().set_rest();
            source.turn_by("leftForeArm", glm::dvec3(0, 1, 0), 160.0 + std::min(frame, 40));
            EXPECT_TRUE(bendy::retarget(target.pose(), retarget, source.pose(), state, std::nullopt, seconds));
            const glm::quat local = target.pose().local(target.joint("leftForeArm")).rotation;
            if (frame > 0) step = std::max(step, angle_of(last, glm::dquat(local)));
            last = glm::dquat(local);
            const Constraint& limit = *target.model().constraint(target.joint("leftForeArm"));
            const glm::quat& rest = target.model().joints()[limit.joint].rest.rotation;
            EXPECT_LT(violation(limit, to_constraint_space(limit, rest, local)), 1e-5);
        }
        RetargetState other;
        EXPECT_TRUE(bendy::retarget(target.pose(), retarget, source.pose(), other));
        left = angle_of(last, glm::dquat(target.pose().local(target.joint("leftForeArm")).rotation));
        EXPECT_LT(left, 1e-5);
        return step;
    };
    EXPECT_GT(largest_step(0.0f), 1.0);
    EXPECT_LT(largest_step(1.0f / 60.0f), kTurnSpeed / 60.0 + kOfSource * M_PI / 180.0 + 1e-4);
}

TEST(Retarget, FeetStandWhereTheyAre) {
    Human source(HumanSpec{});
    for (const HumanSpec& build : kBuilds) {
        Human target(build);
        const double leg = build.thigh + build.shin;
        const double height = target.place("leftFoot").y;
        Retarget retargeted = made(source, target);
        RetargetState state;
        glm::dvec3 stood{0.0};
        for (int frame = 0; frame < 60; ++frame) {
            sway(source, 2.0 * M_PI * frame / 60.0);
            const auto done = retarget(target.pose(), retargeted, source.pose(), state);
            ASSERT_TRUE(done);
            EXPECT_EQ(done->contacts[0], 1.0f);
            EXPECT_LT(done->missed, 2e-4 * leg);
            if (frame == 0) stood = target.place("leftFoot");
            EXPECT_LT(glm::length(target.place("leftFoot") - stood), 2e-4 * leg) << frame << ", axes " << build.axes;
            EXPECT_NEAR(target.place("leftFoot").y, height, 2e-4 * leg);
            EXPECT_LT(angle_of(source.turn("leftFoot"), target.turn("leftFoot")), 1e-4);
        }
    }
}

/// The left foot takes a step while the right one stands; `share` 0 to 1.
void step(Human& human, double share) {
    human.pose().set_rest();
    const glm::dvec3 left = human.place("leftFoot"), right = human.place("rightFoot");
    test::local_of(human.pose(), human.joint("hips"))->translation += glm::vec3(0.0, -0.1, 0.1 * share);
    const double s = std::clamp(2.0 * share - 0.5, 0.0, 1.0);
    const double eased = s * s * (3.0 - 2.0 * s);
    const glm::dvec3 moved(0.0, 0.2 * std::pow(std::sin(M_PI * s), 2.0), 0.4 * eased);
    put_foot(human, "left", left + moved);
    put_foot(human, "right", right);
}

double knee_of(Human& human) {
    return std::acos(glm::dot(human.way("leftUpLeg", "leftLeg"), human.way("leftLeg", "leftFoot")));
}

/// The largest steps of a foot and a knee from one frame to the next.
struct Steps {
    double foot = 0.0, knee = 0.0;

    void add(Human& human, bool is_first) {
        const glm::dvec3 at = human.place("leftFoot");
        const double bent = knee_of(human);
        if (!is_first) foot = std::max(foot, glm::length(at - at_));
        if (!is_first) knee = std::max(knee, std::abs(bent - bent_));
        at_ = at;
        bent_ = bent;
    }

private:
    glm::dvec3 at_{0.0};
    double bent_ = 0.0;
};

TEST(Retarget, FeetLandAndLeaveWithoutAJump) {
    Human source(HumanSpec{.axes = 0});
    for (const HumanSpec& build : kBuilds) {
        Human target(build), in_the_air(build);
        Retarget retargeted = made(source, target);
        RetargetState state, other;
        Steps steps, source_steps, free_steps;
        bool has_left = false;
        for (int frame = 0; frame <= 120; ++frame) {
            step(source, frame / 120.0);
            const auto done = retarget(target.pose(), retargeted, source.pose(), state);
            ASSERT_TRUE(done);
            has_left = has_left || done->contacts[0] == 0.0f;
            steps.add(target, frame == 0);
            source_steps.add(source, frame == 0);
        }
        Retarget directions = made(source, in_the_air, kDirections);
        for (int frame = 0; frame <= 120; ++frame) {
            step(source, frame / 120.0);
            ASSERT_TRUE(retarget(in_the_air.pose(), directions, source.pose(), other));
            free_steps.add(in_the_air, frame == 0);
        }
        EXPECT_TRUE(has_left);
        const double scale = retargeted.scale();
        EXPECT_LT(steps.foot, 1.25 * std::max(scale * source_steps.foot, free_steps.foot)) << "axes " << build.axes;
        EXPECT_LT(steps.knee, 2.0 * source_steps.knee) << "axes " << build.axes;
    }
}

TEST(Retarget, ContactsMayBeGiven) {
    Human source(HumanSpec{});
    Human target(HumanSpec{.thigh = 0.3, .shin = 0.6, .axes = 2});
    Retarget retargeted = made(source, target);
    RetargetState state;
    sway(source, 1.0);
    auto done = retarget(target.pose(), retargeted, source.pose(), state, ContactWeights{});
    ASSERT_TRUE(done);
    EXPECT_EQ(done->contacts, ContactWeights{});
    EXPECT_LT(worst_direction(source, target), 2e-5);
    done = retarget(target.pose(), retargeted, source.pose(), state, ContactWeights{1, 1, 1, 1});
    ASSERT_TRUE(done);
    EXPECT_EQ(done->contacts[3], 1.0f);
    EXPECT_GT(worst_direction(source, target), 1e-3);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    done = retarget(target.pose(), retargeted, source.pose(), state, ContactWeights{nan, 7, -1, nan});
    ASSERT_TRUE(done);
    EXPECT_EQ(done->contacts, (ContactWeights{0, 1, 0, 0}));
    done = retarget(target.pose(), retargeted, source.pose(), state, ContactWeights{0.004f, 0.996f, 0.01f, 0.99f});
    ASSERT_TRUE(done);
    EXPECT_EQ(done->contacts, (ContactWeights{0, 1, 0.01f, 0.99f}));
}

TEST(Retarget, SaysThatThereAreNoRoles) {
    const Human whole(HumanSpec{});
    const Human none(HumanSpec{.has_roles = false});
    const auto retargeted = Retarget::make(whole.model(), none.model());
    ASSERT_FALSE(retargeted);
    EXPECT_EQ(retargeted.error().reason, RetargetError::Reason::no_roles);
    EXPECT_FALSE(retargeted.error().is_source);
    EXPECT_EQ(error_text(retargeted.error()),
              "the target does not say what its joints are: list them as \"roles\" in its rig file");
}

TEST(Retarget, HalfBodiesFollowAsFarAsTheyGo) {
    using enum Role;
    const std::vector<std::vector<Role>> losses{
        {left_foot, left_toes, right_foot, right_toes},
        {left_foot, left_toes},
        {left_lower_leg, left_foot, left_toes, right_lower_leg, right_foot, right_toes},
        {left_upper_leg, left_lower_leg, left_foot, left_toes, right_upper_leg, right_lower_leg, right_foot,
         right_toes},
        {right_upper_leg, right_lower_leg, right_foot, right_toes},
        {head, neck},
        {hips},
        {spine, chest, upper_chest, neck, head},
        {left_lower_arm, left_hand, right_hand},
        {hips, spine, chest, upper_chest, neck, head},
    };
    const std::vector<std::pair<Role, std::string>> names{
        {left_upper_arm, "leftArm"},     {left_lower_arm, "leftForeArm"},   {left_hand, "leftHand"},
        {right_upper_arm, "rightArm"},   {right_lower_arm, "rightForeArm"}, {right_hand, "rightHand"},
        {left_upper_leg, "leftUpLeg"},   {left_lower_leg, "leftLeg"},       {left_foot, "leftFoot"},
        {right_upper_leg, "rightUpLeg"}, {right_lower_leg, "rightLeg"},     {right_foot, "rightFoot"}};
    for (const std::vector<Role>& lost : losses) {
        const auto is_there = [&](const std::string& name) {
            const auto at =
                std::find_if(names.begin(), names.end(), [&](const auto& one) { return one.second == name; });
            return std::find(lost.begin(), lost.end(), at->first) == lost.end();
        };
        HumanModel half(HumanSpec{.facing = 90.0, .arms_down = 30.0, .thigh = 0.6, .axes = 4});
        half.forget(lost);
        for (const bool is_source : {false, true}) {
            Human whole(HumanSpec{});
            test::PosedBody<HumanModel> part(half, 90.0);
            test::PosedBody<HumanModel>&source = is_source ? part : whole, &target = is_source ? whole : part;
            for (const RetargetOptions& options : {kDirections, RetargetOptions{}}) {
                Retarget retargeted = made(source, target, options);
                EXPECT_GT(retargeted.scale(), 0.5f);
                EXPECT_LT(retargeted.scale(), 2.0f);
                RetargetState state;
                source.pose_at_random(1, 0.3);
                ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
                for (const auto& [from, to] : kLimbs) {
                    if (!is_there(from) || !is_there(to) || options.plants_feet) continue;
                    EXPECT_LT(glm::length(source.way(from, to) - target.way(from, to)), 2e-5)
                        << from << ", " << kValueNames<Role>[static_cast<std::size_t>(lost[0])];
                }
                for (const JointTransform& local : test::locals_of(target.pose()))
                    EXPECT_TRUE(std::isfinite(local.rotation.x + local.translation.y));
            }
        }
    }
}

TEST(Retarget, TheHipsOfABodyWithoutLegsTravelFromWhereTheyRest) {
    HumanModel half(HumanSpec{.spine = 2, .axes = 4});
    half.forget({Role::left_upper_leg, Role::left_lower_leg, Role::left_foot, Role::left_toes, Role::right_upper_leg,
                 Role::right_lower_leg, Role::right_foot, Role::right_toes});
    test::PosedBody<HumanModel> target(half, 0.0);
    Human source(HumanSpec{});
    Retarget retargeted = made(source, target);
    RetargetState state;
    const glm::dvec3 at_rest = source.place("hips"), at_rest_here = target.place("hips");
    source.move_hips({0.3, -0.1, 0.2});
    ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
    const glm::dvec3 travelled = target.place("hips") - at_rest_here;
    EXPECT_LT(glm::length(travelled - double{retargeted.scale()} * (source.place("hips") - at_rest)), 1e-6);
    EXPECT_NEAR(retargeted.leg(), glm::length(target.rest_place("head") - target.rest_place("hips")), 1e-6);
}

TEST(Retarget, ABodyWithoutSizeIsPosedAllTheSame) {
    test::ModelSpec flat = HumanModel(HumanSpec{}).spec;
    flat.joints[0].rest.scale = {0, 0, 0};
    const test::Owned point(test::build_file(flat));
    Human whole(HumanSpec{});
    for (const bool is_source : {false, true}) {
        auto retargeted = is_source ? Retarget::make(*point, whole.model()) : Retarget::make(whole.model(), *point);
        ASSERT_TRUE(retargeted);
        EXPECT_EQ(retargeted->scale(), 1.0f);
        Pose from(retargeted->source()), to(retargeted->target());
        RetargetState state;
        EXPECT_TRUE(retarget(to, *retargeted, from, state, ContactWeights{1, 1, 1, 1}));
        for (const JointTransform& local : test::locals_of(to))
            EXPECT_TRUE(std::isfinite(local.rotation.x + local.translation.y));
    }
}

TEST(Retarget, RefusesOtherModelsAndNumbersThatAreNotFinite) {
    Human source(HumanSpec{});
    Human target(HumanSpec{.axes = 2});
    Retarget retargeted = made(source, target);
    RetargetState state;
    EXPECT_EQ(retarget(source.pose(), retargeted, target.pose(), state).error(), CallError::other_model);
    source.pose_at_random(1, 0.3);
    for (const char* name : {"leftArm", "root", "hips"}) {
        const auto before = source.pose().local(source.joint(name));
        test::local_of(source.pose(), source.joint(name))->rotation.x = kInf;
        EXPECT_EQ(retarget(target.pose(), retargeted, source.pose(), state).error(), CallError::not_finite);
        source.pose().set_local(source.joint(name), before);
        test::local_of(source.pose(), source.joint("hips"))->translation.y = kInf;
        EXPECT_EQ(retarget(target.pose(), retargeted, source.pose(), state).error(), CallError::not_finite);
        for (const JointTransform& local : test::locals_of(target.pose()))
            EXPECT_TRUE(std::isfinite(local.rotation.x + local.translation.y));
        source.pose().set_rest();
    }
}

TEST(Retarget, TakesRolesOfWrongJoints) {
    Human whole(HumanSpec{});
    std::vector<RoleRecord> roles(whole.model().roles().begin(), whole.model().roles().end());
    std::mt19937 random(1);
    for (int round = 0; round < 100; ++round) {
        for (std::size_t k = roles.size() - 1; k > 0; --k) std::swap(roles[k].role, roles[random() % (k + 1)].role);
        test::ModelSpec spec = HumanModel(HumanSpec{}).spec;
        spec.more = {test::make_leaf(FourCC("ROLE"), std::as_bytes(std::span(roles)))};
        const test::Owned odd(test::build_file(spec));
        Pose pose(*odd);
        auto to_odd = Retarget::make(whole.model(), *odd);
        auto from_odd = Retarget::make(*odd, whole.model());
        ASSERT_TRUE(to_odd);
        ASSERT_TRUE(from_odd);
        RetargetState state, back;
        whole.pose_at_random(static_cast<unsigned>(round), 0.3);
        const ContactWeights standing{1, 1, 1, 1};
        EXPECT_TRUE(retarget(pose, *to_odd, whole.pose(), state, standing));
        EXPECT_TRUE(retarget(whole.pose(), *from_odd, pose, back, standing));
        for (const JointTransform& local : test::locals_of(pose))
            EXPECT_TRUE(std::isfinite(local.rotation.x + local.translation.y)) << round;
    }
}

TEST(Retarget, ACopyDoesTheSame) {
    Human source(HumanSpec{});
    Human target(HumanSpec{.axes = 2});
    auto first = std::make_unique<Retarget>(made(source, target));
    Retarget copy = *first;
    RetargetState state, other;
    sway(source, 1.0);
    ASSERT_TRUE(retarget(target.pose(), *first, source.pose(), state));
    const auto expected = test::locals_of(target.pose());
    first.reset();
    ASSERT_TRUE(retarget(target.pose(), copy, source.pose(), other));
    const auto again = test::locals_of(target.pose());
    for (std::size_t joint = 0; joint < again.size(); ++joint)
        EXPECT_EQ(again[joint].rotation, expected[joint].rotation);
}

TEST(Retarget, AllocatesNothing) {
    Human source(HumanSpec{});
    Human target(HumanSpec{.is_z_up = true, .spine = 2, .axes = 2, .elbows = {largest_bend(10.0)}});
    Retarget retargeted = made(source, target);
    RetargetState state;
    source.pose_at_random(1, 0.3);
    (void)source.pose().model_space();
    const std::uint64_t before = test::allocations().count;
    bool is_good = true;
    for (int frame = 0; frame < 20; ++frame) {
        test::local_of(source.pose(), source.joint("hips"))->translation.y -= 0.01f;
        is_good = retarget(target.pose(), retargeted, source.pose(), state) && is_good;
        is_good = retarget(target.pose(), retargeted, source.pose(), state, ContactWeights{1, 1, 1, 1}) && is_good;
        is_good = !retarget(source.pose(), retargeted, target.pose(), state) && is_good;
    }
    EXPECT_EQ(test::allocations().count - before, 0u);
    EXPECT_TRUE(is_good);
}

TEST(Retarget, AlikeRestPosesGiveTheSourcesTurnsWhateverTheBones) {
    Human source(HumanSpec{});
    Human target(HumanSpec{.arms_down = 8.0, .thigh = 0.6, .axes = 2});
    RetargetOptions options = kDirections;
    options.rest_poses = RestPoses::alike;
    Retarget retargeted = made(source, target, options);
    source.pose_at_random(4, 0.4);
    RetargetState state;
    ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
    for (const char* name : {"hips", "spine1", "head", "leftArm", "rightForeArm", "leftHand", "leftFoot"})
        EXPECT_LT(angle_of(source.turn(name), target.turn(name)), 1e-5) << name;
    EXPECT_LT(glm::length(target.place("hips") - double{retargeted.scale()} * source.place("hips")), 1e-5);
}

}  // namespace
}  // namespace bendy::retarget_test
