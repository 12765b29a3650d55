#include "build_scene.h"
#include "rigging/rig/attach_rig.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/export.h>
#include <bendy/format/document.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace bendy::converter::markers_test {
namespace {

using namespace test;

/// A clip with keys from `start` to `end`, seconds.
Clip clip_of(const std::string& name, float start, float end) {
    Clip clip;
    clip.name = name;
    clip.tracks.push_back({TrackPath::translation, Interpolation::linear, 0, 3, {start, end}, {0, 0, 0, 0, 1, 0}});
    return clip;
}

/// One joint; Walk from 0 to 1 s, Run from 0.5 to 2 s, another Run, one without a name.
Scene walker() {
    Scene scene = make_row({"hip"});
    for (const auto& [name, start, end] :
         {std::tuple("Walk", 0.0f, 1.0f), {"Run", 0.5f, 2.0f}, {"Run", 0.0f, 1.0f}, {"", 0.0f, 4.0f}})
        scene.clips.push_back(clip_of(name, start, end));
    return scene;
}

std::string text_of(const Clip& clip) {
    std::string text;
    for (const Marker& marker : clip.markers) text += marker.name + '@' + std::to_string(marker.seconds) + ' ';
    return text;
}

std::string attach_error(const std::string& members) {
    return failure_of([&] {
        Scene scene = walker();
        Report report;
        attach_markers(scene, parse(members), report);
    });
}

Scene with_markers(const std::string& members, Report& report) {
    Scene scene = walker();
    scene.clips[3].markers.push_back({1.0f, "mine"});
    attach_markers(scene, parse(members), report);
    return scene;
}

TEST(RigMarkers, AListOrAnObject) {
    Report report;
    const Scene scene = with_markers(
        R"("markers": {"Walk": [{"time": 0.75, "name": "right"}, {"name": "left", "time": 0.25}, {"time": 0.25, "name": ""}],
                       "Run": {"step": [2, 0.5], "hit\u00e9": 1}})",
        report);
    EXPECT_EQ(text_of(scene.clips[0]), "left@0.250000 @0.250000 right@0.750000 ");
    EXPECT_EQ(text_of(scene.clips[1]), "step@0.500000 hit\xc3\xa9@1.000000 step@2.000000 ");
    EXPECT_EQ(text_of(scene.clips[2]), "");
    EXPECT_EQ(text_of(scene.clips[3]), "mine@1.000000 ");
    EXPECT_TRUE(report.warnings().empty());
}

TEST(RigMarkers, ClipsByNumber) {
    Report report;
    const Scene scene = with_markers(R"("markers": {"#2": {"a": 0}, "#3": []})", report);
    EXPECT_EQ(text_of(scene.clips[2]), "a@0.000000 ");
    EXPECT_EQ(text_of(scene.clips[3]), "");
}

TEST(RigMarkers, ACompleteFileLeavesNoOthersIfItSpeaksOfAny) {
    Report report;
    EXPECT_EQ(text_of(with_markers(R"("complete": true)", report).clips[3]), "mine@1.000000 ");
    EXPECT_EQ(text_of(with_markers(R"("complete": true, "markers": {})", report).clips[3]), "");
    EXPECT_EQ(text_of(with_markers(R"("markers": {})", report).clips[3]), "mine@1.000000 ");
}

TEST(RigMarkers, TimesThatAreRoundedAreMovedInside) {
    Report report;
    const Scene scene = with_markers(R"("markers": {"Run": {"a": 0.4995, "b": 2.0005}})", report);
    EXPECT_EQ(scene.clips[1].markers[0].seconds, 0.5f);
    EXPECT_EQ(scene.clips[1].markers[1].seconds, 2.0f);
}

TEST(RigMarkers, WhatIsWrongIsSaidWithItsPath) {
    EXPECT_EQ(rig_error(R"("markers": [])"), "markers: it must be an object, not array");
    EXPECT_EQ(rig_error(R"("markers": {"Walk": 3})"), "markers.Walk: it must be a list of markers, not 3");
    EXPECT_EQ(rig_error(R"("markers": {"Walk": [1]})"), "markers.Walk[0]: it must be an object, not 1");
    EXPECT_EQ(rig_error(R"("markers": {"Walk": [{"name": "a"}]})"), "markers.Walk[0].time: it is required and missing");
    EXPECT_EQ(rig_error(R"("markers": {"Walk": [{"time": 0}]})"), "markers.Walk[0].name: it is required and missing");
    EXPECT_EQ(rig_error(R"("markers": {"Walk": [{"time": "0", "name": "a"}]})"),
              "markers.Walk[0].time: expected a number, found '0'");
    EXPECT_EQ(rig_error(R"("markers": {"Walk": [{"time": 1e39, "name": "a"}]})"),
              "markers.Walk[0].time: 1e+39 does not fit a 32-bit float");
    EXPECT_EQ(rig_error(R"("markers": {"Walk": [{"time": 0, "name": 1}]})"),
              "markers.Walk[0].name: it must be a string, not 1");
    EXPECT_EQ(rig_error(R"("markers": {"Walk": [{"time": 0, "name": "a", "foot": 1}]})"),
              "markers.Walk[0].foot: there is no such key; there are time, name");
    EXPECT_EQ(rig_error(R"("markers": {"Walk": {"a": [0, null]}})"),
              "markers.Walk.a[1]: expected a number, found null");
    EXPECT_EQ(rig_error(R"("markers": {"Walk": {}, "Walk": {}})"), "markers.Walk: it stands twice");
}

TEST(RigMarkers, OutsideTheirClipTheyAreRefused) {
    EXPECT_EQ(attach_error(R"("markers": {"Run": [{"time": 1, "name": "a"}, {"time": 2.5, "name": "b"}]})"),
              "markers.Run[1]: 2.5 s is outside the clip, which lasts from 0.5 s to 2.0 s");
    EXPECT_EQ(attach_error(R"("markers": {"Run": {"a": [0.25]}})"),
              "markers.Run.a[0]: 0.25 s is outside the clip, which lasts from 0.5 s to 2.0 s");
    EXPECT_EQ(attach_error(R"("markers": {"Walk": {}, "#0": {}})"), "markers.'#0': clip '#0' has an earlier entry");
}

TEST(RigMarkers, ClipsThatAreNotThereAreNamed) {
    Report report;
    (void)with_markers(R"("markers": {"Fly": {"a": 0}, "#4": {"a": 0}, "#99999999999999999999": {}})", report);
    EXPECT_EQ(lines_of(report),
              (std::vector<std::string>{"markers.Fly: no clip takes 'Fly'", "markers.'#4': no clip takes '#4'",
                                        "markers.'#99999999999999999999': no clip takes '#99999999999999999999'"}));
}

/// Everything that names and floats may be comes back from the rig file.
TEST(RigMarkers, AreWrittenAsTheyWere) {
    Scene scene = walker();
    scene.clips.push_back(clip_of("#1", 0.0f, 1.0f));
    scene.clips.push_back(clip_of("\"quoted\"\n", -1.0f, 1.0f));
    scene.clips.push_back(clip_of("=#1", 0.0f, 1.0f));
    scene.clips[6].markers = {{0.25f, "b"}};
    scene.clips[0].markers = {{0.0f, "step"}, {0.1f, "step"}, {0.1f, ""}, {std::nextafter(1.0f, 0.0f), "\xc3\xa9\""}};
    scene.clips[2].markers = {{1.0f / 3.0f, "second run"}};
    scene.clips[3].markers = {{1e-40f, "tiny"}, {3.9999f, "late"}};
    scene.clips[4].markers = {{0.5f, "a"}};
    scene.clips[5].markers = {{-0.7f, std::string("a\0b", 3)}};
    Report report;
    const std::vector<std::byte> bytes = build_chunks(scene, "test", report);
    ASSERT_TRUE(validate(bytes).empty());
    const Result<ChunkTree> tree = read_chunk_tree(bytes);
    Faults faults;
    const Document document = read_document(*tree, faults);
    const std::string rig = write_rig(document.objects.at(0));
    EXPECT_NE(
        rig.find("\"Walk\": [\n      {\"time\": 0, \"name\": \"step\"},\n      {\"time\": 0.1, \"name\": \"step\"}"),
        std::string::npos)
        << rig;

    Scene bare = scene;
    for (Clip& clip : bare.clips) clip.markers = {{0.5f, "goes"}};
    attach_markers(bare, parse_rig(rig, report), report);
    EXPECT_TRUE(report.warnings().empty());
    EXPECT_EQ(build_chunks(bare, "test", report), bytes);
    EXPECT_EQ(write_rig(document.objects.at(0), false).find("markers"), std::string::npos);
}

}  // namespace
}  // namespace bendy::converter::markers_test
