// Full-body IK through the C API: the same bits as by the C++ one.
#include "capi/open_handles.h"
#include "mutation/allocations.h"
#include "runtime/human_model.h"

#include <bendy/runtime/body_reach.h>

#include <array>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace bendy::test::body_reach_test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

bendy_effector effector(std::uint32_t joint) {
    bendy_effector made = BENDY_EFFECTOR_INIT;
    made.joint = joint;
    return made;
}

bendy_effector_target target_at(float x, float y, float z) {
    bendy_effector_target made = BENDY_EFFECTOR_TARGET_INIT;
    made.position[0] = x;
    made.position[1] = y;
    made.position[2] = z;
    return made;
}

class CBodyReach : public testing::Test {
protected:
    [[nodiscard]] BodyReachHandle body(const bendy_body_reach_options* options = nullptr) {
        return BodyReachHandle(bendy_body_reach_new(model_.get(), hands_.data(), hands_.size(), options, &error_));
    }
    /// The message of a body that is refused.
    std::string refused(const std::vector<bendy_effector>& effectors,
                        const bendy_body_reach_options& options = BENDY_BODY_REACH_OPTIONS_INIT) {
        EXPECT_EQ(bendy_body_reach_new(model_.get(), effectors.data(), effectors.size(), &options, &error_), nullptr);
        EXPECT_EQ(error_.status, BENDY_BAD_ARGUMENT);
        return error_.message;
    }

    const HumanModel human_{HumanSpec{}};
    const Buffer file_ = human_.file();
    const ModelHandle model_ = open_copy(file_);
    const std::vector<bendy_effector> hands_{effector(human_.joint("leftHand")), effector(human_.joint("rightHand"))};
    const std::vector<bendy_effector_target> targets_{target_at(0.3f, 1.2f, 0.3f), target_at(-0.2f, 1.1f, 0.4f)};
    bendy_error error_ = BENDY_ERROR_INIT;
};

TEST_F(CBodyReach, PosesAreTheSameAsInCpp) {
    const auto cpp_model = Model::from_memory(file_);
    bendy_body_reach_options options = BENDY_BODY_REACH_OPTIONS_INIT;
    BodyReachOptions cpp_options;
    EXPECT_EQ(options.iterations, cpp_options.iterations);
    EXPECT_EQ(options.restarts, cpp_options.restarts);
    EXPECT_EQ(options.obey_constraints != 0, cpp_options.obey_constraints);
    for (const bool is_other : {false, true}) {
        std::vector<bendy_effector> effectors = hands_;
        std::vector<bendy_effector_target> targets = targets_;
        std::vector<Effector> cpp_effectors{{hands_[0].joint}, {hands_[1].joint}};
        std::vector<EffectorTarget> cpp_targets{{{0.3f, 1.2f, 0.3f}, {}}, {{-0.2f, 1.1f, 0.4f}, {}}};
        if (is_other) {
            options.root = cpp_options.root = human_.joint("hips");
            options.root_shift[1] = cpp_options.root_shift.y = 0.2f;
            options.root_turn = cpp_options.root_turn = 0.3f;
            options.iterations = cpp_options.iterations = 7;
            options.restarts = cpp_options.restarts = 1;
            options.tolerance = cpp_options.tolerance = 0.01f;
            options.obey_constraints = 0;
            cpp_options.obey_constraints = false;
            effectors[0].tip_offset[0] = cpp_effectors[0].tip_offset.x = 0.1f;
            targets[0].has_rotation = 1;
            std::copy_n(std::array{0.6f, 0.0f, 0.0f, 0.8f}.begin(), 4, targets[0].rotation);
            cpp_targets[0].rotation = glm::quat(0.8f, 0.6f, 0.0f, 0.0f);
            targets[0].rotation_weight = cpp_targets[0].rotation_weight = 0.5f;
            targets[1].weight = cpp_targets[1].weight = 0.25f;
        }
        const BodyReachHandle body(
            bendy_body_reach_new(model_.get(), effectors.data(), effectors.size(), &options, &error_));
        ASSERT_NE(body, nullptr) << error_.message;
        auto cpp = BodyReach::make(*cpp_model, cpp_effectors, cpp_options);
        EXPECT_EQ(bendy_body_reach_root(body.get()), cpp->root());
        const PoseHandle pose = new_pose(model_);
        Pose cpp_pose(*cpp_model);
        auto result = sized<bendy_body_reached>();
        ASSERT_EQ(bendy_reach_body(pose.get(), body.get(), targets.data(), targets.size(), &result, &error_), BENDY_OK)
            << error_.message;
        const auto expected = reach(cpp_pose, *cpp, cpp_targets);
        EXPECT_EQ(result.is_reached != 0, expected->is_reached);
        EXPECT_EQ(result.farthest, expected->farthest);
        EXPECT_EQ(result.distance, expected->distance);
        EXPECT_EQ(result.angle, expected->angle);
        EXPECT_EQ(result.iterations, expected->iterations);
        for (std::uint32_t joint = 0; joint < cpp_model->joints().size(); ++joint) {
            bendy_transform local{};
            ASSERT_EQ(bendy_get_local(pose.get(), joint, 1, &local, nullptr), BENDY_OK);
            const JointTransform same = cpp_pose.local(joint);
            const glm::quat& q = same.rotation;
            const std::array numbers{q.x, q.y, q.z, q.w, same.translation.x, same.translation.y, same.translation.z};
            EXPECT_EQ(std::memcmp(&numbers, &local, sizeof numbers), 0) << joint;
        }
    }
}

TEST_F(CBodyReach, AnUnreachedTargetIsAResult) {
    const BodyReachHandle body = this->body();
    ASSERT_NE(body, nullptr) << error_.message;
    const PoseHandle pose = new_pose(model_);
    const std::array far{targets_[0], target_at(0.0f, 9.0f, 0.0f)};
    auto result = sized<bendy_body_reached>();
    ASSERT_EQ(bendy_reach_body(pose.get(), body.get(), far.data(), 2, &result, &error_), BENDY_OK);
    EXPECT_EQ(result.is_reached, 0u);
    EXPECT_EQ(result.farthest, 1u);
    EXPECT_GT(result.distance, 5.0f);
}

TEST_F(CBodyReach, BadEffectorsAreRefused) {
    EXPECT_EQ(refused({}), "expected 1 to 32 effectors, found 0");
    EXPECT_EQ(refused(std::vector<bendy_effector>(33, hands_[0])), "expected 1 to 32 effectors, found 33");
    const auto joints = bendy_joint_count(model_.get());
    const std::string count = std::to_string(joints);
    const std::string no_joint = "joint " + count + " does not exist: the model has " + count + " joints";
    EXPECT_EQ(refused({hands_[0], effector(joints)}), no_joint);
    EXPECT_EQ(bendy_body_reach_new(model_.get(), nullptr, 1, nullptr, &error_), nullptr);
    EXPECT_EQ(std::string(error_.message), "effectors is NULL");
    std::vector<bendy_effector> wrong = hands_;
    wrong[1].tip_offset[2] = kNaN;
    EXPECT_EQ(refused(wrong), "tip_offset holds a number that is not finite");
    bendy_body_reach_options options = BENDY_BODY_REACH_OPTIONS_INIT;
    options.root = human_.joint("leftHand");
    EXPECT_EQ(refused(hands_, options), "root is not at or above all effectors");
    options.root = joints;
    EXPECT_EQ(refused(hands_, options), no_joint);
    options = BENDY_BODY_REACH_OPTIONS_INIT;
    options.root_turn = kNaN;
    EXPECT_EQ(refused(hands_, options), "root_turn holds a number that is not finite");
    bendy_body_reach_free(nullptr);
    EXPECT_EQ(bendy_body_reach_root(nullptr), BENDY_NONE);
}

TEST_F(CBodyReach, BadTargetsAreRefusedAndThePoseStays) {
    const BodyReachHandle body = this->body();
    const PoseHandle pose = new_pose(model_);
    const auto refused = [&](bendy_pose* of, const std::vector<bendy_effector_target>& targets) {
        EXPECT_EQ(bendy_reach_body(of, body.get(), targets.data(), targets.size(), nullptr, &error_),
                  BENDY_BAD_ARGUMENT);
        return std::string(error_.message);
    };
    EXPECT_EQ(refused(nullptr, targets_), "pose is NULL");
    EXPECT_EQ(refused(pose.get(), {targets_[0]}), "expected a target for each of 2 effectors, found 1");
    const ModelHandle other = open_copy(file_);
    EXPECT_EQ(refused(new_pose(other).get(), targets_), "body is of another model than pose");
    auto wrong = targets_;
    wrong[1].position[0] = kNaN;
    EXPECT_EQ(refused(pose.get(), wrong), "position holds a number that is not finite");
    wrong = targets_;
    wrong[1].weight = 1.5f;
    EXPECT_EQ(refused(pose.get(), wrong), "weight must lie between 0 and 1");
    wrong = targets_;
    wrong[1].has_rotation = 1;
    wrong[1].rotation[3] = 0.0f;
    EXPECT_NE(refused(pose.get(), wrong).find("rotation"), std::string::npos);
    wrong = targets_;
    wrong[1].size += 4;
    EXPECT_EQ(refused(pose.get(), wrong), "targets have different sizes");
    EXPECT_EQ(skinned(pose.get(), model_.get()), skinned(new_pose(model_).get(), model_.get()));

    bendy_transform broken{};
    const std::uint32_t spine = human_.joint("spine1");
    ASSERT_EQ(bendy_get_local(pose.get(), spine, 1, &broken, nullptr), BENDY_OK);
    broken.translation[0] = std::numeric_limits<float>::max();
    broken.scale[0] = std::numeric_limits<float>::max();
    ASSERT_EQ(bendy_set_local(pose.get(), spine, 1, &broken, nullptr), BENDY_OK);
    EXPECT_EQ(refused(pose.get(), targets_), "the pose holds numbers that are not finite");
}

TEST_F(CBodyReach, KeepsItsModelAndAllocatesNothingPerCall) {
    ModelHandle model = open_copy(file_);
    const BodyReachHandle body(bendy_body_reach_new(model.get(), hands_.data(), hands_.size(), nullptr, nullptr));
    const PoseHandle pose = new_pose(model);
    model.reset();
    restart_count();
    EXPECT_EQ(bendy_reach_body(pose.get(), body.get(), targets_.data(), targets_.size(), nullptr, nullptr), BENDY_OK);
    EXPECT_EQ(allocations().count, 0u);
}

#if defined(__cpp_exceptions) && !defined(_WIN32)
TEST_F(CBodyReach, MemoryThatRunsOutIsAnError) {
    std::uint64_t failures = 0;
    for (std::uint64_t number = 1;; ++number) {
        fail_allocation(number);
        const BodyReachHandle body = this->body();
        const bool is_through = is_failure_pending();
        fail_allocation(0);
        if (is_through) break;
        ++failures;
        ASSERT_EQ(body, nullptr) << number;
        ASSERT_EQ(error_.status, BENDY_OUT_OF_MEMORY) << number;
    }
    EXPECT_GT(failures, 4u);
}
#endif

}  // namespace
}  // namespace bendy::test::body_reach_test
