#include <bendy/converter/build_chunks.h>
#include <bendy/converter/import.h>
#include <bendy/format/document.h>

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace bendy::converter::import_bvh_test {
namespace {

const std::string kArm =
    "HIERARCHY\n"
    "ROOT Upper Arm\n"
    "{\n"
    "OFFSET 1 2 3\n"
    "CHANNELS 4 Yposition Zrotation Xrotation Yrotation\n"
    "JOINT Hand{OFFSET 0 5 0 CHANNELS 1 Xposition End Site { OFFSET 0 1 0}}\n"
    "}\n";
const std::string kMotion =
    "MOTION\n"
    "Frames: 2\n"
    "Frame Time: 0.5\n";

std::string fault_of(const std::string& text) {
    Report report;
    const auto scene = import_bvh(text, "arm.bvh", {}, report);
    return scene ? "" : scene.error().place + ": " + scene.error().message;
}

/// The text with `from` replaced, once.
std::string changed(std::string text, std::string_view from, std::string_view to) {
    return text.replace(text.find(from), from.size(), to);
}

TEST(ImportBvh, JointsAreAtTheirOffsetsAndFramesAreKeys) {
    Report report;
    const auto scene = import_bvh(kArm + kMotion + "7 90 0 0  4\n8 0 90 0  4\n", "folder/arm.bvh", {1.0}, report);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_TRUE(report.warnings().empty());
    ASSERT_EQ(scene->joints.size(), 3u);
    EXPECT_EQ(scene->joints[0].name, "Upper Arm");
    EXPECT_EQ(scene->joints[1].parent, 0u);
    EXPECT_EQ(scene->joints[2].name, "Hand end");
    EXPECT_EQ(scene->joints[2].rest.translation, glm::vec3(0, 1, 0));
    ASSERT_EQ(scene->clips.size(), 1u);
    const Clip& clip = scene->clips[0];
    EXPECT_EQ(clip.name, "arm");
    ASSERT_EQ(clip.tracks.size(), 3u);
    EXPECT_EQ(clip.tracks[0].times, (std::vector{0.0f, 0.5f}));
    EXPECT_EQ(clip.tracks[0].values, (std::vector{1.0f, 7.0f, 3.0f, 1.0f, 8.0f, 3.0f}));
    EXPECT_NEAR(clip.tracks[1].values[2], 0.70710678, 1e-6);
    EXPECT_NEAR(clip.tracks[1].values[4], 0.70710678, 1e-6);
    EXPECT_EQ(clip.tracks[2].times.size(), 1u);  // stays the same
    EXPECT_EQ(clip.tracks[2].values, (std::vector{4.0f, 5.0f, 0.0f}));
    EXPECT_FALSE(clip.stated_span);
}

TEST(ImportBvh, ARootWithoutAnOffsetStandsOnTheGroundOfItsMotion) {
    const std::string legs =
        "HIERARCHY ROOT Hips { OFFSET 0 0 0 CHANNELS 4 Xposition Yposition Zposition Zrotation"
        " JOINT Knee { OFFSET 0 -2 0 CHANNELS 1 Zrotation End Site { OFFSET 0 -2 0 } } }"
        "MOTION Frames: 4 Frame Time: 0.1\n";
    const std::string frames = "9 5 9 0 0   9 5 9 90 -90   9 9 9 0 0   9 5 9 0 0";  // on the ground at 1, 3, 5, 1
    Report report;
    const auto scene = import_bvh(legs + frames, "legs.bvh", {1.0}, report);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_NEAR(scene->joints[0].rest.translation.y, 5.0f, 1e-6);
    EXPECT_EQ(scene->joints[0].rest.translation.x, 0.0f);
    const auto z_up = import_bvh(changed(changed(legs, "0 -2 0", "0 0 -2"), "0 -2 0", "0 0 -2") + "9 9 5 0 0",
                                 "legs.bvh", {1.0}, report);
    ASSERT_TRUE(z_up);
    EXPECT_EQ(z_up->joints[0].rest.translation, glm::vec3(0, 0, 5));
    const auto placed = import_bvh(changed(legs, "0 0 0", "0 1 0") + frames, "legs.bvh", {1.0}, report);
    ASSERT_TRUE(placed);
    EXPECT_EQ(placed->joints[0].rest.translation, glm::vec3(0, 1, 0));
}

TEST(ImportBvh, AMotionInWhichNothingMovesKeepsItsLength) {
    Report report;
    const auto scene = import_bvh(kArm + kMotion + "7 90 0 0 4 7 90 0 0 4", "arm.bvh", {}, report);
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->clips[0].stated_span, (ClipSpan{0.0f, 0.5f}));
    ASSERT_EQ(report.warnings().size(), 1u);
    EXPECT_EQ(report.warnings()[0].message, "units are taken as centimetres; --unit sets another length");
    EXPECT_TRUE(validate(build_chunks(*scene, "test", report)).empty());
}

TEST(ImportBvh, ASkeletonNeedsNoMotionAndAFileMayHaveTwo) {
    Report report;
    const auto scene = import_bvh(kArm + "ROOT Other { OFFSET 0 0 0 }", "arm.bvh", {}, report);
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->joints.back().parent, kNone);
    EXPECT_TRUE(scene->clips.empty());
}

TEST(ImportBvh, AllFramesAreReadWhateverTheirNumber) {
    Report report;
    const auto scene = import_bvh(kArm + kMotion + "1 2 3 4 5 1 2 3 4 5 1 2 3 4 6", "arm.bvh", {}, report);
    ASSERT_TRUE(scene);
    EXPECT_EQ(report.warnings()[0].message, "the file says 2 frames and has 3, which are all read");
    EXPECT_EQ(scene->clips[0].tracks[2].times.back(), 1.0f);
}

TEST(ImportBvh, FaultsNameTheirLine) {
    EXPECT_EQ(fault_of(""), "line 1: expected 'hierarchy', found the end of the file");
    EXPECT_EQ(fault_of("HIERARCHY\n\nMOTION"), "line 3: expected 'ROOT', found 'MOTION'");
    EXPECT_EQ(fault_of("HIERARCHY ROOT a"), "line 1: expected '{', found the end of the file");
    EXPECT_EQ(fault_of("HIERARCHY ROOT a {\n} "), "line 1: the joint has no OFFSET");
    EXPECT_EQ(fault_of(changed(kArm, "}\n}", "}")), "line 7: expected '}', found the end of the file");
    EXPECT_EQ(fault_of(changed(kArm, "CHANNELS", "SIZE")),
              "line 5: expected 'OFFSET', 'CHANNELS', 'JOINT' or '}', found 'SIZE'");
    EXPECT_EQ(fault_of(changed(kArm, "JOINT", "ROOT")),
              "line 6: expected 'OFFSET', 'CHANNELS', 'JOINT' or '}', found 'ROOT'");
    EXPECT_EQ(fault_of(changed(kArm, "2 3", "2 3,5")), "line 4: expected a number, found '3,5'");
    EXPECT_EQ(fault_of(changed(kArm, "2 3", "2 nan")), "line 4: the number 'nan' is implausibly large");
    EXPECT_EQ(fault_of(changed(kArm, "2 3", "2 3 OFFSET")), "line 4: the joint has two OFFSETs");
    EXPECT_EQ(fault_of(changed(kArm, "CHANNELS 1", "CHANNELS 0 CHANNELS 1")), "line 6: the joint has CHANNELS twice");
    EXPECT_EQ(fault_of(changed(kArm, "CHANNELS 4", "CHANNELS 7")),
              "line 5: number of channels: expected a whole number from 0 to 6");
    EXPECT_EQ(fault_of(changed(kArm, "Yposition", "Yscale")),
              "line 5: expected a channel such as 'Xposition' or 'Zrotation', found 'Yscale'");
    EXPECT_EQ(fault_of(changed(kArm, "Xrotation", "zROTATION")), "line 5: the joint has the channel 'zROTATION' twice");
    EXPECT_EQ(fault_of(kArm + "MOTION Frames: 1e9"),
              "line 8: number of frames: expected a whole number from 0 to 4194304");
    EXPECT_EQ(fault_of(kArm + "MOTION Frames: 2 Frame Time: 0"),
              "line 8: the time of a frame must be between 0.000001 s and 1,000,000 s");
    EXPECT_EQ(fault_of(kArm + kMotion + "1 2 3 4 5\n1 2"), "line 12: expected a number, found the end of the file");
    EXPECT_EQ(fault_of(kArm + kMotion + "1e15 2 3 4 5\n1 2 3 x"), "line 12: expected a number, found 'x'");
}

TEST(ImportBvh, AUnitIsALength) {
    Report report;
    const auto scene = import_bvh(kArm, "arm.bvh", {-1.0}, report);
    ASSERT_FALSE(scene);
    EXPECT_EQ(scene.error().message, "a unit is longer than 0 m");
}

TEST(ImportBvh, ASmallFileCannotAskForMuchMemory) {
    std::string deep = "HIERARCHY ROOT a { OFFSET 0 0 0 ";
    for (int i = 0; i < 200'000; ++i) deep += "End{";
    EXPECT_NE(fault_of(deep).find("the decoded data would be implausibly large"), std::string::npos);
}

}  // namespace
}  // namespace bendy::converter::import_bvh_test
