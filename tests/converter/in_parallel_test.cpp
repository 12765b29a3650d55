#include "scene/in_parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <vector>

namespace bendy::converter::in_parallel_test {
namespace {

TEST(InParallel, EachCallIsMadeOnce) {
    for (const std::size_t threads : {0u, 1u, 3u, 40u}) {
        std::vector<std::atomic<int>> calls(25);
        std::vector<std::atomic<int>> at_work(std::max<std::size_t>(threads, 1));
        std::atomic<bool> is_shared{false};
        in_parallel(threads, calls.size(), [&](std::size_t k, std::size_t worker) {
            if (++at_work.at(worker) > 1) is_shared = true;
            ++calls.at(k);
            --at_work.at(worker);
        });
        EXPECT_TRUE(std::all_of(calls.begin(), calls.end(), [](const auto& each) { return each == 1; })) << threads;
        EXPECT_FALSE(is_shared) << threads;
    }
    in_parallel(4, 0, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(InParallel, WhatACallThrowsIsThrown) {
    const auto call = [](std::size_t k, std::size_t) {
        if (k == 5) throw std::runtime_error("five");
    };
    EXPECT_THROW(in_parallel(1, 100, call), std::runtime_error);
    EXPECT_THROW(in_parallel(3, 100, call), std::runtime_error);
}

TEST(SharedProgress, IsToldInStepsUpToOne) {
    std::vector<double> told;
    const std::function<void(double)> tell = [&](double part) { told.push_back(part); };
    SharedProgress progress(tell, 30.0);
    for (int k = 0; k < 30'000; ++k) progress.add(0.001);
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_LE(told.size(), 101u);
    EXPECT_GE(told.size(), 90u);
    EXPECT_EQ(told.back(), 1.0);
    SharedProgress nothing(tell, 0.0);
    told.clear();
    nothing.add(0.0);
    EXPECT_TRUE(told.empty());
}

}  // namespace
}  // namespace bendy::converter::in_parallel_test
