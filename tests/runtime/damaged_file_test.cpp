#include <bendy/runtime.h>

#include "mutation/places.h"
#include "runtime/build_model.h"
#include "runtime/use_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <random>
#include <vector>

// What is not refused must be harmless: this is most worth running under AddressSanitizer and
// UndefinedBehaviorSanitizer.
namespace bendy::damaged_file_test {
namespace {

using test::Buffer;

/// 1 if the bytes are a model, which then has been used; 0 if they are refused.
int try_out(Bytes bytes, const OpenOptions& options = {}) {
    const Result<Model> model = Model::from_memory(bytes, options);
    if (!model) return 0;
    EXPECT_LT(test::read_all(*model), std::numeric_limits<std::uint64_t>::max());
    test::pose_all(*model);
    return 1;
}

TEST(DamagedFile, AnyBitWithSumsRepairedIsRefusedOrHarmless) {
    const Buffer good = test::sample_file();
    int accepted = 0;
    int refused = 0;
    const test::Places visited = test::places();
    for (std::size_t bit = visited.first; bit < good.size() * 8; bit += visited.step) {
        Buffer file = good;
        file[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
        if (!test::resum(file)) {
            ++refused;
            EXPECT_FALSE(Model::from_memory(file).has_value());
            continue;
        }
        try_out(file) == 1 ? ++accepted : ++refused;
        if (testing::Test::HasFailure()) FAIL() << "bit " << bit;
    }
    EXPECT_GT(accepted, 100);  // letters, colours, positions, ...
    EXPECT_GT(refused, 100);
}

TEST(DamagedFile, AnyBitIsRefusedByTheSums) {
    const Buffer good = test::sample_file();
    for (std::size_t bit = 0; bit < good.size() * 8; bit += 3) {
        Buffer file = good;
        file[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
        ASSERT_FALSE(Model::from_memory(file).has_value()) << bit;
    }
}

TEST(DamagedFile, AnyFieldWithAnExtremeNumberIsRefusedOrHarmless) {
    const Buffer good = test::sample_file();
    constexpr std::array<std::uint32_t, 11> kNumbers{0,
                                                     1,
                                                     2,
                                                     0x7fff'ffff,
                                                     0x8000'0000,
                                                     0xffff'ffff,
                                                     0xffff'fffe,
                                                     0x7f80'0000 /* inf */,
                                                     0x7fc0'0000 /* nan */,
                                                     0x7f7f'ffff /* max */,
                                                     0x0001'0000};
    OpenOptions options;
    options.sums = Sums::later;
    const test::Places visited = test::places();
    for (std::size_t at = 4 * visited.first; at + 4 <= good.size(); at += 4 * visited.step) {
        for (const std::uint32_t number : kNumbers) {
            Buffer file = good;
            test::patch(file, at, number);
            try_out(file, options);
            if (testing::Test::HasFailure()) FAIL() << "offset " << at << ", number " << number;
        }
    }
}

TEST(DamagedFile, ManyChangesAtOnceAreRefusedOrHarmless) {
    const Buffer good = test::sample_file();
    std::mt19937 random(5);
    OpenOptions options;
    options.sums = Sums::later;
    int accepted = 0;
    for (int round = 0; round < 3000; ++round) {
        Buffer file = good;
        const auto changes = 1 + random() % 6;
        for (unsigned long change = 0; change < changes; ++change)
            file[random() % file.size()] = static_cast<std::byte>(random() % 4 == 0 ? random() % 256 : random() % 8);
        accepted += try_out(file, options);
        if (testing::Test::HasFailure()) FAIL() << "round " << round;
    }
    EXPECT_GT(accepted, 10);
}

TEST(DamagedFile, WhatIsMadeOfThemIsHarmless) {
    const Buffer good = test::sample_file();
    std::mt19937 random(6);
    OpenOptions options;
    options.sums = Sums::later;
    int accepted = 0;
    for (int round = 0; round < 600; ++round) {
        Buffer file = good;
        for (int change = 0; change < 3; ++change)
            file[random() % file.size()] = static_cast<std::byte>(random() % 256);
        const Result<Model> model = Model::from_memory(file, options);
        if (!model) continue;
        ++accepted;
        test::play_all(*model);
        if (testing::Test::HasFailure()) FAIL() << "round " << round;
    }
    EXPECT_GT(accepted, 50);
}

}  // namespace
}  // namespace bendy::damaged_file_test
