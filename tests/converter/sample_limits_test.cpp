#include "optimise/sample_limits.h"

#include "optimise/compact/grid.h"
#include "optimise/compact/measure.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

namespace bendy::converter::sample_limits_test {
namespace {

constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

/// Joints below one another, and clips of as many keys of the first one, spread evenly over their seconds.
Scene make_scene(std::size_t joints, std::size_t clips, std::size_t keys, float seconds) {
    Scene scene;
    for (std::size_t j = 0; j < joints; ++j) {
        Joint& joint = scene.joints.emplace_back();
        joint.parent = j == 0 ? kNone : static_cast<std::uint32_t>(j - 1);
    }
    for (std::size_t c = 0; c < clips; ++c) {
        Track& track = scene.clips.emplace_back().tracks.emplace_back();
        track.target = 0;
        track.path = TrackPath::translation;
        track.components = 3;
        for (std::size_t k = 0; k < keys; ++k) {
            track.times.push_back(seconds * static_cast<float>(k) / static_cast<float>(keys - 1));
            for (int i = 0; i < 3; ++i) track.values.push_back(static_cast<float>(k));
        }
    }
    return scene;
}

double samples_of(const WorkLimits& limits) {
    double sum = 0.0;
    for (const ClipLimits& clip : limits.clips) sum += static_cast<double>(clip.samples);
    return sum;
}

TEST(SampleLimits, ClipsAsPeopleMakeThemHaveNone) {
    for (const Scene& scene :
         {make_scene(80, 1, 300, 10.0f), make_scene(1, 100, 2, 30.0f), make_scene(200, 10, 2, 2.0f)}) {
        const WorkLimits limits = find_limits(scene);
        EXPECT_TRUE(limits.can_be_measured);
        for (const ClipLimits& clip : limits.clips) EXPECT_EQ(clip.samples, kUnlimited);
    }
}

TEST(SampleLimits, SecondsAloneAskForNothing) {
    for (const float seconds : {1e6f, 1e9f, 1e30f, std::numeric_limits<float>::max()}) {
        for (const std::size_t clips : {std::size_t{1}, std::size_t{1000}}) {
            const Scene scene = make_scene(1, clips, 2, seconds);
            const WorkLimits limits = find_limits(scene);
            EXPECT_LE(samples_of(limits), 1.1e6 + 1100.0 * static_cast<double>(clips)) << seconds;
            const SourceMotion motion(scene, scene.clips[0], limits.clips[0].samples, limits.pose_bytes);
            EXPECT_LE(motion.times().size(), limits.clips[0].samples + 2);
            EXPECT_EQ(motion.times().back(), seconds);  // at the keys it is measured
        }
    }
}

TEST(SampleLimits, JointsCountToo) {
    EXPECT_LE(samples_of(find_limits(make_scene(4000, 1, 2, 1e6f))) * 4000.0, 1.2e6);
    EXPECT_LE(static_cast<double>(find_limits(make_scene(4000, 1, 2, 1e6f)).clips[0].frames) * 4000.0, 3e5);
    EXPECT_TRUE(find_limits(make_scene(4000, 1, 100, 10.0f)).can_be_measured);
    EXPECT_FALSE(find_limits(make_scene(100'000, 1, 2000, 10.0f)).can_be_measured);
}

TEST(SampleLimits, AGridHasNoMoreFramesThanItMay) {
    Scene scene = make_scene(1, 1, 3, 1000.0f);
    scene.clips[0].tracks[0].times[1] = 1.0f / 1024.0f;  // an even grid would have a million frames
    const std::size_t most = find_limits(scene).clips[0].frames;
    EXPECT_LT(most, 300'000u);
    for (const GridTracks& found : find_grids(scene.clips[0], most)) EXPECT_LE(found.grid.frames, most);
    EXPECT_TRUE(find_grids(scene.clips[0], 2).empty());
}

}  // namespace
}  // namespace bendy::converter::sample_limits_test
