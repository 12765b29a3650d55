#include <bendy/format/standing_pose.h>

#include "edit_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace bendy::standing_pose_test {
namespace {

using namespace test;

constexpr float kHalf = 0.70710678f;

/// The sample, whose object has four joints, with this standing pose.
Node with(const StandingPoseRecord& pose, const std::vector<StandingRotationRecord>& rotations) {
    Node root = sample();
    at(root, "HEAD/OBJE").children.push_back(make_leaf(FourCC("STND"), write_standing_pose(pose, rotations)));
    return root;
}

Lines faults_with(const StandingPoseRecord& pose, const std::vector<StandingRotationRecord>& rotations) {
    return faults_in(with(pose, rotations));
}

Lines one_fault(const std::string& code) {
    return {code + " HEAD/OBJE/STND"};
}

TEST(StandingPose, IsReadInPlace) {
    StandingPoseRecord pose;
    pose.axes = {kHalf, 0.0f, 0.0f, kHalf};
    pose.ground = -0.5f;
    pose.height = 1.8f;
    pose.evidence = static_cast<std::uint8_t>(StandingEvidence::clip);
    const std::vector<StandingRotationRecord> rotations{{0, {0.0f, 0.0f, 0.0f}}, {2, {0.6f, 0.0f, 0.0f}}};
    const Loaded loaded(to_file(with(pose, rotations)));
    ASSERT_EQ(loaded.lines(), Lines{});
    const auto& read = loaded.document.objects.at(0).standing_pose;
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->pose.axes, pose.axes);
    EXPECT_EQ(read->pose.ground, -0.5f);
    EXPECT_EQ(read->pose.height, 1.8f);
    ASSERT_EQ(read->rotations.size(), 2u);
    EXPECT_EQ(read->rotations[1].joint, 2u);
    EXPECT_NEAR(rotation_of(read->rotations[1])[3], 0.8f, 1e-6f);
}

TEST(StandingPose, MayBeMissing) {
    EXPECT_FALSE(Loaded(sample_file()).document.objects.at(0).standing_pose.has_value());
}

TEST(StandingPose, RotationsComeBackUpToTheirSign) {
    const StandingRotationRecord record = standing_rotation(3, {0.5f, -0.5f, 0.5f, -0.5f});
    const std::array<float, 4> q = rotation_of(record);
    EXPECT_NEAR(q[0], -0.5f, 1e-6f);
    EXPECT_NEAR(q[1], 0.5f, 1e-6f);
    EXPECT_NEAR(q[2], -0.5f, 1e-6f);
    EXPECT_NEAR(q[3], 0.5f, 1e-6f);
    EXPECT_EQ(rotation_of({0, {1.0f, 0.0f, 0.001f}})[3], 0.0f);
}

TEST(StandingPose, RefusesAPayloadOfAnotherSize) {
    for (const std::size_t left_out : {1u, 8u, 15u}) {
        Node root = sample();
        std::vector<std::byte> payload = write_standing_pose({}, std::vector<StandingRotationRecord>{{0, {}}, {1, {}}});
        payload.resize(payload.size() - left_out);
        at(root, "HEAD/OBJE").children.push_back(make_leaf(FourCC("STND"), payload));
        EXPECT_EQ(faults_in(root), one_fault("RECORD_SIZE")) << left_out;
    }
}

TEST(StandingPose, RefusesNumbersOutOfRange) {
    const auto faults = [](auto change) {
        StandingPoseRecord pose;
        change(pose);
        return faults_with(pose, {});
    };
    EXPECT_EQ(faults([](auto& pose) { pose.evidence = kStandingEvidence; }), one_fault("ENUM_RANGE"));
    EXPECT_EQ(faults([](auto& pose) { pose.reserved[6] = 1; }), one_fault("RESERVED_FIELD"));
    EXPECT_EQ(faults([](auto& pose) { pose.axes[3] = 1.1f; }), one_fault("ROTATION_NOT_UNIT"));
    EXPECT_EQ(faults([](auto& pose) { pose.ground = std::numeric_limits<float>::infinity(); }),
              one_fault("NOT_FINITE"));
    EXPECT_EQ(faults([](auto& pose) { pose.height = -0.1f; }), one_fault("BELOW_ZERO"));
}

TEST(StandingPose, RefusesWrongRotations) {
    EXPECT_EQ(faults_with({}, {{4, {}}}), one_fault("JOINT_RANGE"));
    EXPECT_EQ(faults_with({}, {{1, {}}, {0, {}}}), one_fault("JOINT_ORDER"));
    EXPECT_EQ(faults_with({}, {{1, {}}, {1, {}}}), one_fault("JOINT_ORDER"));
    EXPECT_EQ(faults_with({}, {{1, {0.9f, 0.9f, 0.0f}}}), one_fault("ROTATION_NOT_UNIT"));
    EXPECT_EQ(faults_with({}, {{1, {std::nanf(""), 0.0f, 0.0f}}}), one_fault("ROTATION_NOT_UNIT"));
}

}  // namespace
}  // namespace bendy::standing_pose_test
