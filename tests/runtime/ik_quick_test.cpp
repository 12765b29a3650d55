#include "ik/ik_quick.h"
#include "pose/pose_state.h"

#include <bendy/runtime.h>

#include "runtime/build_model.h"
#include "runtime/local_joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <span>
#include <vector>

// The short way of plain chains against the long one, which holds for all chains.
namespace bendy::ik_quick_test {
namespace {

class Dice {
public:
    explicit Dice(std::uint32_t seed) : random_(seed) {}
    float number(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
    bool one_in(std::uint32_t n) { return random_() % n == 0; }
    glm::vec3 point(float size) { return {number(-size, size), number(-size, size), number(-size, size)}; }
    glm::quat turn(float angle) {
        const glm::dvec3 axis(number(-1.0f, 1.0f), number(-1.0f, 1.0f), number(0.1f, 1.0f));
        return glm::quat(glm::angleAxis(static_cast<double>(number(-angle, angle)), glm::normalize(axis)));
    }

private:
    std::mt19937 random_;
};

void set_rotation(RestRecord& rest, const glm::quat& q) {
    rest.rotation = {q.x, q.y, q.z, q.w};
}

ConstraintRecord random_constraint(Dice& dice, ConstraintModel model) {
    ConstraintRecord record;
    record.model = static_cast<std::uint8_t>(model);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        record.rotation_min.at(axis) = dice.number(-2.5f, -0.3f);
        record.rotation_max.at(axis) = dice.number(0.3f, 2.5f);
    }
    if (dice.one_in(2)) record.frame = {0.5f, 0.5f, 0.5f, 0.5f};
    return record;
}

/// A hinge, or a swing about one axis, if need be with some play about the other, and a range of twist.
ConstraintRecord random_elbow(Dice& dice, bool is_hinge) {
    if (is_hinge) return random_constraint(dice, ConstraintModel::hinge);
    const bool is_ellipse = dice.one_in(2);
    ConstraintRecord record = random_constraint(
        dice, is_ellipse ? ConstraintModel::swing_twist_ellipse : ConstraintModel::swing_twist_pyramid);
    const std::size_t locked = dice.one_in(2) ? 1 : 2;
    const float play = dice.one_in(2) ? 0.0f : dice.number(0.05f, 0.2f);
    record.rotation_min.at(locked) = -play;
    record.rotation_max.at(locked) = play;
    return record;
}

/// A root, a chain of two bones below it, and a joint that may be its pole.
test::ModelSpec arm(Dice& dice, bool is_limited, bool is_hinge = true) {
    test::ModelSpec spec;
    for (std::uint32_t joint = 0; joint < 5; ++joint) {
        test::JointSpec own;
        own.parent = joint == 0 ? kNone : joint == 4 ? 0 : joint - 1;
        set_rotation(own.rest, dice.turn(joint == 0 ? 3.0f : 1.2f));
        const glm::vec3 at = joint == 0 ? dice.point(2.0f) : glm::vec3(dice.point(0.3f)) + glm::vec3(0.0f, 1.0f, 0.0f);
        own.rest.translation = {at.x, at.y, at.z};
        if (joint == 0) own.rest.scale = {dice.number(0.5f, 2.0f), dice.number(0.5f, 2.0f), -1.0f};
        if (joint == 1 || joint == 2) {
            const float scale = dice.one_in(2) ? 1.0f : dice.number(0.5f, 2.0f);
            own.rest.scale = {scale, scale, scale};
            if (dice.one_in(2)) own.rest.scale[1] = std::nextafter(scale, 3.0f);  // as rounding leaves it
        }
        constexpr std::array kModels{ConstraintModel::swing_twist_ellipse, ConstraintModel::swing_twist_pyramid,
                                     ConstraintModel::euler_box, ConstraintModel::largest_angle};
        if (is_limited && joint == 1)
            own.constraints = {random_constraint(dice, kModels[spec.joints.size() + dice.one_in(2)])};
        if (is_limited && joint == 2) own.constraints = {random_elbow(dice, is_hinge)};
        if (is_limited && joint == 3 && dice.one_in(2)) own.constraints = {random_constraint(dice, kModels[0])};
        spec.joints.push_back(own);
    }
    ChainRecord chain;
    chain.start = 1;
    chain.effector = 3;
    if (dice.one_in(3)) chain.pole = 4;
    if (dice.one_in(3)) chain.pole_vector = {0.3f, 0.2f, 1.0f};
    if (dice.one_in(2)) chain.pole_angle = dice.number(-3.0f, 3.0f);
    spec.chains.push_back(chain);
    chain.solver = static_cast<std::uint8_t>(Solver::aim);
    chain.effector = 1;
    set_rotation(spec.joints.back().rest, dice.turn(1.0f));
    const glm::quat tip = dice.turn(3.0f);
    chain.tip_rotation = {tip.x, tip.y, tip.z, tip.w};
    spec.chains.push_back(chain);
    return spec;
}

double angle_between(const glm::quat& a, const glm::quat& b) {
    const glm::dquat turn = glm::conjugate(glm::dquat(a)) * glm::dquat(b);
    return 2.0 * std::sqrt(turn.x * turn.x + turn.y * turn.y + turn.z * turn.z);
}

struct Count {
    int quick = 0;
    int all = 0;
};

/// Random arms and targets, each by both ways.
Count compare(std::uint32_t chain, bool is_limited, bool is_hinge = true) {
    Count count;
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        Dice dice(seed);
        const test::Owned model(test::build_file(arm(dice, is_limited, is_hinge)));
        for (int k = 0; k < 10; ++k) {
            Pose quick(*model);
            if (dice.one_in(2)) test::local_of(quick, 0)->rotation = dice.turn(3.0f);
            if (!is_hinge && dice.one_in(2)) {  // twisted
                test::local_of(quick, 2)->rotation = quick.local(2).rotation * dice.turn(1.5f);
                constrain(quick);
            }
            if (is_limited && dice.one_in(2)) {  // beside the limits, as rounding leaves a clip's rotations, or outside
                const float angle = dice.one_in(2) ? 5e-7f : 1.0f;
                for (const std::uint32_t joint : {1u, 2u, 3u})
                    test::local_of(quick, joint)->rotation = quick.local(joint).rotation * dice.turn(angle);
            }
            const glm::vec3 near(quick.model_space()[2][3]);
            if (dice.one_in(2)) test::local_of(quick, 0);  // as if it had changed
            Pose general(quick);
            ReachOptions options;
            if (dice.one_in(4)) options.pole = dice.point(3.0f);
            options.obey_constraints = !dice.one_in(8);
            const ReachTarget target(near + dice.point(1.0f));
            const auto result = reach_quickly(model->chains()[chain], target, quick, options);
            ++count.all;
            if (!result) {
                const auto blocks = quick.local_blocks();
                EXPECT_EQ(std::memcmp(blocks.data(), general.local_blocks().data(), blocks.size_bytes()), 0);
                continue;
            }
            ++count.quick;
            const ReachResult expected = reach_at_length(model->chains()[chain], target, general, options).value();
            EXPECT_EQ(result->status, expected.status) << seed << ' ' << k;
            EXPECT_EQ(result->iterations, expected.iterations);
            EXPECT_NEAR(result->distance, expected.distance, 1e-5);
            EXPECT_NEAR(result->angle, expected.angle, 1e-6);
            EXPECT_FALSE(PoseState::of(quick).stale.is_empty());
            for (std::uint32_t joint = 0; joint < quick.model().joints().size(); ++joint) {
                const double off = angle_between(quick.local(joint).rotation, general.local(joint).rotation);
                EXPECT_LT(off, 1e-6) << seed << ' ' << k << ' ' << joint;
            }
        }
    }
    return count;
}

TEST(IkQuick, TwoBonesComeOutAsByTheLongWay) {
    const Count count = compare(0, false);
    EXPECT_GT(count.quick, count.all / 2);
}

TEST(IkQuick, TwoBonesInsideTheirLimitsToo) {
    const Count count = compare(0, true);
    EXPECT_GT(count.quick, count.all / 6);
    EXPECT_LT(count.quick, count.all);
}

TEST(IkQuick, ElbowsThatSwingMostlyAboutOneAxisAndTwistToo) {
    const Count count = compare(0, true, false);
    EXPECT_GT(count.quick, count.all / 5);
    EXPECT_LT(count.quick, count.all);
}

TEST(IkQuick, AimComesOutAsByTheLongWay) {
    const Count count = compare(1, false);
    EXPECT_GT(count.quick, count.all / 2);
}

TEST(IkQuick, AimInsideItsLimitsToo) {
    const Count count = compare(1, true);
    EXPECT_GT(count.quick, count.all / 20);
    EXPECT_LT(count.quick, count.all);
}

/// Six arms below one root: chain k is a limb for even k, and aims for odd k. The last arm hangs on the second one's
/// forearm, and the one before it has its pole there.
test::ModelSpec arms(Dice& dice, bool is_limited) {
    test::ModelSpec spec;
    for (std::uint32_t number = 0; number < 6; ++number) {
        test::ModelSpec own = arm(dice, is_limited && dice.one_in(2), dice.one_in(2));
        if (number == 0) spec.joints.push_back(own.joints[0]);
        const auto first = static_cast<std::uint32_t>(spec.joints.size());
        const auto moved = [&](std::uint32_t joint) {
            return joint == kNone || joint == 0 ? joint : first + joint - 1;
        };
        for (std::uint32_t joint = 1; joint < own.joints.size(); ++joint) {
            test::JointSpec& added = spec.joints.emplace_back(own.joints[joint]);
            added.parent = moved(added.parent);
        }
        for (ChainRecord& chain : own.chains) {
            chain.start = moved(chain.start);
            chain.effector = moved(chain.effector);
            if (chain.pole != kNone) chain.pole = number == 4 ? 6 : moved(chain.pole);
            spec.chains.push_back(chain);
        }
    }
    return spec;
}

/// Puts the last arm where the second one's forearm is its parent: joints are in pre-order.
test::ModelSpec arms_on_arms(Dice& dice, bool is_limited) {
    test::ModelSpec spec = arms(dice, is_limited);
    constexpr std::uint32_t kForearm = 6, kEnd = 8, kLast = 21, kOfAnArm = 4;
    std::vector<std::uint32_t> numbers(spec.joints.size());  // new ones
    for (std::uint32_t joint = 0; joint < numbers.size(); ++joint)
        numbers[joint] = joint >= kLast ? joint - kLast + kEnd : joint >= kEnd ? joint + kOfAnArm : joint;
    spec.joints[kLast].parent = spec.joints[kLast + 3].parent = kForearm;
    std::vector<test::JointSpec> joints(spec.joints.size());
    for (std::uint32_t joint = 0; joint < numbers.size(); ++joint) {
        joints[numbers[joint]] = spec.joints[joint];
        std::uint32_t& parent = joints[numbers[joint]].parent;
        if (parent != kNone) parent = numbers[parent];
    }
    spec.joints = joints;
    for (ChainRecord& chain : spec.chains) {
        chain.start = numbers[chain.start];
        chain.effector = numbers[chain.effector];
        if (chain.pole != kNone) chain.pole = numbers[chain.pole];
    }
    return spec;
}

/// Lets limbs follow joints of the root's own, which nothing else hangs on, or any joint.
void follow_joints(Dice& dice, test::ModelSpec& spec) {
    const auto arms = static_cast<float>(spec.joints.size());
    for (ChainRecord& chain : spec.chains) {
        if (dice.one_in(3)) continue;
        if (dice.one_in(4)) {
            chain.target = static_cast<std::uint32_t>(dice.number(0.0f, arms - 0.01f));
            continue;
        }
        chain.target = static_cast<std::uint32_t>(spec.joints.size());
        spec.joints.emplace_back().parent = 0;
    }
}

TEST(IkQuick, ChainsTogetherComeOutAsOneAfterAnother) {
    const Kernel before = kernel();
    for (const Kernel each : kernels()) {
        ASSERT_TRUE(set_kernel(each));
        int reached = 0;
        for (std::uint32_t seed = 0; seed < 300; ++seed) {
            Dice dice(seed);
            test::ModelSpec spec = arms_on_arms(dice, seed % 2 == 0);
            if (dice.one_in(2)) follow_joints(dice, spec);
            const test::Owned model(test::build_file(spec));
            Pose together(*model);
            if (dice.one_in(2)) test::local_of(together, 0)->rotation = dice.turn(3.0f);
            std::vector<ReachRequest> requests;
            for (std::size_t k = 0; k < 9; ++k) {
                ReachRequest& request = requests.emplace_back();
                request.chain = &model->chains()[static_cast<std::size_t>(dice.number(0.0f, 11.99f))];
                const std::uint32_t middle = model->joints()[request.chain->record.effector].parent;
                request.target = glm::vec3(together.model_space()[middle][3]) + dice.point(1.0f);
                if (dice.one_in(4)) request.options.pole = dice.point(3.0f);
                if (dice.one_in(3)) request.options.obey_constraints = false;
                if (dice.one_in(5)) request.options.tolerance = 0.01f;
                if (dice.one_in(20)) request.options.influence = 0.5f;
                if (dice.one_in(3)) request.options.carry_target = false;
                if (dice.one_in(20)) request.target.position.x = std::numeric_limits<float>::quiet_NaN();
                if (dice.one_in(20)) request.chain = nullptr;
            }
            if (dice.one_in(2)) test::local_of(together, 0);  // as if it had changed
            Pose alone(together);
            std::vector<ReachResult> results(requests.size(), {ReachStatus::aimed, 7.0f, 7.0f, 7});
            const auto outcome = reach(together, requests, results);
            Result<void, CallError> expected_outcome;
            for (std::size_t k = 0; k < requests.size(); ++k) {
                const auto& [chain, target, options] = requests[k];
                const auto expected = reach(alone, chain, target, options);
                if (!expected && expected_outcome) expected_outcome = expected.error();
                const ReachResult result = expected ? *expected : ReachResult{};
                EXPECT_EQ(results[k].status, result.status) << seed << ' ' << k;
                EXPECT_EQ(results[k].distance, result.distance) << seed << ' ' << k;
                EXPECT_EQ(results[k].angle, result.angle) << seed << ' ' << k;
                EXPECT_EQ(results[k].iterations, result.iterations) << seed << ' ' << k;
                reached += result.status == ReachStatus::reached && result.iterations == 1 ? 1 : 0;
            }
            ASSERT_EQ(outcome.has_value(), expected_outcome.has_value()) << seed;
            if (!outcome) {
                EXPECT_EQ(outcome.error(), expected_outcome.error()) << seed;
            }
            const auto blocks = together.local_blocks();
            EXPECT_EQ(std::memcmp(blocks.data(), alone.local_blocks().data(), blocks.size_bytes()), 0)
                << kernel_name(each) << ' ' << seed;
        }
        EXPECT_GT(reached, 500);
    }
    EXPECT_TRUE(set_kernel(before));
}

TEST(IkQuick, TooFewResultsAreRefusedAndNothingMoves) {
    Dice dice(1);
    const test::Owned model(test::build_file(arms(dice, false)));
    Pose pose(*model);
    const std::vector<ReachRequest> requests(2, {&model->chains()[0], glm::vec3(0.0f), {}});
    std::vector<ReachResult> results(1);
    const auto outcome = reach(pose, requests, results);
    ASSERT_FALSE(outcome);
    EXPECT_EQ(outcome.error(), CallError::output_too_short);
    const Pose rest(*model);
    const auto blocks = pose.local_blocks();
    EXPECT_EQ(std::memcmp(blocks.data(), rest.local_blocks().data(), blocks.size_bytes()), 0);
    EXPECT_TRUE(reach(pose, std::span<const ReachRequest>()));
}

TEST(IkQuick, WhatAsksForMoreGoesTheLongWay) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    Dice dice(1);
    const test::ModelSpec plain = arm(dice, false);
    const auto is_quick = [](test::ModelSpec spec, const ReachOptions& options, const auto& change) {
        spec.joints[1].rest.scale = {1.0f, 1.0f, 1.0f};
        spec.joints[2].rest.scale = {1.0f, 1.0f, 1.0f};
        spec.chains.resize(1);
        spec.chains[0].pole = kNone;
        spec.chains[0].pole_vector = {0.0f, 0.0f, 0.0f};
        change(spec);
        const test::Owned model(test::build_file(spec));
        Pose pose(*model);
        const glm::vec3 start(pose.model_space()[1][3]);
        const glm::vec3 tip(pose.model_space()[3][3]);
        ReachTarget target(start + 0.9f * (tip - start));
        return reach_quickly(model->chains()[0], target, pose, options).has_value();
    };
    const auto nothing = [](test::ModelSpec&) {};
    EXPECT_TRUE(is_quick(plain, {}, nothing));
    const auto with = [&](const auto& change) {
        ReachOptions options;
        change(options);
        return is_quick(plain, options, nothing);
    };
    EXPECT_FALSE(with([](ReachOptions& o) { o.influence = 0.5f; }));
    EXPECT_TRUE(with([](ReachOptions& o) { o.softness = 0.1f; }));
    EXPECT_FALSE(with([](ReachOptions& o) { o.solver = Solver::least_squares; }));
    EXPECT_FALSE(with([](ReachOptions& o) { o.pole = glm::vec3(std::numeric_limits<float>::infinity()); }));
    EXPECT_FALSE(is_quick(plain, {}, [](test::ModelSpec& spec) { spec.chains[0].stretch = 0.1f; }));
    EXPECT_FALSE(is_quick(plain, {}, [](test::ModelSpec& spec) { spec.chains[0].compress = 0.1f; }));
    EXPECT_FALSE(is_quick(plain, {}, [](test::ModelSpec& spec) { spec.chains[0].tip_offset = {0.0f, 0.1f, 0.0f}; }));
    EXPECT_FALSE(is_quick(plain, {}, [](test::ModelSpec& spec) { spec.chains[0].pole_angle = kNaN; }));
    EXPECT_FALSE(is_quick(plain, {}, [](test::ModelSpec& spec) { spec.joints[2].rest.scale = {1.0f, 2.0f, 1.0f}; }));
    const auto scale_unevenly = [](test::ModelSpec& spec) { spec.joints[2].rest.scale = {1.0f, 1.000005f, 1.0f}; };
    EXPECT_TRUE(is_quick(plain, {}, scale_unevenly)) << "a twentieth of the default tolerance";
    ReachOptions exact;
    exact.tolerance = 1e-3f;
    EXPECT_FALSE(is_quick(plain, exact, scale_unevenly));
    EXPECT_FALSE(is_quick(plain, {}, [](test::ModelSpec& spec) {
        ChainWeightRecord chain_weight;
        chain_weight.weight = 0.5f;
        spec.joints[2].chain_weights = {chain_weight};
    }));
    EXPECT_FALSE(is_quick(plain, {}, [](test::ModelSpec& spec) { spec.joints[0].rest.scale = {0.0f, 1.0f, 1.0f}; }));
}

}  // namespace
}  // namespace bendy::ik_quick_test
