#include <bendy/runtime.h>
#include <bendy/runtime/kernels.h>

#include "runtime/build_model.h"
#include "runtime/local_joints.h"
#include "runtime/packed_model.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstring>
#include <functional>
#include <thread>
#include <vector>

// One model, many threads: most worth running under ThreadSanitizer (the preset `tsan`).
namespace bendy::threads_test {
namespace {

constexpr std::size_t kThreads = 4;

/// Runs work(0), work(1), ... each on a thread of its own, beginning together.
void run_together(const std::function<void(std::size_t)>& work) {
    std::atomic<std::size_t> waiting{0};
    std::vector<std::thread> threads;
    threads.reserve(kThreads);
    for (std::size_t number = 0; number < kThreads; ++number) {
        threads.emplace_back([&work, &waiting, number] {
            ++waiting;
            while (waiting < kThreads) std::this_thread::yield();
            work(number);
        });
    }
    for (std::thread& thread : threads) thread.join();
}

using Numbers = std::vector<float>;

/// Everything that posing gives, at some times of the clip.
Numbers pose_all(const Model& model) {
    Numbers numbers;
    Pose pose(model);
    std::vector<glm::vec3> positions(model.vertex_count());
    std::vector<glm::vec3> normals(model.vertex_count());
    std::vector<glm::vec4> tangents(model.vertex_count());
    for (int frame = 0; frame < 120; ++frame) {
        EXPECT_TRUE(sample(pose, model.clip("run"), 0.45f + 0.005f * static_cast<float>(frame)));
        EXPECT_TRUE(skin(pose, {.out = {positions, normals, tangents}}));
        for (std::size_t v = 0; v < positions.size(); ++v) {
            for (int c = 0; c < 3; ++c) numbers.insert(numbers.end(), {positions[v][c], normals[v][c], tangents[v][c]});
        }
        for (const glm::mat4& matrix : pose.model_space())
            numbers.insert(numbers.end(), &matrix[0][0], &matrix[0][0] + 16);
        numbers.insert(numbers.end(), pose.morph_weights().begin(), pose.morph_weights().end());
    }
    return numbers;
}

TEST(Threads, ShareAModelWithAPoseEach) {
    const test::Owned model(test::sample_file());
    const Numbers alone = pose_all(*model);
    std::vector<Numbers> found(kThreads);
    run_together([&](std::size_t number) {
        for (int round = 0; round < 5; ++round) found[number] = pose_all(*model);
    });
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

TEST(Threads, CheckSumsTogether) {
    OpenOptions options;
    options.sums = Sums::later;
    const test::Owned good(test::sample_file(), options);
    std::array<bool, kThreads> is_good{};
    run_together([&](std::size_t number) {
        is_good.at(number) = good->check_sums().has_value();
        for (int round = 0; round < 20; ++round)
            is_good.at(number) = good->check_sums().has_value() && is_good.at(number);
    });
    for (const bool one : is_good) EXPECT_TRUE(one);
}

// In a process of its own, as ctest runs it, this is the first use of the kernels.
TEST(Threads, ChooseKernelsTogether) {
    const test::Owned model(test::sample_file());
    std::array<bool, kThreads> is_good{};
    run_together([&](std::size_t number) {
        bool all_good = true;
        for (std::size_t round = 0; round < 20; ++round) {
            const auto available = kernels();
            all_good = set_kernel(available[(round + number) % available.size()]) && all_good;
            all_good = !kernel_name(kernel()).empty() && all_good;
            Pose pose(*model);  // others change the kernel in the middle of it
            std::vector<glm::vec3> positions(model->vertex_count());
            EXPECT_TRUE(sample(pose, model->clip("run"), 0.6f));
            all_good = skin(pose, {.out = {.positions = positions}}) && all_good;
        }
        is_good.at(number) = all_good;
    });
    EXPECT_TRUE(set_kernel(kernels().front()));
    for (const bool one : is_good) EXPECT_TRUE(one);
}

// The first Pose makes the model's plans, whichever thread it is made on.
TEST(Threads, MakeTheFirstPoseTogether) {
    const Numbers expected = pose_all(*test::Owned(test::sample_file()));
    for (int round = 0; round < 10; ++round) {
        const test::Owned model(test::sample_file());
        std::vector<Numbers> found(kThreads);
        run_together([&](std::size_t number) { found[number] = pose_all(*model); });
        for (const Numbers& numbers : found) ASSERT_EQ(numbers, expected);
    }
}

/// Blending, constraints, every solver, and levels of detail.
Numbers do_the_rest(const Model& model) {
    Numbers numbers;
    Pose pose(model);
    Pose other(model);
    Lod lod(model);
    std::vector<glm::vec3> positions(model.vertex_count());
    for (unsigned solver = 0; solver < kSolvers; ++solver) {
        EXPECT_TRUE(sample(pose, model.clips().data(), 0.7f));
        EXPECT_TRUE(sample(other, model.clips().data(), 0.9f));
        EXPECT_TRUE(blend(pose, other, 0.25f));
        constrain(pose);
        ReachOptions options;
        options.solver = static_cast<Solver>(solver);
        for (const Chain& chain : model.chains())
            EXPECT_TRUE(reach(pose, &chain, glm::vec3(0.1f, 1.2f, -0.3f), options));
        reach_all(pose);
        lod.set_share(static_cast<float>(solver) * 0.2f);
        EXPECT_TRUE(skin(pose, {.lod = &lod, .out = {.positions = positions}}));
        for (const glm::vec3& position : positions) numbers.insert(numbers.end(), {position.x, position.y, position.z});
    }
    return numbers;
}

TEST(Threads, ReachBlendAndSimplifyTogether) {
    const test::Owned model(test::sample_file());
    const Numbers expected = do_the_rest(*model);
    std::vector<Numbers> found(kThreads);
    run_together([&](std::size_t number) { found[number] = do_the_rest(*model); });
    for (const Numbers& numbers : found)
        EXPECT_EQ(std::memcmp(numbers.data(), expected.data(), expected.size() * 4), 0);
}

TEST(Threads, PlayPackedClipsTogether) {
    const test::Owned model(test::build_file(test::packed_spec(12, 40, 16)));
    std::vector<Numbers> found(kThreads);
    run_together([&](std::size_t number) {
        Pose pose(*model);
        for (int frame = 0; frame < 60; ++frame) {
            EXPECT_TRUE(sample(pose, model->clips().data(), 0.4f + 0.031f * static_cast<float>(frame * 7 % 60)));
            for (const JointTransform& joint : test::locals_of(pose)) found[number].push_back(joint.rotation.x);
        }
    });
    for (const Numbers& numbers : found) EXPECT_EQ(numbers, found.front());
}

TEST(Threads, PlayACrowdTogether) {
    const test::Owned model(test::sample_file());
    Crowd crowd(*model, kThreads);
    constexpr std::size_t kMembers = 40;
    const std::size_t floats = model->vertex_count() * 3;
    std::vector<float> positions(kMembers * floats);
    std::vector<CrowdMember> members(kMembers);
    Lod lod(*model);
    lod.set_share(0.0f);
    for (std::size_t k = 0; k < kMembers; ++k) {
        members[k].clip = model->clip("run");
        members[k].seconds = 0.75f;
        members[k].lod = k % 2 == 0 ? nullptr : &lod;
        members[k].out.positions = {std::span(positions).subspan(k * floats, floats), 3};
    }
    run_together([&](std::size_t worker) {
        constexpr std::size_t kEach = kMembers / kThreads;
        EXPECT_TRUE(crowd.play(std::span(members).subspan(worker * kEach, kEach), worker));
    });
    for (std::size_t k = 2; k < kMembers; ++k)
        EXPECT_EQ(std::memcmp(&positions[k * floats], &positions[k % 2 * floats], floats * sizeof(float)), 0) << k;
}

}  // namespace
}  // namespace bendy::threads_test
