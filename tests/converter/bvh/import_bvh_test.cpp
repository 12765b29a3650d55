#include <bendy/converter/build_chunks.h>
#include <bendy/converter/import.h>
#include <bendy/format/document.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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
    EXPECT_EQ(fault_of(changed(kArm, "2 3", "2 nan")), "line 4: expected a number, found 'nan'");
    EXPECT_EQ(fault_of(changed(kArm, "2 3", "2 1e16")), "line 4: the number '1e16' is implausibly large");
    EXPECT_EQ(fault_of(changed(kArm, "2 3", "2 3 OFFSET")), "line 4: the joint has two OFFSETs");
    EXPECT_EQ(fault_of(changed(kArm, "CHANNELS 1", "CHANNELS 0 CHANNELS 1")), "line 6: the joint has CHANNELS twice");
    EXPECT_EQ(fault_of(changed(kArm, "CHANNELS 4", "CHANNELS 7")),
              "line 5: number of channels: expected a whole number from 0 to 6");
    EXPECT_EQ(fault_of(changed(kArm, "Yposition", "Yscale")),
              "line 5: expected a channel such as 'Xposition' or 'Zrotation', found 'Yscale'");
    EXPECT_EQ(fault_of(changed(kArm, "Xrotation", "zROTATION")), "line 5: the joint has the channel 'zROTATION' twice");
    EXPECT_EQ(fault_of(kArm + "MOTION Frames: 1e9"),
              "line 8: number of frames: expected a whole number from 0 to 4194304");
    EXPECT_EQ(fault_of(kArm + "MOTION Frames: 2 Frame Time: 1e-9"),
              "line 8: the time of a frame must be between 0.000001 s and 1,000,000 s");
    EXPECT_EQ(fault_of(kArm + "MOTION Frames: 2 Time: 1"), "line 8: expected 'frame time', found 'Time'");
    EXPECT_EQ(fault_of(kArm + kMotion + "1e15 2 3 4 5\n1 2 3 x"), "line 12: expected a number, found 'x'");
}

/// A file that is read, with its warnings.
struct Read {
    explicit Read(const std::string& text) {
        auto result = import_bvh(text, "arm.bvh", {1.0}, report);
        EXPECT_TRUE(result) << result.error().place << ": " << result.error().message;
        if (result) scene = *std::move(result);
        for (const Warning& warning : report.warnings())
            warnings += warning.first_place + ": " + warning.message + " x" + std::to_string(warning.count) + '\n';
    }
    /// The X coordinates of the hand, which has one number of each frame.
    [[nodiscard]] std::vector<float> hand() const {
        std::vector<float> numbers;
        const std::vector<float>& values = scene.clips.at(0).tracks.at(2).values;
        for (std::size_t i = 0; i < values.size(); i += 3) numbers.push_back(values[i]);
        return numbers;
    }
    Report report;
    Scene scene;
    std::string warnings;
};

const std::string kFrames = "1 2 3 4 5\n1 2 3 4 6\n";
const std::string kSurplus = "a frame has more numbers than the joints have channels: the surplus is left out";

TEST(ImportBvh, ALineIsAFrameIfThereAreAsManyAsTheFileSays) {
    const Read all(kArm + kMotion + "1 2 3 4 5 99\n\n 1 2 3 4 6 99 98\n");
    EXPECT_EQ(all.hand(), (std::vector{5.0f, 6.0f}));
    EXPECT_EQ(all.warnings, "line 11: " + kSurplus + " x2\n");
    const Read second(kArm + kMotion + "1 2 3 4 5\n1 2 3 4 6 # the end\n");
    EXPECT_EQ(second.hand(), (std::vector{5.0f, 6.0f}));
    EXPECT_EQ(second.warnings, "line 12: " + kSurplus + " x1\n");
    const Read miscounted(kArm + changed(kMotion, "2", "7") + "1 2 3 4 5 99\n1 2 3 4 6 99\n1 2 3 4 7 99\n");
    EXPECT_EQ(miscounted.hand(), (std::vector{5.0f, 6.0f, 7.0f}));
    EXPECT_EQ(miscounted.warnings,
              "line 11: " + kSurplus + " x3\n: the file says 7 frames and has 3, which are all read x1\n");
}

TEST(ImportBvh, AFrameMayTakeSeveralLinesAndALineSeveralFrames) {
    for (const char* frames : {"1 2 3\n4 5\n1 2\n3 4 6\n", "1 2 3 4 5 1 2 3 4 6", "1 2 3 4 5 1 2\n3 4\n6"}) {
        const Read read(kArm + kMotion + frames);
        EXPECT_EQ(read.hand(), (std::vector{5.0f, 6.0f})) << frames;
        EXPECT_EQ(read.warnings, "") << frames;
    }
    const Read miscounted(kArm + changed(kMotion, "2", "3") + "1 2 3\n4 5\n1 2 3\n4 6\n");
    EXPECT_EQ(miscounted.hand(), (std::vector{5.0f, 6.0f}));
    EXPECT_EQ(miscounted.warnings, ": the file says 3 frames and has 2, which are all read x1\n");
}

TEST(ImportBvh, AShortFrameIsReportedAtItsLine) {
    const std::string is_short = "a frame is too short: expected 5 numbers, one for each channel, found ";
    EXPECT_EQ(fault_of(kArm + kMotion + "1 2 3\n1 2 3 4 5\n"), "line 11: " + is_short + "3");
    EXPECT_EQ(fault_of(kArm + kMotion + "1 2 3 4 5\n1 2"), "line 12: " + is_short + "2");
    EXPECT_EQ(fault_of(kArm + kMotion + "1 2 3 4 5\n1 2\n1 2 3 4 5\n"), "line 12: " + is_short + "2");
    EXPECT_EQ(fault_of(kArm + kMotion + "1 2 3\n4 5\n1 2 3\n4\n"), "line 13: " + is_short + "4");
    std::string carriage = kArm + kMotion + "1 2 3 4 5\n1 2";
    std::replace(carriage.begin(), carriage.end(), '\n', '\r');
    EXPECT_EQ(fault_of(carriage), "line 12: " + is_short + "2");
    EXPECT_EQ(fault_of(changed(carriage, "\r", "\r\n")), "line 12: " + is_short + "2");
}

TEST(ImportBvh, AFrameTimeThatIsNotAboveZeroIsThirtyASecond) {
    for (const char* time : {"0", "-0.03", "nan", "0.0"}) {
        const Read read(kArm + changed(kMotion, "0.5", time) + kFrames);
        EXPECT_EQ(read.scene.clips.at(0).tracks.at(2).times, (std::vector{0.0f, 1.0f / 30.0f})) << time;
        EXPECT_EQ(read.warnings, "line 10: the frame time is not above 0 s: 30 frames a second are assumed x1\n");
    }
    EXPECT_EQ(Read(kArm + "MOTION Frames: 1 Frame Time: 0\n1 2 3 4 5").warnings, "") << "one frame takes no time";
}

TEST(ImportBvh, WhatFollowsTheTextIsLeftOut) {
    using std::string_literals::operator""s;
    for (const std::string& end : {"\0\0\x1a\n"s, "\x1a\x1a"s, "\0\0\0"s, "\r\n\x1a"s}) {
        const Read read(kArm + kMotion + kFrames + end);
        EXPECT_EQ(read.hand(), (std::vector{5.0f, 6.0f}));
        EXPECT_EQ(read.warnings, "");
    }
    const std::string before = kArm + kMotion + kFrames;
    EXPECT_EQ(Read(before + "\x1aold").warnings,
              "byte " + std::to_string(before.size()) + ": text after Ctrl-Z, which ends a text, is left out x1\n");
    const Read noted(before + "The end, 2 of 2\n");
    EXPECT_EQ(noted.hand(), (std::vector{5.0f, 6.0f}));
    EXPECT_EQ(noted.warnings, "line 13: text after the last frame is left out x1\n");
    EXPECT_EQ(fault_of(kArm + changed(kMotion, "2", "3") + kFrames + "The end\n"),
              "line 13: expected a number, found 'The'");
}

TEST(ImportBvh, OtherSpellingsAreRead) {
    EXPECT_EQ(Read(changed(kArm, "End Site", "EndSite") + kMotion + kFrames).scene.joints.at(2).name, "Hand end");
    EXPECT_EQ(Read(kArm + changed(kMotion, "Frame Time", "FrameTime") + kFrames).hand().size(), 2u);
}

TEST(ImportBvh, NamesInOtherEncodingsAreSaid) {
    using std::string_literals::operator""s;
    const std::string is_latin = "line 2: a name is not UTF-8: its bytes are taken for Latin-1 x1\n";
    const Read waist(changed(kArm, "Upper Arm\n", "\x8d\x98"));  // in Shift-JIS
    EXPECT_EQ(waist.scene.joints.at(0).name, "\xc2\x8d\xc2\x98");
    EXPECT_EQ(waist.warnings, is_latin);
    const Read bone(changed(kArm, "Upper Arm", "\x83{\x81[\x83\x93"));  // whose second byte is a brace
    EXPECT_EQ(bone.scene.joints.size(), 3u);
    EXPECT_EQ(bone.warnings, is_latin);
    const Read cafe(changed(kArm, "Upper Arm\n", "Caf\xe9"));  // in Latin-1
    EXPECT_EQ(cafe.scene.joints.at(0).name, "Caf\xc3\xa9");
    EXPECT_EQ(cafe.warnings, is_latin);
    const Read wide(changed(kArm, "Upper Arm", "A\0r\0m\0"s));  // in UTF-16
    EXPECT_EQ(wide.scene.joints.at(0).name, "Arm");
    EXPECT_EQ(wide.warnings, "line 2: a name has NULs in it, as in UTF-16: they are left out x2\n");
}

TEST(ImportBvh, AFileInUtf16IsRead) {
    const auto wide = [](const std::u16string& text, bool is_big) {
        std::string bytes;
        for (const char16_t unit : text) {
            const auto low = static_cast<char>(unit & 0xff);
            const auto high = static_cast<char>(unit >> 8);
            bytes += is_big ? high : low;
            bytes += is_big ? low : high;
        }
        return bytes;
    };
    const std::string plain = changed(kArm, "Upper Arm", "@") + kMotion + kFrames;
    std::u16string text(plain.begin(), plain.end());
    text.replace(text.find(u'@'), 1, u"\u8170\U0001f9b4\xd800");  // the last is half a pair
    for (const bool is_big : {false, true}) {
        for (const char16_t* mark : {u"\ufeff", u""}) {
            const Read read(wide(mark + text, is_big) + (is_big ? "" : "\n"));
            EXPECT_EQ(read.scene.joints.at(0).name, "\xe8\x85\xb0\xf0\x9f\xa6\xb4\xef\xbf\xbd");
            EXPECT_EQ(read.hand(), (std::vector{5.0f, 6.0f}));
            EXPECT_EQ(read.warnings, ": the file is text in UTF-16, and is read as such x1\n");
        }
    }
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
