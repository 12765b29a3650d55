// Roles and retargeting through the C API: the same bits as by the C++ one.
#include "capi/open_handles.h"
#include "mutation/allocations.h"
#include "runtime/human_model.h"

#include <bendy/runtime/retarget.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <string>

namespace bendy::test::retarget_test {
namespace {

Buffer human_file(const HumanSpec& spec) {
    return HumanModel(spec).file();
}

/// Moves the same joints of both poses: a step with the left leg, and the arm behind it.
void step(bendy_pose* pose, Pose& cpp) {
    const float half = std::sqrt(0.5f);
    for (std::uint32_t joint = 1; joint < cpp.model().joints().size(); ++joint) {
        bendy_transform local{};
        ASSERT_EQ(bendy_get_local(pose, joint, 1, &local, nullptr), BENDY_OK);
        if (joint % 3 == 0) std::copy_n(std::array{half, 0.0f, 0.0f, half}.begin(), 4, local.rotation);
        local.translation[1] += 0.01f * static_cast<float>(joint % 2);
        ASSERT_EQ(bendy_set_local(pose, joint, 1, &local, nullptr), BENDY_OK);
        JointTransform same = cpp.local(joint);
        same.rotation = glm::quat(local.rotation[3], local.rotation[0], local.rotation[1], local.rotation[2]);
        same.translation = {local.translation[0], local.translation[1], local.translation[2]};
        cpp.set_local(joint, same);
    }
}

bool is_same(const bendy_pose* pose, const Pose& cpp) {
    for (std::uint32_t joint = 0; joint < cpp.model().joints().size(); ++joint) {
        bendy_transform local{};
        EXPECT_EQ(bendy_get_local(pose, joint, 1, &local, nullptr), BENDY_OK);
        const JointTransform expected = cpp.local(joint);
        const glm::quat& q = expected.rotation;
        const std::array numbers{
            q.x, q.y, q.z, q.w, expected.translation.x, expected.translation.y, expected.translation.z};
        if (std::memcmp(&numbers, &local, sizeof numbers) != 0) return false;
    }
    return true;
}

class CRetarget : public testing::Test {
protected:
    const HumanModel tall_{HumanSpec{}};
    const Buffer tall_file_ = tall_.file();
    const Buffer short_file_ = human_file({.facing = 90.0, .arms_down = 40.0, .thigh = 0.3, .shin = 0.25, .axes = 3});
    const ModelHandle source_ = open_copy(tall_file_);
    const ModelHandle target_ = open_copy(short_file_);
    bendy_error error_ = BENDY_ERROR_INIT;
};

TEST_F(CRetarget, JointsHaveTheRolesOfTheFile) {
    bendy_joint joint = sized<bendy_joint>();
    ASSERT_EQ(bendy_get_joint(source_.get(), tall_.joint("leftForeArm"), &joint, nullptr), BENDY_OK);
    EXPECT_EQ(joint.role, BENDY_ROLE_LEFT_LOWER_ARM);
    EXPECT_EQ(joint.role_place, 0u);
    ASSERT_EQ(bendy_get_joint(source_.get(), tall_.joint("sword"), &joint, nullptr), BENDY_OK);
    EXPECT_EQ(joint.role, BENDY_ROLE_NONE);
}

TEST_F(CRetarget, JointsOfChainsHavePlaces) {
    ModelSpec spec;
    spec.joints.resize(3);
    spec.joints[2].parent = 1;
    const std::array<RoleRecord, 2> roles{
        {{1, static_cast<std::uint16_t>(Role::tail), 0}, {2, static_cast<std::uint16_t>(Role::tail), 5}}};
    spec.more.push_back(make_leaf(FourCC("ROLE"), bytes_of(roles)));
    const ModelHandle model = open_copy(build_file(spec));
    bendy_joint joint = sized<bendy_joint>();
    ASSERT_EQ(bendy_get_joint(model.get(), 2, &joint, nullptr), BENDY_OK);
    EXPECT_EQ(joint.role, BENDY_ROLE_TAIL);
    EXPECT_EQ(joint.role_place, 5u);
    ASSERT_EQ(bendy_get_joint(model.get(), 0, &joint, nullptr), BENDY_OK);
    EXPECT_EQ(joint.role, BENDY_ROLE_NONE);
}

TEST_F(CRetarget, PosesAreTheSameAsInCpp) {
    const auto cpp_source = Model::from_memory(tall_file_);
    const auto cpp_target = Model::from_memory(short_file_);
    const PoseHandle from = new_pose(source_), to = new_pose(target_);
    Pose cpp_from(*cpp_source), cpp_to(*cpp_target);
    step(from.get(), cpp_from);
    for (const bool is_other : {false, true}) {
        bendy_retarget_options options = BENDY_RETARGET_OPTIONS_INIT;
        RetargetOptions cpp_options;
        if (is_other) {
            options.rest_poses = BENDY_REST_POSES_ALIKE;
            options.limits = BENDY_LIMITS_OFF;
            options.plants_feet = 0;
            cpp_options = {RestPoses::alike, Limits::off, false};
        }
        const RetargetHandle retarget(bendy_retarget_new(source_.get(), target_.get(), &options, &error_));
        ASSERT_NE(retarget, nullptr) << error_.message;
        auto cpp = Retarget::make(*cpp_source, *cpp_target, cpp_options);
        EXPECT_EQ(bendy_retarget_scale(retarget.get()), cpp->scale());
        EXPECT_TRUE(std::equal(cpp->joints().begin(), cpp->joints().end(), bendy_retarget_joints(retarget.get())));
        EXPECT_EQ(bendy_retarget_morph_targets(retarget.get()), nullptr);
        const RetargetStateHandle state(bendy_retarget_state_new(nullptr));
        RetargetState cpp_state;
        for (const auto& contacts : {std::optional<ContactWeights>{}, {{1.0f, 1.0f, 0.0f, 0.5f}}}) {
            bendy_retargeted result = sized<bendy_retargeted>();
            ASSERT_EQ(bendy_retarget_pose(to.get(), retarget.get(), from.get(), state.get(),
                                          contacts ? contacts->data() : nullptr, 0.02f, &result, &error_),
                      BENDY_OK)
                << error_.message;
            const auto expected = bendy::retarget(cpp_to, *cpp, cpp_from, cpp_state, contacts, 0.02f);
            EXPECT_TRUE(is_same(to.get(), cpp_to));
            EXPECT_EQ(result.missed, expected->missed);
            EXPECT_EQ(result.turned_joint, expected->turned_joint);
            EXPECT_TRUE(std::equal(expected->contacts.begin(), expected->contacts.end(), result.contacts));
        }
        // The second frame depends on where the feet stood in the first one; a state that forgets is a new one.
        ASSERT_EQ(bendy_retarget_state_reset(state.get(), nullptr), BENDY_OK);
        cpp_state = {};
        bendy_retarget_pose(to.get(), retarget.get(), from.get(), state.get(), nullptr, 0.0f, nullptr, nullptr);
        (void)bendy::retarget(cpp_to, *cpp, cpp_from, cpp_state);
        EXPECT_TRUE(is_same(to.get(), cpp_to));
    }
}

TEST_F(CRetarget, ErrorsSayWhatIsMissing) {
    const ModelHandle bare = open_copy(human_file({.has_roles = false}));
    EXPECT_EQ(bendy_retarget_new(source_.get(), bare.get(), nullptr, &error_), nullptr);
    EXPECT_EQ(error_.status, BENDY_BAD_ARGUMENT);
    EXPECT_EQ(std::string(error_.message), error_text(RetargetError{RetargetError::Reason::no_roles, false}));
    EXPECT_EQ(bendy_retarget_new(bare.get(), source_.get(), nullptr, &error_), nullptr);
    EXPECT_EQ(std::string(error_.message), error_text(RetargetError{RetargetError::Reason::no_roles, true}));
}

TEST_F(CRetarget, BadArgumentsAreRefused) {
    const RetargetHandle retarget(bendy_retarget_new(source_.get(), target_.get(), nullptr, nullptr));
    const RetargetStateHandle state(bendy_retarget_state_new(nullptr));
    const PoseHandle from = new_pose(source_), to = new_pose(target_);
    const auto refused = [&](bendy_pose* pose, bendy_pose* source, bendy_retarget_state* of, const float* contacts) {
        bendy_error error = BENDY_ERROR_INIT;
        EXPECT_EQ(bendy_retarget_pose(pose, retarget.get(), source, of, contacts, 0.0f, nullptr, &error),
                  BENDY_BAD_ARGUMENT);
        return std::string(error.message);
    };
    const std::array<float, kContacts> wrong{0.0f, std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f};
    EXPECT_EQ(refused(nullptr, from.get(), state.get(), nullptr), "pose is NULL");
    EXPECT_EQ(refused(to.get(), nullptr, state.get(), nullptr), "source is NULL");
    EXPECT_EQ(refused(to.get(), from.get(), nullptr, nullptr), "state is NULL");
    EXPECT_EQ(refused(to.get(), from.get(), state.get(), wrong.data()), "contacts holds a number that is not finite");
    EXPECT_EQ(refused(from.get(), from.get(), state.get(), nullptr), "retarget is of another model than pose");
    EXPECT_EQ(refused(to.get(), to.get(), state.get(), nullptr),
              "source is of another model than the source of the retargeting");
    const RetargetHandle to_itself(bendy_retarget_new(source_.get(), source_.get(), nullptr, nullptr));
    EXPECT_EQ(
        bendy_retarget_pose(from.get(), to_itself.get(), from.get(), state.get(), nullptr, 0.0f, nullptr, &error_),
        BENDY_BAD_ARGUMENT);
    EXPECT_EQ(std::string(error_.message), "source is the pose itself");
    bendy_retarget_options options = BENDY_RETARGET_OPTIONS_INIT;
    options.rest_poses = 2;
    EXPECT_EQ(bendy_retarget_new(source_.get(), target_.get(), &options, &error_), nullptr);
    EXPECT_EQ(std::string(error_.message), "rest_poses 2 is not a bendy_rest_poses");
    EXPECT_EQ(bendy_retarget_scale(nullptr), 0.0f);
    EXPECT_EQ(bendy_retarget_joints(nullptr), nullptr);
    EXPECT_EQ(bendy_retarget_morph_targets(nullptr), nullptr);
    bendy_retarget_free(nullptr);
    bendy_retarget_state_free(nullptr);
}

TEST_F(CRetarget, KeepsItsModelsAndAllocatesNothingPerFrame) {
    ModelHandle source = open_copy(tall_file_), target = open_copy(short_file_);
    const RetargetHandle retarget(bendy_retarget_new(source.get(), target.get(), nullptr, nullptr));
    const RetargetStateHandle state(bendy_retarget_state_new(nullptr));
    const PoseHandle from = new_pose(source), to = new_pose(target);
    source.reset();
    target.reset();
    restart_count();
    EXPECT_EQ(bendy_retarget_pose(to.get(), retarget.get(), from.get(), state.get(), nullptr, 0.0f, nullptr, nullptr),
              BENDY_OK);
    EXPECT_EQ(allocations().count, 0u);
}

}  // namespace
}  // namespace bendy::test::retarget_test
