#include <bendy/runtime/blend.h>
#include <bendy/runtime/ik.h>
#include <bendy/runtime/reach_state.h>

#include "runtime/limbs.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <span>
#include <vector>

// Chains that reach in frame after frame, with and without a state.
namespace bendy::limbs_test {
namespace {

constexpr float kFrame = 1.0f / 60.0f;

double angle_between(const glm::quat& a, const glm::quat& b) {
    const glm::dquat by = glm::conjugate(glm::dquat(a)) * glm::dquat(b);
    return 2.0 * std::asin(std::min(1.0, glm::length(glm::dvec3(by.x, by.y, by.z))));
}

/// Turns of a chain's joints in model space.
std::vector<glm::dquat> turns_of(const Chain& chain, Pose& pose) {
    std::vector<glm::dquat> turns;
    for (std::uint32_t joint = chain.record.start; joint <= chain.record.effector; ++joint)
        turns.push_back(glm::normalize(glm::quat_cast(glm::dmat3(pose.model_space()[joint]))));
    return turns;
}

double largest_step(const std::vector<glm::dquat>& before, const std::vector<glm::dquat>& now) {
    double most = 0.0;
    for (std::size_t i = 0; i < now.size(); ++i) {
        const glm::dquat by = glm::conjugate(before[i]) * now[i];
        most = std::max(most, 2.0 * std::asin(std::min(1.0, glm::length(glm::dvec3(by.x, by.y, by.z)))));
    }
    return most;
}

/// A limb on its way from one random pose to another, with a still target, half of the time out of its limits' reach.
class Motion {
public:
    Motion(const Model& model, std::mt19937& random) : model_(model), from_(model), to_(model) {
        std::uniform_real_distribution<float> side(-1.0f, 1.0f);
        pose_at_random(model, chain(), 0.5, from_, random);
        pose_at_random(model, chain(), 0.5, to_, random);
        glm::vec3 way;
        for (const int axis : {2, 1, 0}) way[axis] = side(random);
        target = position_of(from_, chain().record.start) + way;
    }

    [[nodiscard]] const Chain& chain() const { return model_.chains()[0]; }
    [[nodiscard]] Pose at(float share) const {
        Pose pose = from_;
        EXPECT_TRUE(blend(pose, to_, share));
        return pose;
    }

    glm::vec3 target{0.0f};

private:
    const Model& model_;
    Pose from_, to_;
};

/// Counts the frames in which a joint turns by over 5 degrees more than the clip turns one.
struct Jumps {
    void add(const std::vector<glm::dquat>& own, const std::vector<glm::dquat>& now) {
        if (!before_.empty()) {
            ++frames;
            jumps += largest_step(before_, now) > largest_step(own_before_, own) + radians(5) ? 1 : 0;
        }
        before_ = now;
        own_before_ = own;
    }
    void begin() { before_.clear(); }

    int frames = 0, jumps = 0;

private:
    std::vector<glm::dquat> before_, own_before_;
};

TEST(IkOverTime, WithoutAStateAStillTargetSeldomMakesALimbJump) {
    constexpr int kTargets = 40, kFrames = 60, kLimbLinks = 3;
    Jumps jumps;
    for (const test::ModelSpec& limb : limbs()) {
        if (limb.joints.size() != kLimbLinks) continue;
        const test::Owned model(build_file(limb));
        std::mt19937 random(3);
        for (int i = 0; i < kTargets; ++i) {
            const Motion motion(*model, random);
            jumps.begin();
            for (int frame = 0; frame < kFrames; ++frame) {
                Pose pose = motion.at(static_cast<float>(frame) / kFrames);
                const std::vector<glm::dquat> own = turns_of(motion.chain(), pose);
                ASSERT_TRUE(reach(pose, &motion.chain(), motion.target));
                jumps.add(own, turns_of(motion.chain(), pose));
            }
        }
    }
    // Where two poses are equally near, a result without a memory has to jump.
    EXPECT_LT(jumps.jumps, jumps.frames / 50) << "of " << jumps.frames;
}

TEST(IkOverTime, WithAStateNothingJumpsAndLimitsHold) {
    constexpr int kTargets = 10, kFrames = 60, kRest = 120;
    Jumps jumps;
    int worse = 0, motions = 0;
    for (const test::ModelSpec& limb : limbs()) {
        const test::Owned model(build_file(limb));
        std::mt19937 random(3);
        for (int i = 0; i < kTargets; ++i) {
            const Motion motion(*model, random);
            ReachState state(*model);
            ReachOptions options;
            options.state = &state;
            options.seconds = kFrame;
            jumps.begin();
            ReachResult last;
            for (int frame = 0; frame < kFrames + kRest; ++frame) {
                Pose pose = motion.at(static_cast<float>(std::min(frame, kFrames)) / kFrames);
                const std::vector<glm::dquat> own = turns_of(motion.chain(), pose);
                const auto result = reach(pose, &motion.chain(), motion.target, options);
                ASSERT_TRUE(result);
                jumps.add(own, turns_of(motion.chain(), pose));
                ASSERT_LT(worst_violation(*model, pose), 1e-6);
                const glm::vec3 tip = position_of(pose, motion.chain().record.effector);
                ASSERT_NEAR(result->distance, glm::length(tip - motion.target), 1e-5);
                last = *result;
            }
            // After a rest it is as near as without a state.
            Pose pose = motion.at(1.0f);
            const auto alone = reach(pose, &motion.chain(), motion.target);
            ASSERT_TRUE(alone);
            ++motions;
            worse += last.distance > alone->distance + 5e-3f ? 1 : 0;
        }
    }
    EXPECT_EQ(jumps.jumps, 0) << "of " << jumps.frames;
    EXPECT_LE(worse, motions / 100) << "of " << motions;
}

/// A head that looks to any side by 60 degrees.
test::ModelSpec head() {
    test::ModelSpec spec = rope(1, 0.0);
    spec.joints[1].constraints = {ellipse(30, 60)};
    ChainRecord& chain = spec.chains[0];
    chain.start = 1;
    chain.effector = 1;
    chain.solver = static_cast<std::uint8_t>(Solver::aim);
    return spec;
}

TEST(IkOverTime, ALookFollowsWhatPassesBehindAtTheSpeedLimit) {
    const test::Owned model(build_file(head()));
    const Chain& chain = model->chains()[0];
    for (const float speed : {4.0f, 1.0f}) {
        ReachState state(*model);
        ReachOptions options;
        options.state = &state;
        options.seconds = kFrame;
        options.speed_limit = speed;
        Pose pose(*model);
        const glm::vec3 from = position_of(pose, 1);
        std::optional<glm::dquat> before;
        double largest = 0.0, side_before = 0.0, side_after = 0.0;
        constexpr int kFrames = 240;
        for (int frame = 0; frame < kFrames; ++frame) {
            // From 150 to 210 degrees in half a second, and then still.
            const double degrees = 150.0 + 60.0 * std::min(1.0, frame / 30.0);
            const double angle = radians(degrees);
            pose.set_rest();
            ASSERT_TRUE(reach(pose, &chain, from + glm::vec3(std::sin(angle), 0.0, std::cos(angle)), options));
            ASSERT_LT(worst_violation(*model, pose), 1e-6);
            const glm::dquat now(pose.local(1).rotation);
            if (before) largest = std::max(largest, largest_step({*before}, {now}));
            before = now;
            (frame == 0 ? side_before : side_after) = (now * glm::dvec3(0.0, 0.0, 1.0)).x;
        }
        EXPECT_GT(side_before, 0.4);
        EXPECT_LT(side_after, -0.4);
        const double target_step = radians(2.0);  // a frame
        EXPECT_LT(largest, speed * kFrame + 3.0 * target_step + 1e-4);
        EXPECT_GT(largest, 0.9 * speed * kFrame);
    }
}

TEST(IkOverTime, WhereNothingJumpsTheStateChangesNothing) {
    const test::Owned model(build_file(rope(2, 20.0)));
    const Chain& chain = model->chains()[0];
    ReachState state(*model);
    ReachOptions options;
    options.state = &state;
    options.seconds = kFrame;
    for (int frame = 0; frame < 120; ++frame) {
        const float angle = 0.05f * static_cast<float>(frame);
        const glm::vec3 target(0.4f * std::sin(angle), 1.2f, 0.5f + 0.4f * std::cos(angle));
        Pose with(*model), without(*model);
        ASSERT_TRUE(reach(with, &chain, target, options));
        ASSERT_TRUE(reach(without, &chain, target));
        for (std::uint32_t joint = 0; joint < 3; ++joint)
            EXPECT_EQ(with.local(joint).rotation, without.local(joint).rotation) << "frame " << frame;
    }
}

/// Two limbs side by side, the second of which is solved with the first where that is possible.
test::ModelSpec pair_of_limbs() {
    test::ModelSpec spec = limbs()[0];
    const auto joints = static_cast<std::uint32_t>(spec.joints.size());
    for (std::uint32_t joint = 0; joint < joints; ++joint) {
        test::JointSpec copy = spec.joints[joint];
        if (copy.parent != kNone) copy.parent += joints;
        spec.joints.push_back(copy);
    }
    ChainRecord chain = spec.chains[0];
    chain.start += joints;
    chain.effector += joints;
    spec.chains.push_back(chain);
    return spec;
}

TEST(IkOverTime, ChainsInOneCallReachAsOneAfterAnother) {
    const test::Owned model(build_file(pair_of_limbs()));
    std::mt19937 random(5);
    for (int i = 0; i < 10; ++i) {
        const Motion motion(*model, random);
        ReachState one(*model), other(*model);
        for (int frame = 0; frame < 60; ++frame) {
            Pose alone = motion.at(static_cast<float>(frame) / 60.0f);
            Pose together = alone;
            std::vector<ReachRequest> requests;
            for (const Chain& chain : model->chains()) {
                ReachOptions options;
                options.seconds = kFrame;
                options.state = &one;
                ASSERT_TRUE(reach(alone, &chain, motion.target, options));
                options.state = &other;
                requests.push_back({&chain, motion.target, options});
            }
            ASSERT_TRUE(reach(together, requests));
            for (std::uint32_t joint = 0; joint < model->joints().size(); ++joint) {
                EXPECT_LT(angle_between(alone.local(joint).rotation, together.local(joint).rotation), 1e-4)
                    << "joint " << joint << ", frame " << frame;
            }
        }
    }
}

TEST(IkOverTime, WhatIsForgottenBeginsAnew) {
    const test::Owned model(build_file(head()));
    const Chain& chain = model->chains()[0];
    const auto look = [&](float x, ReachState* state) {
        Pose pose(*model);
        ReachOptions options;
        options.state = state;
        options.seconds = 0.0f;
        EXPECT_TRUE(reach(pose, &chain, position_of(pose, 1) + glm::vec3(x, 0.0f, -1.0f), options));
        return pose.local(1).rotation;
    };
    ReachState state(*model);
    const glm::quat left = look(0.02f, &state);
    EXPECT_EQ(left, look(0.02f, nullptr));
    EXPECT_LT(angle_between(look(-0.02f, &state), left), 0.2);  // no time has passed
    ASSERT_TRUE(state.forget(&chain));
    EXPECT_EQ(look(-0.02f, &state), look(-0.02f, nullptr));
    (void)look(0.02f, &state);
    state.reset();
    EXPECT_EQ(look(-0.02f, &state), look(-0.02f, nullptr));
}

TEST(IkOverTime, InfluenceBlendsWhatTheStateMakes) {
    const test::Owned model(build_file(rope(2, 20.0)));
    const Chain& chain = model->chains()[0];
    ReachState state(*model);
    ReachOptions options;
    options.state = &state;
    options.seconds = kFrame;
    options.influence = 0.5f;
    Pose half(*model), whole(*model), rest(*model);
    ASSERT_TRUE(reach(half, &chain, glm::vec3(0.4f, 1.2f, 0.5f), options));
    ASSERT_TRUE(reach(whole, &chain, glm::vec3(0.4f, 1.2f, 0.5f)));
    for (std::uint32_t joint = 0; joint < 3; ++joint) {
        const glm::quat middle = glm::slerp(rest.local(joint).rotation, whole.local(joint).rotation, 0.5f);
        EXPECT_LT(angle_between(half.local(joint).rotation, middle), 1e-4);
    }
}

TEST(IkOverTime, AStateOfAnotherModelIsRefused) {
    const test::Owned model(build_file(rope(2, 20.0))), twin(build_file(rope(2, 20.0)));
    ReachState state(*twin);
    ReachOptions options;
    options.state = &state;
    Pose pose(*model);
    const glm::quat before = pose.local(0).rotation;
    const auto alone = reach(pose, &model->chains()[0], glm::vec3(0.4f, 1.2f, 0.5f), options);
    ASSERT_FALSE(alone);
    EXPECT_EQ(alone.error(), CallError::other_model);
    const ReachRequest request{&model->chains()[0], glm::vec3(0.4f, 1.2f, 0.5f), options};
    const auto listed = reach(pose, {&request, 1});
    ASSERT_FALSE(listed);
    EXPECT_EQ(listed.error(), CallError::other_model);
    EXPECT_EQ(pose.local(0).rotation, before);
}

TEST(IkOverTime, OddSecondsAndSpeedsAreCalm) {
    const test::Owned model(build_file(rope(2, 20.0)));
    const Chain& chain = model->chains()[0];
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
    for (const float seconds : {kNaN, kInf, -1.0f, 1e30f}) {
        for (const float speed : {kNaN, kInf, -1.0f, 1e30f}) {
            ReachState state(*model);
            ReachOptions options;
            options.state = &state;
            options.seconds = seconds;
            options.speed_limit = speed;
            for (const float x : {0.5f, -0.5f, 1e20f}) {
                Pose pose(*model);
                ASSERT_TRUE(reach(pose, &chain, glm::vec3(x, 1.0f, 0.2f), options));
                for (const JointTransform& joint : test::locals_of(pose))
                    ASSERT_NEAR(glm::length(glm::dquat(joint.rotation)), 1.0, 1e-5);
            }
        }
    }
}

}  // namespace
}  // namespace bendy::limbs_test
