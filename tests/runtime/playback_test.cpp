#include <bendy/runtime/playback.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace bendy::playback_test {
namespace {

/// The stretches of a walk that are not empty, one after another.
std::vector<TimeSpan> parts_of(const PlayedInterval& played) {
    std::vector<TimeSpan> parts;
    if (!played.first.is_empty()) parts.push_back(played.first);
    for (std::uint64_t k = 0; k < played.passes; ++k) parts.push_back(played.whole(k));
    if (!played.last.is_empty()) parts.push_back(played.last);
    return parts;
}

struct Part {
    double from, to;
    bool has_end;
};

void expect_parts(const PlayedInterval& played, const std::vector<Part>& expected) {
    const auto parts = parts_of(played);
    ASSERT_EQ(parts.size(), expected.size());
    for (std::size_t k = 0; k < parts.size(); ++k) {
        EXPECT_EQ(parts[k].from, expected[k].from) << k;
        EXPECT_EQ(parts[k].to, expected[k].to) << k;
        EXPECT_EQ(parts[k].has_end, expected[k].has_end) << k;
    }
}

TEST(Playback, OnceStopsAtTheEndAndHoldsIt) {
    Playback clock(1.0f, 3.0f, LoopMode::once);
    EXPECT_EQ(clock.seconds(), 1.0f);
    expect_parts(clock.advance(0.5), {{1.0, 1.5, false}});
    EXPECT_EQ(clock.share(), 0.25);
    EXPECT_FALSE(clock.is_done());
    expect_parts(clock.advance(100.0), {{1.5, 3.0, true}});
    EXPECT_EQ(clock.seconds(), 3.0f);
    EXPECT_TRUE(clock.is_done());
    expect_parts(clock.advance(1.0), {});
    clock.set_speed(-2.0);
    EXPECT_FALSE(clock.is_done());
    expect_parts(clock.advance(0.25), {{3.0, 2.5, false}});
    expect_parts(clock.advance(0.75), {{2.5, 1.0, true}});
    EXPECT_TRUE(clock.is_done());
    EXPECT_EQ(clock.passes(), 0);
}

TEST(Playback, RepeatJumpsFromTheEndToTheStart) {
    Playback clock(1.0f, 3.0f, LoopMode::repeat);
    expect_parts(clock.advance(1.5), {{1.0, 2.5, false}});
    expect_parts(clock.advance(1.0), {{2.5, 3.0, true}, {1.0, 1.5, false}});
    expect_parts(clock.advance(5.75), {{1.5, 3.0, true}, {1.0, 3.0, true}, {1.0, 3.0, true}, {1.0, 1.25, false}});
    EXPECT_EQ(clock.passes(), 4);
    expect_parts(clock.advance(1.75), {{1.25, 3.0, true}});  // to the very end, which is the start
    EXPECT_EQ(clock.seconds(), 1.0f);
    EXPECT_EQ(clock.passes(), 5);
}

TEST(Playback, RepeatBackwardsJumpsFromTheStartToTheEnd) {
    Playback clock(1.0f, 3.0f, LoopMode::repeat);
    clock.set_speed(-1.0);
    expect_parts(clock.advance(0.5), {{3.0, 2.5, false}});
    expect_parts(clock.advance(4.0), {{2.5, 1.0, true}, {3.0, 1.0, true}, {3.0, 2.5, false}});
    EXPECT_EQ(clock.passes(), -3);
    expect_parts(clock.advance(1.5), {{2.5, 1.0, true}});
    EXPECT_EQ(clock.seconds(), 1.0f);
    expect_parts(clock.advance(0.5), {{3.0, 2.5, false}});
    clock.set_speed(1.0);
    expect_parts(clock.advance(0.75), {{2.5, 3.0, true}, {1.0, 1.25, false}});
}

TEST(Playback, PingPongTurnsAtBothEnds) {
    Playback clock(1.0f, 3.0f, LoopMode::ping_pong);
    expect_parts(clock.advance(1.5), {{1.0, 2.5, false}});
    expect_parts(clock.advance(1.0), {{2.5, 3.0, false}, {3.0, 2.5, false}});
    EXPECT_EQ(clock.seconds(), 2.5f);
    expect_parts(clock.advance(6.5), {{2.5, 1.0, false}, {1.0, 3.0, false}, {3.0, 1.0, false}, {1.0, 2.0, false}});
    clock.set_speed(-1.0);
    expect_parts(clock.advance(1.5), {{2.0, 1.0, false}, {1.0, 1.5, false}});
    clock.seek(3.0);
    EXPECT_EQ(clock.seconds(), 3.0f);
    expect_parts(clock.advance(0.5), {{3.0, 2.5, false}});
}

/// Where a clock that began at `start` stands after so many seconds in all, by the remainder of the whole.
double expected_time(long double walked, double start, double length, LoopMode mode) {
    const long double period = mode == LoopMode::ping_pong ? 2.0L * length : static_cast<long double>(length);
    long double inside = std::fmod(walked, period);
    if (inside < 0.0L) inside += period;
    if (inside > length) inside = period - inside;
    return static_cast<double>(static_cast<long double>(start) + inside);
}

TEST(Playback, ThousandsOfLoopsAtRandomStepsDoNotDrift) {
    for (const LoopMode mode : {LoopMode::repeat, LoopMode::ping_pong}) {
        Playback clock(0.1f, 1.17f, mode);
        const double length = double{1.17f} - double{0.1f};
        std::mt19937 random(7);
        std::uniform_real_distribution<double> step(-0.4, 0.7);
        long double walked = 0.0L;
        for (int k = 0; k < 200'000; ++k) {
            const double seconds = step(random);
            walked += seconds;
            clock.advance(seconds);
        }
        EXPECT_GT(std::abs(clock.passes()), 10'000);
        // An error anywhere near the jump would show as a whole length: neither mode is near it here.
        const double is = clock.start() + clock.share() * length;
        EXPECT_NEAR(is, expected_time(walked, double{0.1f}, length, mode), 1e-10);
    }
}

TEST(Playback, WalksAddUpToTheSteps) {
    for (const LoopMode mode : {LoopMode::repeat, LoopMode::ping_pong}) {
        Playback clock(-0.5f, 0.75f, mode);
        std::mt19937 random(11);
        std::uniform_real_distribution<double> step(-5.0, 5.0);
        for (int k = 0; k < 2'000; ++k) {
            const double before = double{clock.start()} + clock.share() * 1.25;
            const double seconds = step(random);
            const auto parts = parts_of(clock.advance(seconds));
            double sum = 0.0;
            double at = before;
            for (const TimeSpan& part : parts) {
                sum += std::abs(part.to - part.from);
                const double jump = std::abs(part.from - at);  // nothing, or from one end to the other
                EXPECT_TRUE(jump < 1e-12 || std::abs(jump - 1.25) < 1e-12);
                if (mode == LoopMode::ping_pong) {
                    EXPECT_LT(jump, 1e-12);
                } else {
                    EXPECT_GE((part.to - part.from) * seconds, 0.0);
                }
                at = part.to;
            }
            EXPECT_NEAR(sum, std::abs(seconds), 1e-12);
            EXPECT_NEAR(clock.start() + clock.share() * 1.25, at, 1e-12);
        }
    }
}

TEST(Playback, HugeStepsAreExact) {
    // Powers of two, so that the remainder is known: 2^70 seconds of a clip of 3.
    Playback clock(0.0f, 3.0f, LoopMode::repeat);
    clock.advance(std::ldexp(1.0, 70));
    EXPECT_EQ(clock.seconds(), 1.0f);  // 2^70 = 4^35, and 4 leaves 1
    const PlayedInterval played = Playback(0.0f, 3.0f, LoopMode::repeat).advance(std::ldexp(1.0, 41));
    EXPECT_EQ(played.passes + 1, 733'007'751'850u);  // (2^41 - 2) / 3
    EXPECT_EQ(played.last.to, 2.0);
    for (const LoopMode mode : {LoopMode::repeat, LoopMode::ping_pong, LoopMode::once}) {
        Playback extreme(0.25f, 1.0f, mode);
        for (const double step : {1e300, -1e300, 1e18, -1e18, 1e308, -5e-324, 5e-324}) {
            extreme.advance(step);
            EXPECT_GE(extreme.seconds(), 0.25f);
            EXPECT_LE(extreme.seconds(), 1.0f);
        }
    }
}

TEST(Playback, StepsThatAreNoneWalkNothing) {
    for (const LoopMode mode : {LoopMode::repeat, LoopMode::ping_pong, LoopMode::once}) {
        Playback clock(1.0f, 3.0f, mode);
        clock.advance(0.5);
        for (const double step : {0.0, -0.0, std::numeric_limits<double>::quiet_NaN(),
                                  std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
            EXPECT_TRUE(clock.advance(step).is_empty());
            EXPECT_EQ(clock.seconds(), 1.5f);
        }
        clock.set_speed(0.0);
        EXPECT_TRUE(clock.advance(10.0).is_empty());
    }
}

TEST(Playback, WithoutLengthItStands) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const LoopMode mode : {LoopMode::repeat, LoopMode::ping_pong, LoopMode::once}) {
        for (const auto& [start, end] : std::vector<std::pair<float, float>>{
                 {2.0f, 2.0f}, {2.0f, 1.0f}, {2.0f, kNan}, {2.0f, kInfinity}, {kNan, 2.0f}, {-kInfinity, 2.0f}}) {
            Playback clock(start, end, mode);
            EXPECT_TRUE(clock.advance(0.3).is_empty());
            EXPECT_TRUE(clock.advance(-0.3).is_empty());
            clock.seek(5.0);
            EXPECT_EQ(clock.seconds(), std::isfinite(start) ? 2.0f : 0.0f);
            EXPECT_EQ(clock.share(), 0.0);
        }
    }
}

TEST(Playback, SeeksInsideTheClip) {
    Playback clock(1.0f, 3.0f, LoopMode::repeat);
    clock.seek(2.0);
    EXPECT_EQ(clock.seconds(), 2.0f);
    clock.seek(-10.0);
    EXPECT_EQ(clock.seconds(), 1.0f);
    clock.seek(std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(clock.seconds(), 1.0f);
    clock.seek_share(0.75);
    EXPECT_EQ(clock.seconds(), 2.5f);
    clock.set_mode(LoopMode::ping_pong);
    clock.advance(1.0);  // turned, at 2.5
    clock.set_mode(LoopMode::once);
    EXPECT_EQ(clock.seconds(), 2.5f);
    clock.seek(9.0);
    EXPECT_TRUE(clock.is_done());
}

TEST(Playback, AClipSaysWhetherItLoops) {
    Clip clip;
    clip.start = 0.5f;
    clip.end = 2.0f;
    EXPECT_EQ(Playback(clip).mode(), LoopMode::once);
    clip.loop = true;
    EXPECT_EQ(Playback(clip).mode(), LoopMode::repeat);
    EXPECT_EQ(Playback(clip).seconds(), 0.5f);
    EXPECT_EQ(Playback(clip).end(), 2.0);
}

}  // namespace
}  // namespace bendy::playback_test
