#include "rigging/humanoid/standing_pose.h"

#include "humanoid_gltf.h"
#include "rigging/humanoid/find_roles.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/import.h>
#include <bendy/format/document.h>
#include <bendy/format/standing_pose.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace bendy::converter::standing_pose_test {
namespace {

using namespace test;

const glm::dvec3 kUp{0.0, 1.0, 0.0};

Scene human() {
    return *HumanoidGltf().build().import();
}

glm::dquat rotation_in(const Transform& local) {
    return {local.rotation.w, local.rotation.x, local.rotation.y, local.rotation.z};
}

void set_rotation(Transform& local, const glm::dquat& q) {
    local.rotation = {q.x, q.y, q.z, q.w};
}

/// Turns the hips, and with them the whole body.
void tip_over(Scene& scene, const glm::dquat& turn) {
    Transform& hips = scene.joints[joint_named(scene, "hips")].rest;
    set_rotation(hips, glm::normalize(turn * rotation_in(hips)));
}

glm::dquat about(const glm::dvec3& axis, double degrees) {
    return glm::angleAxis(degrees * kTestDegree, axis);
}

void add_key(Clip& clip, std::uint32_t joint, const Transform& local) {
    Track rotation{TrackPath::rotation, Interpolation::linear, joint, 4, {0.0f}, {}};
    for (int k = 0; k < 4; ++k) rotation.values.push_back(local.rotation[k]);
    clip.tracks.push_back(rotation);
}

/// A clip of one frame with the rotations of this pose.
Clip frame_of(const std::vector<Transform>& locals) {
    Clip clip;
    clip.name = "Stand";
    for (std::uint32_t joint = 0; joint < locals.size(); ++joint) add_key(clip, joint, locals[joint]);
    return clip;
}

void find(Scene& scene, Report& report) {
    find_roles(scene, kNone, report);
    find_standing_pose(scene, report);
    Report of_building;
    EXPECT_TRUE(validate(build_chunks(scene, "test", of_building)).empty());
}

/// Where the joints are by the rule of spec/chunks/STND.md, computed from the records alone.
std::vector<glm::dvec3> places_in_stand(const Scene& scene) {
    std::vector<glm::dquat> turns;
    std::vector<glm::dvec3> places;
    for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
        const std::uint32_t parent = scene.joints[joint].parent;
        const glm::dquat above = parent == kNone ? glm::dquat(1, 0, 0, 0) : turns[parent];
        glm::dquat turn = above * rotation_in(scene.joints[joint].rest);
        for (const StandingRotationRecord& record : scene.standing_pose->rotations) {
            const std::array<float, 4> q = rotation_of(record);
            if (record.joint == joint) turn = {q[3], q[0], q[1], q[2]};
        }
        turns.push_back(turn);
        const glm::dvec3 offset(scene.joints[joint].rest.translation);
        places.push_back(parent == kNone ? offset : places[parent] + above * offset);
    }
    return places;
}

double degrees_from_up(const Scene& scene, const char* from, const char* to) {
    const std::vector<glm::dvec3> places = places_in_stand(scene);
    const glm::dvec3 way = glm::normalize(places[joint_named(scene, to)] - places[joint_named(scene, from)]);
    return std::acos(std::clamp(glm::dot(way, kUp), -1.0, 1.0)) / kTestDegree;
}

StandingEvidence evidence_of(const Scene& scene) {
    return static_cast<StandingEvidence>(scene.standing_pose->pose.evidence);
}

TEST(StandingPose, IsNotStoredWhereTheRestPoseStands) {
    for (const double arms : {0.0, 70.0}) {
        Scene scene = human();
        Transform& arm = scene.joints[joint_named(scene, "leftUpperArm")].rest;
        set_rotation(arm, rotation_in(arm) * about({0.6, 0.0, 0.8}, arms));
        Report report;
        find(scene, report);
        EXPECT_FALSE(scene.standing_pose.has_value());
        EXPECT_EQ(warned(report, "does not stand"), 0u);
    }
}

TEST(StandingPose, IsTheRestPoseTurnedUprightIfThatLies) {
    for (const glm::dquat& turn : {about({1, 0, 0}, -90.0), about({0, 0, 1}, 90.0), about({1, 0, 0}, 180.0),
                                   about(glm::normalize(glm::dvec3(1, 2, 3)), 130.0)}) {
        Scene scene = human();
        tip_over(scene, turn);
        Report report;
        find(scene, report);
        ASSERT_TRUE(scene.standing_pose.has_value());
        EXPECT_EQ(evidence_of(scene), StandingEvidence::rest_pose);
        EXPECT_EQ(scene.standing_pose->rotations.size(), scene.roles.size());
        EXPECT_LT(degrees_from_up(scene, "hips", "head"), 3.0);
        EXPECT_LT(degrees_from_up(scene, "leftFoot", "leftUpperLeg"), 3.0);
        EXPECT_NEAR(scene.standing_pose->pose.height, 1.58, 0.01);
        EXPECT_EQ(warned(report, "does not stand"), 0u);
    }
}

/// A body that leans a little keeps its lean: which way is up is not measured so finely.
TEST(StandingPose, IsTurnedByQuartersIfItLiesAlongAnAxis) {
    Scene scene = human();
    set_rotation(scene.joints[joint_named(scene, "spine")].rest,
                 about({1, 0, 0}, 8.0) * rotation_in(scene.joints[joint_named(scene, "spine")].rest));
    const RestFrames leaning(scene);
    tip_over(scene, about({1, 0, 0}, -90.0));
    Report report;
    find(scene, report);
    ASSERT_TRUE(scene.standing_pose.has_value());
    const std::vector<glm::dvec3> places = places_in_stand(scene);
    for (const char* name : {"head", "leftHand", "leftFoot"}) {
        const auto way = leaning.direction(joint_named(scene, "hips"), joint_named(scene, name));
        const glm::dvec3 stands = places[joint_named(scene, name)] - places[joint_named(scene, "hips")];
        EXPECT_LT(glm::distance(*way, glm::normalize(stands)), 1e-5) << name;
    }
}

/// A file whose motions have Z up, as its rest pose, is not turned: its up is what it is.
TEST(StandingPose, IsNotStoredWhereTheMotionsHaveTheSameUp) {
    Scene scene = human();
    tip_over(scene, about({1, 0, 0}, 90.0));
    scene.clips = {frame_of(rest_of(scene))};
    Report report;
    find(scene, report);
    EXPECT_FALSE(scene.standing_pose.has_value());
    EXPECT_EQ(warned(report, "does not stand"), 0u);
}

TEST(StandingPose, IsUprightAsTheMotionsAre) {
    Scene scene = human();
    scene.clips = {frame_of(rest_of(scene))};
    Transform& hips = scene.joints[joint_named(scene, "hips")].rest;
    const Transform upright = hips;
    tip_over(scene, about({1, 0, 0}, 90.0));  // the clip has Y up
    Report report;
    find(scene, report);
    ASSERT_TRUE(scene.standing_pose.has_value());
    EXPECT_EQ(evidence_of(scene), StandingEvidence::rest_pose);
    EXPECT_LT(degrees_from_up(scene, "hips", "head"), 3.0);
    EXPECT_NE(hips.rotation, upright.rotation);
}

/// Places that no float holds: the file is converted without a standing pose.
TEST(StandingPose, IsNotStoredIfItsNumbersAreTooLarge) {
    Scene scene = human();
    tip_over(scene, about({1, 0, 0}, -90.0));
    for (Joint& joint : scene.joints) joint.rest.translation *= 3e38f;
    Report report;
    find(scene, report);
    EXPECT_FALSE(scene.standing_pose.has_value());
}

TEST(StandingPose, SaysWhereTheBodyLooks) {
    Scene scene = human();
    tip_over(scene, about({1, 0, 0}, -90.0));
    Report report;
    find(scene, report);
    ASSERT_TRUE(scene.standing_pose.has_value());
    const std::array<float, 4>& q = scene.standing_pose->pose.axes;
    const glm::dquat axes(q[3], q[0], q[1], q[2]);
    const std::vector<glm::dvec3> places = places_in_stand(scene);
    const glm::dvec3 left = places[joint_named(scene, "leftHand")] - places[joint_named(scene, "rightHand")];
    const glm::dvec3 toes = places[joint_named(scene, "leftToes")] - places[joint_named(scene, "leftFoot")];
    EXPECT_GT(glm::dot(glm::normalize(left), axes * glm::dvec3(1, 0, 0)), 0.999);
    EXPECT_GT(glm::dot(axes * glm::dvec3(0, 1, 0), kUp), 0.999);
    EXPECT_GT(glm::dot(glm::normalize(toes), axes * glm::dvec3(0, 0, 1)), 0.8);
}

TEST(StandingPose, BindMatricesAreTrustedFirst) {
    Scene scene = human();
    bind_at_rest(scene);
    Transform& knee = scene.joints[joint_named(scene, "leftLowerLeg")].rest;
    set_rotation(knee, about({1, 0, 0}, 80.0) * rotation_in(knee));
    tip_over(scene, about({1, 0, 0}, -90.0));
    scene.roles.clear();
    const Humanoid bones = [&] {
        Humanoid found;
        for (const auto& [bone, name] : {std::pair{HumanBone::hips, "hips"},
                                         {HumanBone::head, "head"},
                                         {HumanBone::left_upper_leg, "leftUpperLeg"},
                                         {HumanBone::left_lower_leg, "leftLowerLeg"},
                                         {HumanBone::left_foot, "leftFoot"},
                                         {HumanBone::right_upper_leg, "rightUpperLeg"},
                                         {HumanBone::right_lower_leg, "rightLowerLeg"},
                                         {HumanBone::right_foot, "rightFoot"}})
            found[bone] = joint_named(scene, name);
        return found;
    }();
    const std::vector<CandidatePose> bound = find_bind_poses(scene);
    ASSERT_EQ(bound.size(), 2u);
    const auto judge = [&](const CandidatePose& pose) {
        const std::optional<Standing> standing = judge_stand(RestFrames(scene, pose.locals), bones, kUp);
        EXPECT_TRUE(standing.has_value());
        return standing.value_or(Standing());
    };
    EXPECT_TRUE(judge(bound[0]).stands());
    EXPECT_FALSE(judge(bound[1]).is_upright()) << "its root lies as it rests";
    EXPECT_LT(judge(bound[1]).knees, 1.0);
    EXPECT_FALSE(judge_stand(RestFrames(scene), bones, kUp)->stands());
}

TEST(StandingPose, IsTheFrameOfAClipIfTheRestPoseIsNoBody) {
    Scene scene = human();
    const std::vector<Transform> standing = rest_of(scene);
    std::vector<Transform> crouching = standing;
    Transform& knee = crouching[joint_named(scene, "leftLowerLeg")];
    set_rotation(knee, rotation_in(knee) * about({0.0, 0.6, 0.8}, 100.0));
    // Without rotations the bones point anywhere; the clips turn them into a body.
    for (Joint& joint : scene.joints) set_rotation(joint.rest, glm::dquat(1, 0, 0, 0));
    scene.clips = {frame_of(crouching), frame_of(standing)};
    Report report;
    find(scene, report);
    EXPECT_FALSE(scene.roles.empty());
    ASSERT_TRUE(scene.standing_pose.has_value());
    EXPECT_EQ(evidence_of(scene), StandingEvidence::clip);
    EXPECT_LT(degrees_from_up(scene, "hips", "head"), 3.0);
    EXPECT_LT(degrees_from_up(scene, "leftLowerLeg", "leftUpperLeg"), 3.0);
}

/// Where a body looks at a moment of a clip does not say where its front is.
TEST(StandingPose, FacesTheFrontWhereverTheClipLooks) {
    for (const double looks : {0.0, 60.0, 145.0, -90.0}) {
        Scene scene = human();
        std::vector<Transform> standing = rest_of(scene);
        Transform& root = standing[0];
        set_rotation(root, about({0, 1, 0}, looks) * rotation_in(root));
        for (Joint& joint : scene.joints) set_rotation(joint.rest, glm::dquat(1, 0, 0, 0));
        scene.clips = {frame_of(standing)};
        Report report;
        find(scene, report);
        ASSERT_TRUE(scene.standing_pose.has_value());
        EXPECT_EQ(evidence_of(scene), StandingEvidence::clip);
        EXPECT_NEAR(scene.standing_pose->pose.axes[3], 1.0f, 1e-6f) << looks;
        const std::vector<glm::dvec3> places = places_in_stand(scene);
        const glm::dvec3 left = places[joint_named(scene, "leftHand")] - places[joint_named(scene, "rightHand")];
        EXPECT_GT(glm::normalize(left).x, 0.999) << looks;
    }
}

/// Turns a joint in model space, and with it what is below.
void turn(Scene& scene, const char* name, const glm::dquat& by) {
    const std::uint32_t joint = joint_named(scene, name);
    const std::uint32_t parent = scene.joints[joint].parent;
    const RestFrames frames(scene);
    const glm::dquat above = parent == kNone ? glm::dquat(1, 0, 0, 0) : frames.turn(parent);
    Transform& local = scene.joints[joint].rest;
    set_rotation(local, glm::normalize(glm::conjugate(above) * by * above * rotation_in(local)));
}

/// Everything is bent or turned.
void crouch(Scene& scene) {
    turn(scene, "hips", about({1, 0, 0}, 40.0) * about({0, 1, 0}, 50.0));
    turn(scene, "spine", about({1, 0, 0}, 30.0));
    turn(scene, "neck", about({1, 0, 0}, -25.0));
    for (const char* side : {"left", "right"}) {
        const std::string s = side;
        const double out = s == "left" ? 1.0 : -1.0;
        const RestFrames frames(scene);
        const auto of = [&](const char* from, const char* to) {
            return *frames.direction(joint_named(scene, from), joint_named(scene, to));
        };
        const glm::dvec3 left = of("rightUpperLeg", "leftUpperLeg");
        const glm::dvec3 front = glm::cross(left, of("hips", "spine"));
        const glm::dvec3 up = of("spine", "chest");
        turn(scene, (s + "UpperLeg").c_str(), about(left, -90.0));
        turn(scene, (s + "LowerLeg").c_str(), about(left, 80.0));
        turn(scene, (s + "Foot").c_str(), about(left, -20.0));
        turn(scene, (s + "UpperArm").c_str(), about(front, -60.0 * out));
        turn(scene, (s + "LowerArm").c_str(), about(about(front, -60.0 * out) * glm::normalize(up), -45.0 * out));
    }
}

/// Degrees between a joint's rotation in model space in the standing pose and the rest pose of another scene.
double degrees_off(const Scene& scene, const Scene& truth, const std::string& name) {
    const std::uint32_t joint = joint_named(scene, name);
    for (const StandingRotationRecord& record : scene.standing_pose->rotations) {
        if (record.joint != joint) continue;
        const std::array<float, 4> q = rotation_of(record);
        const double cosine = std::abs(glm::dot(glm::dquat(q[3], q[0], q[1], q[2]), RestFrames(truth).turn(joint)));
        return 2.0 * std::acos(std::min(cosine, 1.0)) / kTestDegree;
    }
    return 180.0;
}

TEST(StandingPose, ThatNobodyKnowsIsATOfTheBodysBones) {
    const Scene truth = human();
    Scene scene = truth;
    crouch(scene);
    Report report;
    find(scene, report);
    ASSERT_TRUE(scene.standing_pose.has_value());
    EXPECT_EQ(evidence_of(scene), StandingEvidence::assumed);
    EXPECT_EQ(warned(report, "a T of its bones is assumed"), 1u);
    EXPECT_EQ(warned(report, "--stand CLIP@SECONDS"), 1u);
    for (const char* joint : {"hips", "spine", "chest", "leftUpperArm", "rightUpperArm", "leftLowerArm",
                              "rightLowerArm", "leftUpperLeg", "rightUpperLeg", "leftLowerLeg", "rightLowerLeg"})
        EXPECT_LT(degrees_off(scene, truth, joint), 3.0) << joint;
    for (const char* joint : {"leftFoot", "rightFoot"})
        EXPECT_LT(degrees_off(scene, truth, joint), 10.0) << joint << ", whose slant is usual, not known";
    EXPECT_LT(degrees_off(scene, truth, "neck"), 15.0);
}

/// Frames of a run are upright, but far from a stand.
TEST(StandingPose, IsAssumedWhereNoFrameStands) {
    const Scene truth = human();
    Scene running = truth;
    turn(running, "hips", about({1, 0, 0}, 20.0));
    turn(running, "leftUpperLeg", about({1, 0, 0}, -70.0));
    turn(running, "leftLowerLeg", about({1, 0, 0}, 80.0));
    Scene scene = truth;
    // Without rotations the bones point anywhere.
    for (Joint& joint : scene.joints) set_rotation(joint.rest, glm::dquat(1, 0, 0, 0));
    scene.clips = {frame_of(rest_of(running))};
    Report report;
    find(scene, report);
    EXPECT_FALSE(scene.roles.empty());
    ASSERT_TRUE(scene.standing_pose.has_value());
    EXPECT_EQ(evidence_of(scene), StandingEvidence::assumed);
    EXPECT_EQ(warned(report, "a T of its bones is assumed"), 1u);
    for (const char* joint : {"hips", "chest", "leftUpperLeg", "leftLowerLeg", "rightUpperLeg", "leftUpperArm"})
        EXPECT_LT(degrees_off(scene, truth, joint), 3.0) << joint;
}

/// A stride in which both feet are at one height.
void stride(Scene& scene) {
    turn(scene, "leftUpperLeg", about({1, 0, 0}, -12.0));
    turn(scene, "rightUpperLeg", about({1, 0, 0}, 12.0));
    for (const char* foot : {"leftFoot", "rightFoot"})  // the soles stay level
        turn(scene, foot, about({1, 0, 0}, foot[0] == 'l' ? 12.0 : -12.0));
}

TEST(StandingPose, IsAssumedWhereTheRestPoseIsAMomentOfAWalk) {
    const Scene truth = human();
    Scene scene = truth;
    stride(scene);
    Report report;
    find(scene, report);
    ASSERT_TRUE(scene.standing_pose.has_value());
    EXPECT_EQ(evidence_of(scene), StandingEvidence::assumed);
    EXPECT_EQ(warned(report, "its sides differ"), 1u);
    for (const char* joint : {"hips", "chest", "leftUpperLeg", "rightUpperLeg"})
        EXPECT_LT(degrees_off(scene, truth, joint), 3.0) << joint;
}

/// A stride shows that the body stands, but a T is nearer to how it does; feet are slanted as in the stride.
TEST(StandingPose, IsATWhereAClipStandsByChance) {
    const Scene truth = human();
    Scene walking = truth;
    stride(walking);
    Scene scene = truth;
    for (Joint& joint : scene.joints) set_rotation(joint.rest, glm::dquat(1, 0, 0, 0));
    scene.clips = {frame_of(rest_of(walking))};
    Report report;
    find(scene, report);
    ASSERT_TRUE(scene.standing_pose.has_value());
    EXPECT_EQ(evidence_of(scene), StandingEvidence::assumed);
    EXPECT_EQ(warned(report, "does not stand"), 0u);
    for (const char* joint : {"hips", "leftUpperLeg", "rightUpperLeg", "leftFoot", "rightFoot"})
        EXPECT_LT(degrees_off(scene, truth, joint), 3.0) << joint;
}

/// As the joints between hips and thighs of CMU's: without them the legs would hang where they rest.
TEST(StandingPose, TurnsJointsBetweenThoseThatHaveARole) {
    HumanoidGltf body;
    for (const std::string side : {"left", "right"}) {
        body.add(side + "HipJoint", "hips", {side == "left" ? 0.05 : -0.05, 1.0, 0.0});
        body[side + "UpperLeg"].parent = side + "HipJoint";
    }
    const Scene truth = *body.build().import();
    Scene scene = truth;
    for (Joint& joint : scene.joints) set_rotation(joint.rest, glm::dquat(1, 0, 0, 0));
    scene.clips = {frame_of(rest_of(truth))};
    Report report;
    find(scene, report);
    ASSERT_TRUE(scene.standing_pose.has_value());
    EXPECT_EQ(scene.standing_pose->rotations.size(), scene.roles.size() + 2);
    EXPECT_LT(degrees_off(scene, truth, "leftHipJoint"), 0.1);
    const std::vector<glm::dvec3> places = places_in_stand(scene);
    const glm::dvec3 across = places[joint_named(scene, "leftUpperLeg")] - places[joint_named(scene, "rightUpperLeg")];
    EXPECT_NEAR(across.x, 0.2, 1e-4);
}

/// Feet of some robots hang on nothing: STND, which has no translations, would leave them where the body lies.
TEST(StandingPose, ThatLeavesPartsBehindIsNone) {
    HumanoidGltf robot;
    for (const char* foot : {"leftFoot", "rightFoot"}) robot[foot].parent = "";
    Scene scene = *robot.build().import();
    const glm::dquat lies = about({1, 0, 0}, -90.0);
    for (Joint& joint : scene.joints) {
        if (joint.parent != kNone) continue;
        set_rotation(joint.rest, glm::normalize(lies * rotation_in(joint.rest)));
        joint.rest.translation = glm::vec3(lies * glm::dvec3(joint.rest.translation));
    }
    Report report;
    find(scene, report);
    EXPECT_FALSE(scene.roles.empty());
    EXPECT_FALSE(scene.standing_pose.has_value());
    EXPECT_EQ(warned(report, "does not stand"), 1u);
}

// --- up and front

glm::dvec3 way_at_rest(const Scene& scene, const char* from, const char* to) {
    const RestFrames frames(scene);
    return *frames.direction(joint_named(scene, from), joint_named(scene, to));
}

TEST(Orient, ZBecomesYWhereTheClipsSaySo) {
    for (const SourceUp up : {SourceUp::found, SourceUp::y, SourceUp::z}) {
        Scene scene = human();
        tip_over(scene, about({1, 0, 0}, 90.0));
        scene.joints[joint_named(scene, "hips")].rest.translation = {0.25f, 0.5f, 1.0f};
        scene.clips = {frame_of(rest_of(scene))};
        Report report;
        find_roles(scene, kNone, report);
        orient(scene, up, false, report);
        EXPECT_EQ(report.suggestions().size(), up == SourceUp::found ? 1u : 0u);
        const bool is_turned = up != SourceUp::y;
        EXPECT_NEAR(way_at_rest(scene, "hips", "head").y, is_turned ? 1.0 : 0.0, 1e-6);
        const glm::vec3 place = scene.joints[joint_named(scene, "hips")].rest.translation;
        EXPECT_EQ(place, is_turned ? glm::vec3(0.25f, 1.0f, -0.5f) : glm::vec3(0.25f, 0.5f, 1.0f));
        for (const Track& track : scene.clips[0].tracks) {
            if (track.target != joint_named(scene, "hips")) continue;
            for (int k = 0; k < 4; ++k)
                EXPECT_EQ(track.values.at(static_cast<std::size_t>(k)), scene.joints[track.target].rest.rotation[k]);
        }
    }
}

TEST(Orient, WhatHasYUpStays) {
    Scene scene = human();
    scene.clips = {frame_of(rest_of(scene))};
    const std::vector<Transform> before = rest_of(scene);
    Report report;
    find_roles(scene, kNone, report);
    orient(scene, SourceUp::found, true, report);
    const std::vector<Transform> after = rest_of(scene);
    for (std::size_t joint = 0; joint < after.size(); ++joint) EXPECT_EQ(after[joint].rotation, before[joint].rotation);
    EXPECT_TRUE(report.suggestions().empty());
}

TEST(Orient, ACharacterIsTurnedToTheFrontIfThatIsAsked) {
    for (const double degrees : {90.0, 180.0, -90.0, 70.0, -160.0}) {
        for (const bool is_asked : {true, false}) {
            Scene scene = human();
            tip_over(scene, about(kUp, degrees));
            Report report;
            find_roles(scene, kNone, report);
            const glm::dvec3 before = way_at_rest(scene, "leftFoot", "leftToes");
            orient(scene, SourceUp::y, is_asked, report);
            const glm::dvec3 after = way_at_rest(scene, "leftFoot", "leftToes");
            if (is_asked) {
                EXPECT_GT(after.z, 0.6) << degrees;
                EXPECT_NEAR(after.y, before.y, 1e-6);
            } else {
                EXPECT_NEAR(glm::distance(before, after), 0.0, 1e-12);
            }
        }
    }
}

TEST(Orient, ItSaysThatAnOldVrmShowsItsBack) {
    Scene scene = human();
    tip_over(scene, about(kUp, 180.0));
    Report report;
    find_roles(scene, kNone, report);
    scene.extensions = R"({"VRM":{}})";
    orient(scene, SourceUp::y, false, report);
    ASSERT_EQ(report.suggestions().size(), 1u);
    EXPECT_NE(report.suggestions()[0].find("--face front"), std::string::npos);
}

TEST(Orient, WhatNobodyKnowsIsNotTurned) {
    Scene scene = *HumanoidGltf().build().import();
    for (Joint& joint : scene.joints) joint.name.clear();
    scene.joints.resize(3);
    Report report;
    find_roles(scene, kNone, report);
    orient(scene, SourceUp::found, true, report);
    EXPECT_EQ(warned(report, "--face front"), 1u);
}

}  // namespace
}  // namespace bendy::converter::standing_pose_test
