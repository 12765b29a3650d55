#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

// Timing on a machine that others use: what is compared runs by turns in one process.
namespace bendy::cli {

struct Contestant {
    std::string name;
    std::function<void()> run;
};

struct Timing {
    double median = 0.0;  ///< ns per item
    double least = 0.0;   ///< ns per item
    double ratio = 1.0;   ///< median over rounds: this one's time over the first one's in the same round
};

inline double median_of(std::vector<double> numbers) {
    std::nth_element(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2), numbers.end());
    return numbers[numbers.size() / 2];
}

/// One Timing for each contestant. A turn takes about two milliseconds, or one run if that is longer; where a round
/// takes longer than a tenth of a second there are fewer of them, at least 5.
inline std::vector<Timing> side_by_side(const std::vector<Contestant>& contestants, double items, int rounds = 41) {
    using Clock = std::chrono::steady_clock;
    const auto nanoseconds = [](const std::function<void()>& run, std::size_t times) {
        const auto start = Clock::now();
        for (std::size_t k = 0; k < times; ++k) run();
        return std::chrono::duration<double, std::nano>(Clock::now() - start).count() / static_cast<double>(times);
    };
    std::vector<std::size_t> times;
    double round_time = 0.0;
    for (const Contestant& contestant : contestants) {
        nanoseconds(contestant.run, 1);  // warm
        const double once = nanoseconds(contestant.run, 1);
        times.push_back(static_cast<std::size_t>(std::max(1.0, 2e6 / once)));
        round_time += std::max(2e6, once);
    }
    constexpr double kLong = 1e8;  // nanoseconds
    constexpr int kFewest = 5;
    if (round_time > kLong) rounds = std::min(rounds, std::max(kFewest, static_cast<int>(rounds * kLong / round_time)));
    std::vector<std::vector<double>> taken(contestants.size());
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t k = 0; k < contestants.size(); ++k)
            taken[k].push_back(nanoseconds(contestants[k].run, times[k]) / items);
    }
    std::vector<Timing> timings;
    for (const std::vector<double>& own : taken) {
        std::vector<double> ratios;
        for (std::size_t round = 0; round < own.size(); ++round) ratios.push_back(own[round] / taken[0][round]);
        timings.push_back({median_of(own), *std::min_element(own.begin(), own.end()), median_of(ratios)});
    }
    return timings;
}

}  // namespace bendy::cli
