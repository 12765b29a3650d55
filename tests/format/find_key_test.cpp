#include <bendy/format/find_key.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

namespace bendy::find_key_test {
namespace {

std::size_t find(const std::vector<float>& times, float seconds) {
    return find_key(
        times.size(), [&](std::size_t key) { return times.at(key); }, seconds);
}

/// Also at each time, and just before and after it.
void expect_as_upper_bound(const std::vector<float>& times, std::mt19937& random) {
    std::vector<float> moments{-1e30f, 1e30f, -std::numeric_limits<float>::infinity(),
                               std::numeric_limits<float>::infinity()};
    for (const float time : times) {
        for (const float toward : {-1e30f, time, 1e30f}) moments.push_back(std::nextafter(time, toward));
    }
    std::uniform_real_distribution<float> any(times.front() - 0.1f, times.back() + 0.1f);
    for (int k = 0; k < 50; ++k) moments.push_back(any(random));
    for (const float seconds : moments) {
        const auto after = std::upper_bound(times.begin(), times.end(), seconds);
        const auto expected = after == times.begin() ? 0 : after - times.begin() - 1;
        EXPECT_EQ(find(times, seconds), static_cast<std::size_t>(expected)) << times.size() << " keys, at " << seconds;
    }
}

TEST(FindKey, FindsTheLastKeyThatIsNotAfterTheTime) {
    std::mt19937 random(1);
    for (std::size_t keys = 1; keys <= 40; ++keys) {
        std::vector<float> even;
        std::vector<float> uneven;
        std::uniform_real_distribution<float> step(1e-4f, 1.0f);
        float time = -0.3f;
        for (std::size_t key = 0; key < keys; ++key) {
            even.push_back(0.25f + static_cast<float>(key) / 30.0f);
            uneven.push_back(time += step(random) * step(random));
        }
        expect_as_upper_bound(even, random);
        expect_as_upper_bound(uneven, random);
    }
}

TEST(FindKey, StaysWithinTheKeysWhateverTheTimesAre) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
    const std::vector<float> odd{0.0f, 1.0f, -1.0f, 3e38f, -3e38f, kInfinity, -kInfinity, kNothing};
    std::mt19937 random(2);
    std::uniform_int_distribution<std::size_t> any(0, odd.size() - 1);
    for (int round = 0; round < 5000; ++round) {
        std::vector<float> times(1 + static_cast<std::size_t>(round % 7));
        for (float& time : times) time = odd[any(random)];
        for (const float seconds : odd) EXPECT_LT(find(times, seconds), times.size());
    }
}

}  // namespace
}  // namespace bendy::find_key_test
