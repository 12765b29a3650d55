#include "build_scene.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/export.h>
#include <bendy/format/document.h>

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace bendy::converter::rig_standing_pose_test {
namespace {

using namespace test;

Scene row() {
    return make_row({"pelvis", "chest", "twice", "twice"});
}

void attach_pose_to(Scene& scene, const std::string& standing) {
    Report report;
    attach_standing_pose(scene, parse_rig(R"({"bendy_rig": 1, "standing_pose": )" + standing + "}", report),
                         JointIndex(scene));
}

TEST(RigStandingPose, IsAttachedByNameAndTakenOut) {
    Scene scene = row();
    attach_pose_to(scene, R"({"axes": [0, 2, 0, 0], "ground": -0.5, "height": 1.7, "evidence": "clip",
                              "rotations": {"chest": [0, 0.6, 0], "pelvis": [0.1, 0, 0]}})");
    ASSERT_TRUE(scene.standing_pose.has_value());
    EXPECT_EQ(scene.standing_pose->pose.axes, (std::array{0.0f, 1.0f, 0.0f, 0.0f}));
    EXPECT_EQ(scene.standing_pose->pose.ground, -0.5f);
    EXPECT_EQ(scene.standing_pose->pose.evidence, static_cast<std::uint8_t>(StandingEvidence::clip));
    ASSERT_EQ(scene.standing_pose->rotations.size(), 2u);
    EXPECT_EQ(scene.standing_pose->rotations[0].joint, 0u);
    EXPECT_EQ(scene.standing_pose->rotations[1].rotation, (std::array{0.0f, 0.6f, 0.0f}));
    attach_pose_to(scene, "null");
    EXPECT_FALSE(scene.standing_pose.has_value());
}

TEST(RigStandingPose, IsWritten) {
    Scene scene = row();
    scene.standing_pose = {{{0.0f, 0.6f, 0.0f, 0.8f}, 0.1f, 1.8f, 3, {}},
                           {{0, {0.1f, 0.2f, 0.3f}}, {3, {0.7f, 0.0f, 0.0f}}}};
    Report report;
    const std::vector<std::byte> bytes = build_chunks(scene, "test", report);
    EXPECT_TRUE(validate(bytes).empty());
    const Result<ChunkTree> tree = read_chunk_tree(bytes);
    Faults faults;
    const std::string text = write_rig(read_document(*tree, faults).objects.at(0));
    Scene again = row();
    attach_standing_pose(again, parse_rig(text, report), JointIndex(again));
    ASSERT_TRUE(again.standing_pose.has_value()) << text;
    EXPECT_EQ(again.standing_pose->pose.axes, scene.standing_pose->pose.axes);
    EXPECT_EQ(again.standing_pose->pose.ground, 0.1f);
    EXPECT_EQ(again.standing_pose->pose.height, 1.8f);
    EXPECT_EQ(again.standing_pose->pose.evidence, 3u);
    ASSERT_EQ(again.standing_pose->rotations.size(), 2u);
    EXPECT_EQ(again.standing_pose->rotations[0].rotation, (std::array{0.1f, 0.2f, 0.3f}));
    EXPECT_EQ(again.standing_pose->rotations[1].joint, 3u);
}

TEST(RigStandingPose, SaysWhatIsWrong) {
    const auto error_of = [](const std::string& standing) -> std::string {
        Scene scene = row();
        try {
            attach_pose_to(scene, standing);
        } catch (const Failure& failure) {
            EXPECT_FALSE(scene.standing_pose.has_value());
            return failure.error.place + ": " + failure.error.message;
        }
        return {};
    };
    const std::string axes = R"({"axes": [0, 0, 0, 1], "rotations": )";
    EXPECT_EQ(error_of(axes + R"({"pelvis": [0, 0, 0]}})"), "");
    EXPECT_EQ(error_of(axes + R"({"Pelvis": [0, 0, 0]}})"),
              "standing_pose.rotations.Pelvis: there is no joint 'Pelvis'; did you mean \"pelvis\"?");
    EXPECT_EQ(error_of(axes + R"({"pelvis": [0, 0]}})"),
              "standing_pose.rotations.pelvis: expected x y z of a rotation, found 2 numbers");
    EXPECT_EQ(error_of(axes + R"({"pelvis": [1, 1, 0]}})"),
              "standing_pose.rotations.pelvis: no unit quaternion has these x y z");
    EXPECT_EQ(error_of(axes + R"({"pelvis": [0, 0, 0], "#0": [0, 0, 0]}})"),
              "standing_pose.rotations: joint #0 has two rotations");
    EXPECT_NE(error_of(R"({"rotations": {}})"), "");
    EXPECT_NE(error_of(R"({"axes": [0, 0, 0, 1]})"), "");
    EXPECT_NE(error_of("3"), "");
}

}  // namespace
}  // namespace bendy::converter::rig_standing_pose_test
