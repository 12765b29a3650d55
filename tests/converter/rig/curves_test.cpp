#include "rigging/rig/clips.h"

#include "build_scene.h"
#include "rigging/rig/parse_rig.h"
#include "scene/frame_shapes.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/export.h>
#include <bendy/format/document.h>

#include <gtest/gtest.h>

#include <string>

namespace bendy::converter::curves_test {
namespace {

using namespace test;

/// Two joints and two materials; Walk from 0 to 1 s with a curve of the second material, Run without any key.
Scene walker() {
    Scene scene = make_row({"hip", "knee"});
    scene.materials.resize(2);
    scene.materials[0].name = "cloth";
    scene.materials[1].name = "skin";
    scene.clips.resize(2);
    scene.clips[0].name = "Walk";
    scene.clips[0].tracks.push_back({TrackPath::translation, Interpolation::linear, 0, 3, {0, 1}, {0, 0, 0, 0, 1, 0}});
    Curve curve;
    curve.path = "alphaCutoff";
    curve.kind = CurveTarget::material;
    curve.target = 1;
    curve.times = {0, 1};
    curve.values = {0.5f, 0.25f};
    scene.clips[0].curves.push_back(curve);
    scene.clips[1].name = "Run";
    return scene;
}

void attach_to(Scene& scene, const std::string& members, Report& report) {
    const Rig rig = parse(members);
    const JointIndex index(scene);
    attach_curves(scene, rig, index, report);
}

Scene with_curves(const std::string& members) {
    Scene scene = walker();
    Report report;
    attach_to(scene, members, report);
    EXPECT_TRUE(report.warnings().empty());
    return scene;
}

std::string attach_error(const std::string& members) {
    return failure_of([&] {
        Scene scene = walker();
        Report report;
        attach_to(scene, members, report);
    });
}

TEST(RigCurves, AreAddedToTheirClips) {
    const Scene scene = with_curves(
        R"("curves": [{"clip": "Walk", "name": "FootDown", "interpolation": "step", "times": [0, 0.5], "values": [1, 0]},
                      {"clip": "#0", "path": "extras/grip", "target": {"joint": "knee"}, "times": [0.5], "values": [1, 2, 3]},
                      {"clip": "Walk", "path": "/extras/wind", "interpolation": "cubic", "times": [0, 1],
                       "values": [0, 1, 2, 3, 4, 5]}])");
    const auto& curves = scene.clips[0].curves;
    ASSERT_EQ(curves.size(), 4u);
    EXPECT_EQ(curves[1].name, "FootDown");
    EXPECT_EQ(curves[1].path, "/extras/FootDown");
    EXPECT_EQ(curves[1].interpolation, Interpolation::step);
    EXPECT_EQ(curves[2].kind, CurveTarget::joint);
    EXPECT_EQ(curves[2].target, 1u);
    EXPECT_EQ(curves[2].components, 3u);
    EXPECT_EQ(curves[2].interpolation, Interpolation::linear);
    EXPECT_EQ(curves[3].components, 1u);
    EXPECT_EQ(curves[3].values.size(), 6u);
    EXPECT_EQ(span_of(scene.clips[0]), (ClipSpan{0, 1}));
}

TEST(RigCurves, ReplaceWhatAnimatesTheSame) {
    const Scene scene = with_curves(
        R"("curves": [{"clip": "Walk", "name": "fade", "path": "alphaCutoff", "target": {"material": "skin"}, "times": [0.5], "values": [9]}])");
    ASSERT_EQ(scene.clips[0].curves.size(), 1u);
    EXPECT_EQ(scene.clips[0].curves[0].name, "fade");
    EXPECT_EQ(scene.clips[0].curves[0].values, std::vector<float>{9});
}

TEST(RigCurves, ACompleteRigLeavesNoOthersIfItSaysAnythingOfThem) {
    EXPECT_EQ(with_curves(R"("complete": true, "curves": [])").clips[0].curves.size(), 0u);
    EXPECT_EQ(with_curves(R"("complete": true)").clips[0].curves.size(), 1u);
    EXPECT_EQ(with_curves(R"("curves": [])").clips[0].curves.size(), 1u);
}

TEST(RigCurves, AClipKeepsItsLengthAndOneWithoutKeysGetsOne) {
    Scene scene = with_curves(R"("curves": [{"clip": "Run", "name": "x", "times": [1, 3], "values": [0, 1]}])");
    EXPECT_EQ(span_of(scene.clips[1]), (ClipSpan{1, 3}));
    EXPECT_FALSE(scene.clips[1].stated_span);
    Report report;
    attach_to(scene, R"("complete": true, "curves": [{"clip": "Run", "name": "x", "times": [2], "values": [0]}])",
              report);
    EXPECT_EQ(span_of(scene.clips[1]), (ClipSpan{1, 3}));
}

TEST(RigCurves, AClipThatDoesNotExistIsNamed) {
    Scene scene = walker();
    Report report;
    attach_to(scene, R"("curves": [{"clip": "Fly", "name": "x", "times": [0], "values": [0]}])", report);
    EXPECT_EQ(lines_of(report), std::vector<std::string>{"curves[0]: no clip takes a curve for 'Fly'"});
}

TEST(RigCurves, WhatIsWrongIsSaidWithItsPlace) {
    const auto error = [](const std::string& curve) { return attach_error(R"("curves": [)" + curve + "]"); };
    EXPECT_EQ(attach_error(R"("curves": {})"), "curves: it must be a list, not object");
    EXPECT_EQ(error("7"), "curves[0]: it must be an object, not 7");
    EXPECT_EQ(error(R"({"name": "x", "times": [0], "values": [0]})"), "curves[0].clip: it is required and missing");
    EXPECT_EQ(error(R"({"clip": "Walk", "times": [0], "values": [0]})"),
              "curves[0]: expected a path or a name, found neither");
    EXPECT_EQ(error(R"({"clip": "Walk", "name": "x", "values": [0]})"), "curves[0].times: it is required and missing");
    EXPECT_EQ(error(R"({"clip": "Walk", "name": "x", "times": [], "values": [0]})"),
              "curves[0].times: expected one time or more, found none");
    EXPECT_EQ(error(R"({"clip": "Walk", "name": "x", "times": [0.5, 0.5], "values": [0, 1]})"),
              "curves[0].times[1]: expected a time after 0.5, found 0.5");
    EXPECT_EQ(error(R"({"clip": "Walk", "name": "x", "times": [0, 1], "values": [0, 1, 2]})"),
              "curves[0].values: expected 2 numbers, or 2, 3 or 4 times as many, for 2 keys, found 3");
    EXPECT_EQ(error(R"({"clip": "Walk", "name": "x", "times": [0], "values": [0, 1, 2, 3, 4]})"),
              "curves[0].values: expected 1 numbers, or 2, 3 or 4 times as many, for 1 keys, found 5");
    EXPECT_EQ(error(R"({"clip": "Walk", "name": "x", "times": [0], "values": ["a"]})"),
              "curves[0].values[0]: expected a number, found 'a'");
    EXPECT_EQ(error(R"({"clip": "Walk", "name": "x", "times": [1e99], "values": [0]})"),
              "curves[0].times[0]: 1e+99 does not fit a 32-bit float");
    EXPECT_EQ(error(R"({"clip": "Walk", "name": "x", "times": [2], "values": [0]})"),
              "curves[0].times: 2.0 s is outside the clip, which lasts from 0.0 s to 1.0 s");
    EXPECT_EQ(error(R"({"clip": "Walk", "name": "x", "times": [0], "values": [0], "interpolation": "bezier"})"),
              "curves[0].interpolation: 'bezier' is none of step, linear, cubic");
    EXPECT_EQ(error(R"({"clip": "Walk", "name": "x", "times": [0], "values": [0], "target": {}})"),
              "curves[0].target: expected one of joint, material, mesh, texture, found none");
    EXPECT_EQ(
        error(
            R"({"clip": "Walk", "name": "x", "times": [0], "values": [0], "target": {"joint": "hip", "mesh": "#0"}})"),
        "curves[0].target: expected one target, found two");
    EXPECT_EQ(error(R"({"clip": "Walk", "name": "x", "times": [0], "values": [0], "target": {"material": "tin"}})"),
              "curves[0].target.material: there is no material 'tin'");
    EXPECT_EQ(error(R"({"clip": "Walk", "name": "x", "times": [0], "values": [0], "target": {"joint": "#2"}})"),
              "curves[0].target.joint: there is no joint '#2'");
    EXPECT_EQ(error(R"({"clip": "Walk", "path": "rotation", "times": [0], "values": [0], "target": {"joint": "hip"}})"),
              "curves[0].path: a joint's rotation is animated by a track, not by a curve");
    EXPECT_EQ(
        error(R"({"clip": "Walk", "path": "x", "times": [0], "values": [0]})"),
        "curves[0].path: expected a JSON pointer, which begins with '/', for a curve without a target, found 'x'");
    const std::string one = R"({"clip": "Walk", "name": "x", "times": [0], "values": [0]})";
    EXPECT_EQ(error(one + ", " + one), "curves[1]: an earlier curve of clip 'Walk' animates the same");
    EXPECT_EQ(error(R"({"clip": "Walk", "name": "x", "times": [0], "values": [0], "colour": 1})")
                  .find("curves[0].colour: there is no such key"),
              0u);
}

TEST(RigCurves, WhatIsWrittenIsReadBackToTheBit) {
    Scene scene = with_curves(
        R"("curves": [{"clip": "Walk", "name": "FootDown", "interpolation": "step", "times": [0, 0.1], "values": [0.3, -0.0]},
                      {"clip": "Walk", "path": "extras/grip", "target": {"joint": "knee"}, "times": [0.7], "values": [1, 2, 3]},
                      {"clip": "Walk", "path": "/extras/wind", "interpolation": "cubic", "times": [0, 1],
                       "values": [0, 1e-30, 2, 3, 4, 5]}])");
    Report report;
    const std::vector<std::byte> file = build_chunks(scene, "test", report);
    ASSERT_TRUE(validate(file).empty());
    const auto text_of = [](const std::vector<std::byte>& bytes) {
        const auto tree = read_chunk_tree(bytes);
        Faults faults;
        return write_rig(read_document(*tree, faults).objects.front());
    };
    const Rig rig = parse_rig(text_of(file), report);
    Scene again = walker();
    const JointIndex index(again);
    attach_curves(again, rig, index, report);
    EXPECT_TRUE(report.warnings().empty());
    EXPECT_EQ(build_chunks(again, "test", report), file);
}

}  // namespace
}  // namespace bendy::converter::curves_test
