#include "rigging/humanoid/missing_roles.h"

#include "humanoid_gltf.h"
#include "rigging/humanoid/find_roles.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace bendy::converter::missing_roles_test {
namespace {

using namespace test;

/// A human with a joint between the left thigh and the left shin, or another part of a limb.
Scene with_a_joint(const std::string& above = "leftUpperLeg", const std::string& below = "leftLowerLeg") {
    HumanoidGltf human;
    human.add("between", above, 0.5 * (human[above].position + human[below].position));
    human[below].parent = "between";
    Scene scene = *human.build().import();
    Report unheard;
    find_roles(scene, kNone, unheard);
    scene.clips.resize(1);
    return scene;
}

/// Two keys, the second one turned by so many degrees about an axis in model space.
void turn(Scene& scene, const std::string& name, double degrees, const glm::dvec3& axis) {
    const std::uint32_t joint = joint_named(scene, name);
    const RestFrames frames(scene);
    const auto& q = scene.joints[joint].rest.rotation;
    const glm::dquat rest(q.w, q.x, q.y, q.z);
    const glm::dvec3 own = glm::conjugate(frames.turn(joint)) * axis;
    const glm::dquat turned = rest * glm::angleAxis(degrees * kTestDegree, own);
    Track track{TrackPath::rotation, Interpolation::linear, joint, 4, {0.0f, 1.0f}, {}};
    for (const glm::dquat& key : {rest, turned}) {
        for (const double number : {key.x, key.y, key.z, key.w}) track.values.push_back(static_cast<float>(number));
    }
    scene.clips[0].tracks.push_back(track);
}

const glm::dvec3 kAcross{1.0, 0.0, 0.0};
const glm::dvec3 kAlong{0.0, 1.0, 0.0};  // a leg's bones

std::string warning_of(const Scene& scene) {
    Report report;
    warn_of_missing_roles(scene, report);
    EXPECT_LE(report.warnings().size(), 1u);
    return report.warnings().empty() ? "" : report.warnings()[0].message;
}

TEST(MissingRoles, AJointThatMovesInPlaceOfTheShinIsNamed) {
    Scene scene = with_a_joint();
    turn(scene, "between", 60.0, kAcross);
    turn(scene, "leftUpperLeg", 40.0, kAcross);
    turn(scene, "leftLowerLeg", 3.0, kAcross);
    const std::string warning = warning_of(scene);
    EXPECT_NE(warning.find("joint 'between' has no role but swings by 60 degrees"), std::string::npos) << warning;
    EXPECT_NE(warning.find("the left_lower_leg, 'leftLowerLeg', turns by 3"), std::string::npos) << warning;
}

TEST(MissingRoles, AJointThatMovesInPlaceOfTheThighIsNamed) {
    Scene scene = with_a_joint();
    turn(scene, "between", 40.0, kAcross);
    turn(scene, "leftLowerLeg", 60.0, kAcross);
    EXPECT_NE(warning_of(scene).find("the left_upper_leg, 'leftUpperLeg', turns by 0"), std::string::npos);
}

TEST(MissingRoles, WhatTwistsIsAPartOfTheBone) {
    Scene scene = with_a_joint();
    turn(scene, "between", 80.0, kAlong);
    EXPECT_EQ(warning_of(scene), "");
    Scene arm = with_a_joint("rightLowerArm", "rightHand");
    turn(arm, "between", 80.0, kAcross);  // an arm's bones
    EXPECT_EQ(warning_of(arm), "");
}

/// Also where it lies at the end of the bone, as a forearm's twist joint beside the wrist.
TEST(MissingRoles, WhatTwistsAtTheEndOfTheBoneIsAPartOfIt) {
    HumanoidGltf human;
    human.add("between", "leftLowerArm", human["leftHand"].position + glm::dvec3(0.0, 0.003, 0.0));
    human["leftHand"].parent = "between";
    Scene scene = *human.build().import();
    Report unheard;
    find_roles(scene, kNone, unheard);
    scene.clips.resize(1);
    turn(scene, "between", 80.0, kAcross);
    EXPECT_EQ(warning_of(scene), "");
}

TEST(MissingRoles, ALegOfThreeBonesThatAllMoveHasNoRoleToGive) {
    Scene scene = with_a_joint();
    for (const char* joint : {"leftUpperLeg", "between", "leftLowerLeg"}) turn(scene, joint, 60.0, kAcross);
    EXPECT_EQ(warning_of(scene), "");
}

TEST(MissingRoles, WhatHardlyMovesIsNotNamed) {
    Scene scene = with_a_joint();
    EXPECT_EQ(warning_of(scene), "");
    turn(scene, "between", 10.0, kAcross);
    EXPECT_EQ(warning_of(scene), "");
}

/// A joint beside the limb, or below its end, is not inside it.
TEST(MissingRoles, OnlyJointsInsideALimbCount) {
    HumanoidGltf human;
    human.add("pocket", "leftUpperLeg", {0.2, 0.9, 0.0});
    human.add("ball", "leftToes", {0.1, 0.0, 0.2});
    Scene scene = *human.build().import();
    Report unheard;
    find_roles(scene, kNone, unheard);
    scene.clips.resize(1);
    turn(scene, "pocket", 60.0, kAcross);
    turn(scene, "ball", 60.0, kAcross);
    EXPECT_EQ(warning_of(scene), "");
}

}  // namespace
}  // namespace bendy::converter::missing_roles_test
