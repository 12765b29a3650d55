#include <bendy/runtime.h>

#include "runtime/build_model.h"

#include <gtest/gtest.h>

#include <cstring>
#include <thread>
#include <vector>

namespace bendy {
namespace {

using Numbers = std::vector<float>;

/// Everything that posing gives, at some times of the cycle.
Numbers pose_all(const Model& model) {
    Numbers numbers;
    Pose pose(model);
    std::vector<glm::vec3> positions(model.vertex_count());
    std::vector<glm::vec3> normals(model.vertex_count());
    std::vector<glm::vec4> tangents(model.vertex_count());
    for (int frame = 0; frame < 120; ++frame) {
        sample(model.cycle("run"), 0.45f + 0.005f * static_cast<float>(frame), pose);
        skin(model, pose, {positions, normals, tangents});
        for (std::size_t v = 0; v < positions.size(); ++v) {
            for (int c = 0; c < 3; ++c) numbers.insert(numbers.end(), {positions[v][c], normals[v][c], tangents[v][c]});
        }
        for (const glm::mat4& matrix : pose.model_space())
            numbers.insert(numbers.end(), &matrix[0][0], &matrix[0][0] + 16);
        numbers.insert(numbers.end(), pose.target_weights().begin(), pose.target_weights().end());
    }
    return numbers;
}

TEST(Threads, ShareAModelWithAPoseEach) {
    const test::Owned model(test::sample_file());
    const Numbers alone = pose_all(*model);
    constexpr std::size_t kThreads = 4;
    std::vector<Numbers> found(kThreads);
    std::vector<std::thread> threads;
    threads.reserve(kThreads);
    for (Numbers& numbers : found) {
        threads.emplace_back([&numbers, &model] {
            for (int round = 0; round < 5; ++round) numbers = pose_all(*model);
        });
    }
    for (std::thread& thread : threads) thread.join();
    for (const Numbers& numbers : found) {
        ASSERT_EQ(numbers.size(), alone.size());
        EXPECT_EQ(std::memcmp(numbers.data(), alone.data(), alone.size() * sizeof(float)), 0);
    }
}

TEST(Threads, CheckSumsWhileOthersPose) {
    OpenOptions options;
    options.sums = Sums::later;
    const test::Owned model(test::sample_file(), options);
    bool is_good = false;
    std::thread checker([&] {
        for (int round = 0; round < 100; ++round) is_good = model->check_sums().has_value();
    });
    const Numbers posed = pose_all(*model);
    checker.join();
    EXPECT_TRUE(is_good);
    EXPECT_EQ(posed, pose_all(*test::Owned(test::sample_file())));
}

}  // namespace
}  // namespace bendy
