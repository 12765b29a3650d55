#include <bendy/runtime/body_reach.h>
#include <bendy/runtime/constrain.h>

#include "mutation/allocations.h"
#include "runtime/human_model.h"
#include "runtime/local_joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <vector>

// Targets are made by posing the human inside its limits; results are judged by joint matrices.
namespace bendy::body_reach_test {
namespace {

using test::HumanModel;
using test::HumanSpec;

constexpr double kMillimetre = 1e-3;  // the human is 1.7 m tall
const std::vector<std::string> kEnds{"leftHand", "rightHand", "leftFoot", "rightFoot", "head"};

ConstraintRecord box(double degrees) {
    ConstraintRecord record;
    record.model = static_cast<std::uint8_t>(ConstraintModel::euler_box);
    const auto limit = static_cast<float>(degrees * M_PI / 180.0);
    record.rotation_min = {-limit, -limit, -limit};
    record.rotation_max = {limit, limit, limit};
    return record;
}

HumanModel limited(HumanSpec spec, double degrees) {
    HumanModel human(std::move(spec));
    for (auto& joint : human.spec.joints) {
        if (joint.parent != kNone) joint.constraints = {box(degrees)};
    }
    return human;
}

class Human {
public:
    explicit Human(const HumanModel& human) : human_(human), model_(human.file()), pose_(*model_), posed_(*model_) {
        for (const std::string& end : kEnds) effectors_.push_back({joint(end)});
        for (const Effector& effector : effectors_) {
            for (std::uint32_t j = effector.joint; j != joint("hips"); j = model_->parents()[j]) moving_.push_back(j);
        }
    }

    [[nodiscard]] const Model& model() const { return *model_; }
    [[nodiscard]] std::uint32_t joint(const std::string& name) const { return human_.joint(name); }
    [[nodiscard]] std::span<const Effector> effectors() const { return effectors_; }
    Pose& pose() { return pose_; }
    glm::dvec3 place(std::uint32_t joint) { return {pose_.model_space()[joint][3]}; }
    glm::dvec3 place(const std::string& name) { return place(joint(name)); }
    [[nodiscard]] BodyReach body(const BodyReachOptions& options = {}) const {
        auto made = BodyReach::make(*model_, effectors_, options);
        EXPECT_TRUE(made);
        return *std::move(made);
    }

    /// Where the effectors are if each joint is turned at random inside its limits.
    std::vector<EffectorTarget> reachable_targets(std::mt19937& random, double most) {
        std::uniform_real_distribution<double> angle(-most, most);
        posed_.set_rest();
        for (const std::uint32_t moved : moving_) {
            const glm::dvec3 turn(angle(random), angle(random), angle(random));
            const glm::dquat R = glm::angleAxis(glm::length(turn), glm::normalize(turn));
            const Constraint* constraint = model_->ik_constraint(moved);
            const glm::quat rest = model_->joints()[moved].rest.rotation;
            JointTransform local = posed_.local(moved);
            local.rotation = constraint == nullptr
                                 ? glm::quat(glm::dquat(rest) * R)
                                 : from_constraint_space(*constraint, rest, clamp_rotation(*constraint, R));
            posed_.set_local(moved, local);
        }
        std::vector<EffectorTarget> targets;
        for (const Effector& one : effectors_) {
            const glm::mat4& matrix = posed_.model_space()[one.joint];
            targets.push_back({glm::vec3(matrix[3]), {}});
        }
        return targets;
    }
    [[nodiscard]] glm::quat posed_turn(std::uint32_t joint) {
        return glm::quat_cast(glm::mat3(posed_.model_space()[joint]));
    }

    double farthest(std::span<const EffectorTarget> targets) {
        double most = 0.0;
        for (std::size_t k = 0; k < targets.size(); ++k)
            most = std::max(most, glm::length(place(effectors_[k].joint) - glm::dvec3(targets[k].position)));
        return most;
    }
    [[nodiscard]] double worst_violation() const {
        double most = 0.0;
        for (const std::uint32_t moved : moving_) {
            const Constraint* constraint = model_->ik_constraint(moved);
            if (constraint == nullptr) continue;
            const auto R =
                to_constraint_space(*constraint, model_->joints()[moved].rest.rotation, pose_.local(moved).rotation);
            most = std::max(most, violation(*constraint, R));
        }
        return most;
    }

private:
    HumanModel human_;
    test::Owned model_;
    Pose pose_, posed_;
    std::vector<Effector> effectors_;
    std::vector<std::uint32_t> moving_;
};

TEST(BodyReach, ReachesFiveTargetsInsideTheLimits) {
    HumanSpec centimetres;
    centimetres.is_z_up = true;
    for (const HumanSpec& spec : {HumanSpec{}, centimetres}) {
        Human human(limited(spec, 40.0));
        BodyReach body = human.body();
        std::mt19937 random(3);
        int reached = 0;
        constexpr int kTargets = 200;
        for (int k = 0; k < kTargets; ++k) {
            const auto targets = human.reachable_targets(random, 0.7);
            human.pose().set_rest();
            const auto result = reach(human.pose(), body, targets);
            ASSERT_TRUE(result);
            const double farthest = human.farthest(targets);
            reached += farthest <= kMillimetre ? 1 : 0;
            EXPECT_NEAR(double{result->distance}, farthest, 1e-5);
            EXPECT_LE(human.worst_violation(), 1e-6);
        }
        EXPECT_GE(reached, kTargets * 199 / 200);
    }
}

TEST(BodyReach, TakesTheNearestJointAboveAllEffectorsAsItsRoot) {
    const Human human(limited({}, 40.0));
    EXPECT_EQ(human.body().root(), human.joint("hips"));
    const Effector hand{human.joint("leftHand")};
    const auto lone = BodyReach::make(human.model(), std::span(&hand, 1));
    ASSERT_TRUE(lone);
    EXPECT_EQ(lone->root(), hand.joint);
}

TEST(BodyReach, MovesNothingElse) {
    Human human(limited({}, 40.0));
    BodyReach body = human.body();
    std::mt19937 random(4);
    const Pose before = human.pose();
    ASSERT_TRUE(reach(human.pose(), body, human.reachable_targets(random, 0.5)));
    for (const std::string name : {"root", "hips", "leftToes", "leftMiddle", "sword"}) {
        EXPECT_EQ(human.pose().local(human.joint(name)).rotation, before.local(human.joint(name)).rotation) << name;
    }
    for (std::uint32_t joint = 0; joint < human.model().joints().size(); ++joint)
        EXPECT_EQ(human.pose().local(joint).translation, before.local(joint).translation);
}

TEST(BodyReach, MovesAndTurnsTheRootOnlyWithinItsRange) {
    Human human(limited({}, 40.0));
    BodyReachOptions options;
    options.root_shift = {0.1f, 0.2f, 0.0f};
    options.root_turn = 0.3f;
    BodyReach body = human.body(options);
    std::mt19937 random(5);
    auto targets = human.reachable_targets(random, 0.3);
    const glm::dvec3 start = human.place("hips");
    const glm::quat turn = human.pose().local(human.joint("hips")).rotation;
    for (auto& target : targets) target.position += glm::vec3(0.05f, -0.1f, 0.0f);
    const auto near = reach(human.pose(), body, targets);
    ASSERT_TRUE(near);
    EXPECT_TRUE(near->is_reached);
    EXPECT_LE(human.farthest(targets), kMillimetre);
    for (auto& target : targets) target.position += glm::vec3(-3.0f, 2.0f, 1.0f);
    human.pose().set_rest();
    const auto far = reach(human.pose(), body, targets);
    ASSERT_TRUE(far);
    EXPECT_FALSE(far->is_reached);
    const glm::dvec3 shift = human.place("hips") - start;
    EXPECT_NEAR(shift.x, -0.1, 1e-5);
    EXPECT_NEAR(shift.y, 0.2, 1e-5);
    EXPECT_NEAR(shift.z, 0.0, 1e-6);
    const glm::dquat turned(glm::conjugate(turn) * human.pose().local(human.joint("hips")).rotation);
    EXPECT_LE(2.0 * std::acos(std::min(1.0, std::abs(turned.w))), 0.3 + 1e-3);
}

TEST(BodyReach, TurnsEffectorsToTheirTargets) {
    Human human(limited({}, 60.0));
    BodyReach body = human.body();
    std::mt19937 random(6);
    int reached = 0;
    for (int k = 0; k < 20; ++k) {
        auto targets = human.reachable_targets(random, 0.4);
        for (std::size_t e = 0; e < targets.size(); ++e)
            targets[e].rotation = human.posed_turn(human.effectors()[e].joint);
        human.pose().set_rest();
        const auto result = reach(human.pose(), body, targets);
        ASSERT_TRUE(result);
        if (!result->is_reached) continue;
        ++reached;
        for (std::size_t e = 0; e < targets.size(); ++e) {
            const glm::dquat now(glm::quat_cast(glm::mat3(human.pose().model_space()[human.effectors()[e].joint])));
            EXPECT_GT(std::abs(glm::dot(now, glm::dquat(*targets[e].rotation))), 1.0 - 1e-6);
        }
    }
    EXPECT_GE(reached, 19);
}

TEST(BodyReach, WeighsTargetsThatCannotAllBeReached) {
    Human human(limited({}, 40.0));
    const std::vector<Effector> hands{{human.joint("leftHand")}, {human.joint("rightHand")}};
    BodyReachOptions options;
    options.root = human.joint("hips");
    auto body = BodyReach::make(human.model(), hands, options);
    ASSERT_TRUE(body);
    const glm::vec3 aside(2.0f, 0.5f, 0.0f);
    const auto distances = [&](float left, float right) {
        human.pose().set_rest();
        const glm::vec3 l = aside, r = glm::vec3(-aside.x, aside.y, aside.z);
        const std::vector<EffectorTarget> targets{{l, {}, left}, {r, {}, right}};
        EXPECT_TRUE(reach(human.pose(), *body, targets));
        return glm::dvec2(glm::length(human.place("leftHand") - glm::dvec3(l)),
                          glm::length(human.place("rightHand") - glm::dvec3(r)));
    };
    const glm::dvec2 left = distances(1.0f, 0.01f), right = distances(0.01f, 1.0f), only = distances(1.0f, 0.0f);
    EXPECT_LT(left.x, right.x - 0.01);
    EXPECT_LT(right.y, left.y - 0.01);
    EXPECT_LE(only.x, left.x + 1e-3);
}

TEST(BodyReach, ReachesWhereScalesDifferByFivePercent) {
    HumanModel uneven = limited({}, 40.0);
    for (const std::string name : {"spine0", "leftArm", "rightUpLeg"})
        uneven.spec.joints[uneven.joint(name)].rest.scale = {1.0f, 1.03f, 0.98f};
    Human human(uneven);
    BodyReach body = human.body();
    std::mt19937 random(8);
    int reached = 0;
    for (int k = 0; k < 20; ++k) {
        const auto targets = human.reachable_targets(random, 0.4);
        human.pose().set_rest();
        const auto result = reach(human.pose(), body, targets);
        ASSERT_TRUE(result);
        reached += human.farthest(targets) <= kMillimetre ? 1 : 0;
        EXPECT_EQ(result->is_reached, human.farthest(targets) <= 2e-4);
    }
    EXPECT_EQ(reached, 20);
}

TEST(BodyReach, SaysWhatIsWrongAndLeavesThePoseAsItIs) {
    Human human(limited({}, 40.0));
    const Human other(limited({}, 40.0));
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    const auto error_of = [&](const std::vector<Effector>& effectors, const BodyReachOptions& options = {}) {
        const auto made = BodyReach::make(human.model(), effectors, options);
        EXPECT_FALSE(made);
        return made ? CallError::not_available : made.error();
    };
    const std::uint32_t hand = human.joint("leftHand");
    EXPECT_EQ(error_of({}), CallError::missing);
    EXPECT_EQ(error_of({{kNone}}), CallError::out_of_range);
    EXPECT_EQ(error_of(std::vector<Effector>(BodyReach::kMostEffectors + 1, {hand})), CallError::wrong_size);
    EXPECT_EQ(error_of({{hand, {kNaN, 0.0f, 0.0f}}}), CallError::not_finite);
    BodyReachOptions beside;
    beside.root = human.joint("rightArm");
    EXPECT_EQ(error_of({{hand}}, beside), CallError::out_of_range);
    BodyReachOptions endless;
    endless.root_turn = kNaN;
    EXPECT_EQ(error_of({{hand}}, endless), CallError::not_finite);

    BodyReach body = human.body();
    std::mt19937 random(7);
    const auto targets = human.reachable_targets(random, 0.3);
    const Pose before = human.pose();
    const auto fails = [&](Pose& pose, std::span<const EffectorTarget> wrong) {
        const auto result = reach(pose, body, wrong);
        EXPECT_FALSE(result);
        return result ? CallError::not_available : result.error();
    };
    EXPECT_EQ(fails(human.pose(), std::span(targets).first(4)), CallError::wrong_size);
    auto wrong = targets;
    wrong[1].position.y = kNaN;
    EXPECT_EQ(fails(human.pose(), wrong), CallError::not_finite);
    wrong = targets;
    wrong[2].rotation = glm::quat(0.0f, 0.0f, 0.0f, 0.0f);
    EXPECT_EQ(fails(human.pose(), wrong), CallError::not_finite);
    Pose stranger(other.model());
    EXPECT_EQ(fails(stranger, targets), CallError::other_model);
    for (std::uint32_t joint = 0; joint < human.model().joints().size(); ++joint)
        EXPECT_EQ(human.pose().local(joint).rotation, before.local(joint).rotation);
    JointTransform broken = human.pose().local(human.joint("spine1"));
    broken.rotation.x = kNaN;
    human.pose().set_local(human.joint("spine1"), broken);
    EXPECT_EQ(fails(human.pose(), targets), CallError::not_finite);
}

TEST(BodyReach, MakesNoAllocation) {
    Human human(limited({}, 40.0));
    BodyReach body = human.body();
    std::mt19937 random(9);
    const auto targets = human.reachable_targets(random, 0.6);
    const std::uint64_t before = test::allocations().count;
    const auto result = reach(human.pose(), body, targets);
    EXPECT_EQ(test::allocations().count, before);
    EXPECT_TRUE(result);
}

}  // namespace
}  // namespace bendy::body_reach_test
