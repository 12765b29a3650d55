#include "optimise/passes/merge_clips.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace bendy::converter::merge_clips_test {
namespace {

Clip clip_of(std::string name, std::vector<std::pair<TrackPath, std::uint32_t>> properties, bool loop = true) {
    Clip clip;
    clip.name = std::move(name);
    clip.loop = loop;
    for (const auto& [path, target] : properties)
        clip.tracks.push_back({path, Interpolation::step, target, 3, {0.5f}, {1.0f, 2.0f, 3.0f}});
    return clip;
}

std::vector<std::string> names_of(const Scene& scene) {
    std::vector<std::string> names;
    for (const Clip& clip : scene.clips) names.push_back(clip.name);
    return names;
}

constexpr auto kMove = TrackPath::translation;
constexpr auto kScale = TrackPath::scale;

TEST(MergeClips, ClipsOfDifferentJointsBecomeOne) {
    Scene scene;
    scene.clips = {clip_of("walk_hip", {{kMove, 0}, {kScale, 0}}), clip_of("walk_knee", {{kMove, 1}}),
                   clip_of("walk_foot", {{kMove, 2}}, false)};
    scene.clips[0].markers = {{0.5f, "late"}};
    scene.clips[2].markers = {{0.25f, "early"}};
    EXPECT_TRUE(is_spread_motion(scene));
    Report report;
    EXPECT_EQ(merge_clips(scene, report), 1u);
    EXPECT_EQ(names_of(scene), (std::vector<std::string>{"walk"}));
    EXPECT_EQ(scene.clips[0].tracks.size(), 4u);
    EXPECT_FALSE(scene.clips[0].loop) << "not all of them repeat";
    ASSERT_EQ(scene.clips[0].markers.size(), 2u);
    EXPECT_EQ(scene.clips[0].markers[0].name, "early");
    EXPECT_TRUE(report.warnings().empty());
}

TEST(MergeClips, ClipsThatMoveTheSameStayApart) {
    Scene scene;
    scene.clips = {clip_of("walk", {{kMove, 0}}), clip_of("run", {{kMove, 0}}), clip_of("wave", {{kMove, 3}}),
                   clip_of("idle", {{kMove, 0}, {kMove, 3}})};
    EXPECT_FALSE(is_spread_motion(scene));
    Report report;
    EXPECT_EQ(merge_clips(scene, report), 3u);
    EXPECT_EQ(names_of(scene), (std::vector<std::string>{"walk", "run", "idle"}));
    EXPECT_EQ(scene.clips[0].tracks.size(), 2u) << "wave goes to walk";
}

TEST(MergeClips, NamesKeepWholeWordsThatAllBeginWith) {
    const auto merged_name = [](const std::string& a, const std::string& b) {
        Scene scene;
        scene.clips = {clip_of(a, {{kMove, 0}}), clip_of(b, {{kMove, 1}})};
        Report report;
        merge_clips(scene, report);
        return scene.clips.at(0).name;
    };
    EXPECT_EQ(merged_name("Take 001|hip", "Take 001|knee"), "Take 001");
    EXPECT_EQ(merged_name("walk_left", "walk_leg"), "walk");
    EXPECT_EQ(merged_name("Anim", "Anim"), "Anim");
    EXPECT_EQ(merged_name("animation0", "animation1"), "animation0") << "nothing in common but half a word";
    EXPECT_EQ(merged_name("walk", "walk_knee"), "walk");
}

TEST(MergeClips, ExtrasOfOthersAreNamed) {
    Scene scene;
    scene.clips = {clip_of("a", {{kMove, 0}}), clip_of("b", {{kMove, 1}}), clip_of("c", {{kMove, 2}})};
    scene.clips[0].extras = scene.clips[1].extras = R"({"fps":30})";
    scene.clips[2].extras = R"({"fps":25})";
    Report report;
    merge_clips(scene, report);
    EXPECT_EQ(scene.clips[0].extras, R"({"fps":30})");
    ASSERT_EQ(report.warnings().size(), 1u);
    EXPECT_EQ(report.warnings()[0].first_place, "clip \"c\"");
}

TEST(MergeClips, AFewOrdinaryClipsAreNoSpreadMotion) {
    Scene scene;
    scene.clips = {clip_of("open", {{kMove, 0}}), clip_of("close", {{kMove, 1}})};
    EXPECT_FALSE(is_spread_motion(scene)) << "two may well be two";
    scene.clips = {clip_of("walk", {{kMove, 0}, {kMove, 1}}), clip_of("talk", {{kMove, 2}, {kMove, 3}}),
                   clip_of("blink", {{kMove, 4}})};
    EXPECT_FALSE(is_spread_motion(scene));
}

}  // namespace
}  // namespace bendy::converter::merge_clips_test
