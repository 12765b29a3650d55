#include "peer_timing.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>

namespace bendy::bench {
namespace {

constexpr double kTurn = 1.5e6;     // nanoseconds that a contestant runs in a round
constexpr double kLongest = 6.0e9;  // nanoseconds of all rounds
constexpr int kFewestRounds = 9;

/// Nanoseconds a run.
double time_of(const std::function<void()>& run, std::size_t times) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    for (std::size_t k = 0; k < times; ++k) run();
    return std::chrono::duration<double, std::nano>(Clock::now() - start).count() / static_cast<double>(times);
}

double median_of(std::vector<double> numbers) {
    std::sort(numbers.begin(), numbers.end());
    const std::size_t half = numbers.size() / 2;
    return numbers.size() % 2 == 1 ? numbers[half] : 0.5 * (numbers[half - 1] + numbers[half]);
}

/// Three digits, without an exponent.
std::string text_of(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*f", number < 10.0 ? 2 : number < 100.0 ? 1 : 0, number);
    return text;
}

}  // namespace

void Table::print_head() {
    std::printf("| character | what | ns a | beside | ours | theirs | least / least | median of ratios |\n");
    std::printf("|---|---|---|---|---|---|---|---|\n");
}

void Table::compare(const Race& race, const std::vector<Contestant>& contestants) {
    std::vector<std::size_t> times;
    double round = 0.0;
    for (const Contestant& contestant : contestants) {
        time_of(contestant.run, 2);
        const double once = time_of(contestant.run, 1);
        times.push_back(static_cast<std::size_t>(std::max(1.0, kTurn / once)));
        round += std::max(kTurn, once);
    }
    const auto affordable = static_cast<int>(std::min(1e6, kLongest / round));
    const auto rounds = static_cast<std::size_t>(std::min(rounds_, std::max(kFewestRounds, affordable)));
    std::vector<std::vector<double>> taken(contestants.size(), std::vector<double>(rounds));
    for (std::size_t k = 0; k < rounds; ++k) {
        for (std::size_t turn = 0; turn < contestants.size(); ++turn) {
            const std::size_t who = k % 2 == 0 ? turn : contestants.size() - 1 - turn;
            taken[who][k] = time_of(contestants[who].run, times[who]) / race.items;
        }
    }
    const auto least = [&](std::size_t who) { return *std::min_element(taken[who].begin(), taken[who].end()); };
    for (std::size_t who = 1; who < contestants.size(); ++who) {
        std::vector<double> ratios;
        for (std::size_t k = 0; k < rounds; ++k) ratios.push_back(taken[0][k] / taken[who][k]);
        std::printf("| %s | %s | %s | %s | %s | %s | %.2f | %.2f |\n", race.subject.c_str(), race.what.c_str(),
                    race.unit.c_str(), contestants[who].name.c_str(), text_of(least(0)).c_str(),
                    text_of(least(who)).c_str(), least(0) / least(who), median_of(ratios));
    }
    std::fflush(stdout);
}

void Table::print_notes() const {
    for (const std::string& note : notes_) std::printf("\n%s\n", note.c_str());
}

void fail(std::string_view message) {
    std::fflush(stdout);
    std::fprintf(stderr, "bendy_bench_peers: %.*s\n", static_cast<int>(message.size()), message.data());
    std::exit(1);
}

void check(bool is_good, std::string_view what) {
    if (!is_good) fail(std::string(what) + " failed");
}

}  // namespace bendy::bench
