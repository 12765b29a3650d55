#include <bendy/runtime/markers.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace bendy::markers_test {
namespace {

const std::vector<Marker> kSteps{{1.0f, "s"}, {1.5f, "a"}, {2.0f, "b"}, {2.0f, "c"}, {3.0f, "e"}};

std::string met_by(const PlayedInterval& played, const std::vector<Marker>& markers = kSteps) {
    std::string met;
    visit_markers(markers, played, [&](const Marker& marker) { met += marker.name; });
    EXPECT_EQ(count_markers(markers, played), met.size());
    std::array<const Marker*, 64> collected{};
    const std::size_t count = collect_markers(markers, played, collected);
    std::string again;
    for (std::size_t k = 0; k < count; ++k) again += collected.at(k)->name;
    EXPECT_EQ(again, met.substr(0, collected.size()));
    return met;
}

TEST(Markers, OnceMeetsBothEnds) {
    Playback clock(1.0f, 3.0f, LoopMode::once);
    EXPECT_EQ(met_by(clock.advance(0.25)), "s");
    EXPECT_EQ(met_by(clock.advance(0.25)), "");  // stands at a, which comes as it is left
    EXPECT_EQ(met_by(clock.advance(0.0)), "");
    EXPECT_EQ(met_by(clock.advance(0.125)), "a");
    EXPECT_EQ(met_by(clock.advance(5.0)), "bce");
    EXPECT_EQ(met_by(clock.advance(5.0)), "");
    clock.set_speed(-1.0);
    EXPECT_EQ(met_by(clock.advance(5.0)), "ecbas");
    EXPECT_EQ(met_by(clock.advance(5.0)), "");
}

TEST(Markers, EveryPassMeetsEachOnce) {
    Playback clock(1.0f, 3.0f, LoopMode::repeat);
    EXPECT_EQ(met_by(clock.advance(6.5)), "sabcesabcesabces");  // stands at a
    EXPECT_EQ(met_by(clock.advance(0.5)), "a");                 // at b and c
    EXPECT_EQ(met_by(clock.advance(-8.0)), "cbasecbasecbasecbase");
    EXPECT_EQ(met_by(clock.advance(-0.25)), "cb");
    EXPECT_EQ(met_by(clock.advance(-0.75)), "as");  // to the very start
    EXPECT_EQ(met_by(clock.advance(-0.5)), "e");
}

TEST(Markers, WhereItTurnsEachIsMetOnce) {
    Playback clock(1.0f, 3.0f, LoopMode::ping_pong);
    EXPECT_EQ(met_by(clock.advance(2.0)), "sabc");
    EXPECT_EQ(met_by(clock.advance(2.0)), "ecba");
    EXPECT_EQ(met_by(clock.advance(8.5)),
              "sabc"
              "ecba"
              "sabc"
              "ecba"
              "s");
    EXPECT_EQ(met_by(clock.advance(-0.75)), "as");  // left again, the other way
}

TEST(Markers, ALoopOfOneMomentIsMetEveryTime) {
    const std::vector<Marker> one{{0.0f, "x"}};
    Playback clock(0.0f, 1.0f, LoopMode::repeat);
    EXPECT_EQ(met_by(clock.advance(0.75), one), "x");
    EXPECT_EQ(met_by(clock.advance(0.25), one), "");
    EXPECT_EQ(met_by(clock.advance(0.25), one), "x");
    EXPECT_EQ(met_by(clock.advance(3.0), one), "xxx");
}

/// However a time is cut into steps, the markers met are those that lie in it on a line on which the passes are laid
/// out one after another.
TEST(Markers, StepsOfAnySizeMeetWhatLiesOnTheUnrolledLine) {
    std::mt19937 random(3);
    const std::vector<Marker> markers{{0.0f, "a"}, {0.125f, "b"}, {0.5f, "c"}, {0.9375f, "d"}};
    for (const LoopMode mode : {LoopMode::repeat, LoopMode::ping_pong}) {
        for (int round = 0; round < 40; ++round) {
            Playback clock(0.0f, 1.0f, mode);
            std::string met;
            double at = 0.0;
            for (int step = 0; step < 60; ++step) {
                const double seconds = static_cast<double>(random() % 256) / 64.0 / (round % 4 == 0 ? 16.0 : 1.0);
                met += met_by(clock.advance(seconds), markers);
                at += seconds;
            }
            std::string expected;  // whole 1/1024ths, so that nothing is rounded
            for (int pass = 0; pass <= static_cast<int>(at); ++pass) {
                const bool is_back = mode == LoopMode::ping_pong && pass % 2 == 1;
                for (std::size_t k = 0; k < markers.size(); ++k) {
                    const Marker& marker = markers[is_back ? markers.size() - 1 - k : k];
                    // The start, as the end of a way back, is met as the next pass begins.
                    if (is_back && marker.seconds == 0.0f) continue;
                    const double place = pass + (is_back ? 1.0 - marker.seconds : marker.seconds);
                    if (place < at) expected += marker.name;
                }
            }
            EXPECT_EQ(met, expected);
        }
    }
}

TEST(Markers, VisitsEndWhenTheyAreTold) {
    const PlayedInterval played = Playback(1.0f, 3.0f, LoopMode::repeat).advance(1e15);
    EXPECT_EQ(count_markers(kSteps, played), 5 * std::uint64_t{500'000'000'000'000});
    int left = 7;
    visit_markers(kSteps, played, [&](const Marker&) { return --left > 0; });
    EXPECT_EQ(left, 0);
    std::array<const Marker*, 3> few{};
    EXPECT_EQ(collect_markers(kSteps, played, few), 3u);
    EXPECT_EQ(few[2]->name, "b");
    EXPECT_EQ(collect_markers(kSteps, played, {}), 0u);
    // None in reach: however many passes, there is nothing to wait for.
    int met = 0;
    visit_markers(std::vector<Marker>{{9.0f, "z"}}, played, [&](const Marker&) { ++met; });
    EXPECT_EQ(met, 0);
}

}  // namespace
}  // namespace bendy::markers_test
