// Root motion, sockets and bounds through the C API, held against the C++ one.
#include "capi/open_handles.h"

#include <array>
#include <cmath>
#include <string>

namespace bendy::test::root_motion_test {
namespace {

class CMotion : public testing::Test {
protected:
    std::string message(bendy_status status) {
        EXPECT_EQ(status, BENDY_BAD_ARGUMENT);
        return error_.message;
    }

    const Owned expected_{walker_file()};
    const ModelHandle model_ = open_copy(walker_file());
    const RootPathHandle path_{bendy_root_path_new(model_.get(), 0, nullptr, nullptr)};
    const RootPath cpp_{*expected_, 0};
    bendy_error error_ = BENDY_ERROR_INIT;
};

void expect_motion(const bendy_root_motion& motion, const RootMotion& expected) {
    for (int c = 0; c < 3; ++c) EXPECT_EQ(motion.translation[c], expected.translation[c]);
    EXPECT_EQ(motion.rotation[0], expected.rotation.x);
    EXPECT_EQ(motion.rotation[1], expected.rotation.y);
    EXPECT_EQ(motion.rotation[2], expected.rotation.z);
    EXPECT_EQ(motion.rotation[3], expected.rotation.w);
}

TEST_F(CMotion, OfAClipIsAsInCpp) {
    const Clip& walk = expected_->clips()[0];
    bendy_root_motion motion = BENDY_ROOT_MOTION_INIT;
    ASSERT_EQ(bendy_root_path_at(path_.get(), 0, 0.4, &motion, &error_), BENDY_OK) << error_.message;
    expect_motion(motion, *cpp_.at(walk, 0.4));
    EXPECT_NE(motion.translation[0], 0.0);
    ASSERT_EQ(bendy_root_path_between(path_.get(), 0, 0.4, 0.9, &motion, &error_), BENDY_OK);
    expect_motion(motion, *cpp_.between(walk, 0.4, 0.9));
    const PlaybackHandle playback(bendy_playback_new(model_.get(), 0, nullptr));
    Playback cpp_playback(walk);
    auto played = sized<bendy_played>();
    ASSERT_EQ(bendy_playback_advance(playback.get(), 5.3, &played, &error_), BENDY_OK);
    ASSERT_EQ(bendy_root_path_over(path_.get(), 0, &played, &motion, &error_), BENDY_OK);
    expect_motion(motion, *cpp_.over(walk, cpp_playback.advance(5.3)));
}

TEST_F(CMotion, IsTakenOutOfAPose) {
    const PoseHandle pose = new_pose(model_);
    ASSERT_EQ(bendy_sample(pose.get(), 0, 0.5f, &error_), BENDY_OK);
    Pose cpp_pose(*expected_);
    ASSERT_TRUE(sample(cpp_pose, &expected_->clips()[0], 0.5f));
    bendy_root_motion motion = BENDY_ROOT_MOTION_INIT;
    ASSERT_EQ(bendy_root_path_extract(path_.get(), pose.get(), &motion, &error_), BENDY_OK);
    expect_motion(motion, *cpp_.extract(cpp_pose));
    bendy_transform root{};
    bendy_get_local(pose.get(), 0, 1, &root, nullptr);
    EXPECT_NEAR(root.translation[0], 1.0f, 1e-6f) << "at rest again";
    EXPECT_EQ(root.rotation[1], cpp_pose.local(0).rotation.y);
    EXPECT_EQ(bendy_root_path_extract(path_.get(), pose.get(), nullptr, &error_), BENDY_OK);
}

TEST_F(CMotion, AxesAreChosen) {
    bendy_root_axes axes = BENDY_ROOT_AXES_INIT;
    const RootAxes defaults;
    EXPECT_EQ(axes.x, defaults.x ? 1u : 0u);
    EXPECT_EQ(axes.y, defaults.y ? 1u : 0u);
    EXPECT_EQ(axes.z, defaults.z ? 1u : 0u);
    EXPECT_EQ(axes.turn, static_cast<std::uint32_t>(defaults.turn));
    axes.x = 0;
    axes.turn = BENDY_TURN_NONE;
    const RootPathHandle path(bendy_root_path_new(model_.get(), 0, &axes, &error_));
    bendy_root_motion motion = BENDY_ROOT_MOTION_INIT;
    ASSERT_EQ(bendy_root_path_at(path.get(), 0, 1.0, &motion, &error_), BENDY_OK);
    expect_motion(motion, {});
    axes.turn = 3;
    EXPECT_EQ(bendy_root_path_new(model_.get(), 0, &axes, &error_), nullptr);
    EXPECT_STREQ(error_.message, "turn 3 is not a bendy_root_turn");
}

TEST_F(CMotion, ArithmeticIsAsInCpp) {
    const RootMotion cpp_a{{1, 2, 3}, glm::dquat(0.8, 0, 0.6, 0)};
    const RootMotion cpp_b{{-1, 0, 5}, glm::dquat(0.6, 0, 0.8, 0)};
    const bendy_root_motion a{{1, 2, 3}, {0, 0.6, 0, 0.8}};
    const bendy_root_motion b{{-1, 0, 5}, {0, 0.8, 0, 0.6}};
    bendy_root_motion out = BENDY_ROOT_MOTION_INIT;
    ASSERT_EQ(bendy_root_motion_compose(&a, &b, &out, &error_), BENDY_OK);
    expect_motion(out, compose(cpp_a, cpp_b));
    ASSERT_EQ(bendy_root_motion_inverse(&a, &out, &error_), BENDY_OK);
    expect_motion(out, inverse(cpp_a));
    ASSERT_EQ(bendy_root_motion_blend(&a, &b, 0.25, &out, &error_), BENDY_OK);
    expect_motion(out, blend(cpp_a, cpp_b, 0.25));
    ASSERT_EQ(bendy_root_motion_repeat(&a, 1000, &out, &error_), BENDY_OK);
    expect_motion(out, repeat(cpp_a, 1000));
    std::array<double, 16> matrix{};
    ASSERT_EQ(bendy_root_motion_matrix(&a, matrix.data(), &error_), BENDY_OK);
    for (int k = 0; k < 16; ++k) EXPECT_EQ(matrix[static_cast<std::size_t>(k)], cpp_a.matrix()[k / 4][k % 4]);
    // The output may be an input.
    out = a;
    ASSERT_EQ(bendy_root_motion_compose(&out, &b, &out, &error_), BENDY_OK);
    expect_motion(out, compose(cpp_a, cpp_b));
    const bendy_root_motion bad{{0, 0, 0}, {0, 0, 0, 0}};
    EXPECT_EQ(message(bendy_root_motion_compose(&a, &bad, &out, &error_)),
              "rotation is not a unit quaternion (x, y, z, w)");
    expect_motion(out, compose(cpp_a, cpp_b));
    const bendy_root_motion far{{NAN, 0, 0}, {0, 0, 0, 1}};
    EXPECT_EQ(message(bendy_root_motion_inverse(&far, &out, &error_)), "translation holds a number that is not finite");
    message(bendy_root_motion_blend(&a, nullptr, 0.5, &out, &error_));
    message(bendy_root_motion_blend(&a, &b, NAN, &out, &error_));
    message(bendy_root_motion_repeat(&a, 2, nullptr, &error_));
    message(bendy_root_motion_matrix(nullptr, matrix.data(), &error_));
}

TEST_F(CMotion, BadArgumentsAreErrors) {
    bendy_root_motion motion = BENDY_ROOT_MOTION_INIT;
    EXPECT_EQ(bendy_root_path_new(model_.get(), 2, nullptr, &error_), nullptr);
    EXPECT_STREQ(error_.message, "joint 2 does not exist: the model has 2 joints");
    EXPECT_EQ(bendy_root_path_new(nullptr, 0, nullptr, &error_), nullptr);
    message(bendy_root_path_at(path_.get(), 2, 0.0, &motion, &error_));
    message(bendy_root_path_at(path_.get(), 0, NAN, &motion, &error_));
    message(bendy_root_path_at(path_.get(), 0, 0.0, nullptr, &error_));
    message(bendy_root_path_between(path_.get(), 0, 0.0, INFINITY, &motion, &error_));
    message(bendy_root_path_over(path_.get(), 0, nullptr, &motion, &error_));
    message(bendy_root_path_over(nullptr, 0, nullptr, &motion, &error_));
    const ModelHandle other = open_copy(walker_file());
    const PoseHandle other_pose = new_pose(other);
    EXPECT_EQ(message(bendy_root_path_extract(path_.get(), other_pose.get(), &motion, &error_)),
              "pose is of another model than path");
    message(bendy_root_path_extract(path_.get(), nullptr, &motion, &error_));
    expect_motion(motion, {});
    bendy_root_path_free(nullptr);
}

TEST_F(CMotion, SocketsFollowTheirJoints) {
    const PoseHandle pose = new_pose(model_);
    ASSERT_EQ(bendy_sample(pose.get(), 0, 1.0f, nullptr), BENDY_OK);
    bendy_transform tip{};
    bendy_get_local(pose.get(), 1, 1, &tip, nullptr);
    tip.scale[0] = 3.0f;
    bendy_set_local(pose.get(), 1, 1, &tip, nullptr);
    Pose cpp_pose(*expected_);
    ASSERT_TRUE(sample(cpp_pose, &expected_->clips()[0], 1.0f));
    JointTransform scaled = cpp_pose.local(1);
    scaled.scale.x = 3.0f;
    cpp_pose.set_local(1, scaled);
    const std::array<float, 16> world{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 20, 30, 1};
    for (const std::uint32_t keeps_size : {0u, 1u}) {
        bendy_socket socket = BENDY_SOCKET_INIT;
        EXPECT_EQ(socket.keeps_size, Socket().keeps_size ? 1u : 0u);
        socket.joint = 1;
        socket.offset[12] = 0.5f;
        socket.keeps_size = keeps_size;
        Socket cpp = make_socket(*expected_, "tip", glm::translate(glm::mat4(1.0f), {0.5f, 0, 0}));
        cpp.keeps_size = keeps_size != 0;
        std::array<float, 16> matrix{};
        ASSERT_EQ(bendy_socket_matrix(pose.get(), &socket, world.data(), matrix.data(), &error_), BENDY_OK);
        const glm::mat4 expected = *socket_matrix(cpp_pose, cpp, glm::translate(glm::mat4(1.0f), {10, 20, 30}));
        for (int k = 0; k < 16; ++k) EXPECT_EQ(matrix[static_cast<std::size_t>(k)], expected[k / 4][k % 4]) << k;
    }
    bendy_socket own = BENDY_SOCKET_INIT;
    std::array<float, 16> matrix{};
    ASSERT_EQ(bendy_socket_matrix(pose.get(), &own, nullptr, matrix.data(), &error_), BENDY_OK);
    EXPECT_EQ(matrix[0], 1.0f);
    EXPECT_EQ(matrix[13], 0.0f) << "the model's own space";
    own.joint = 2;
    EXPECT_EQ(message(bendy_socket_matrix(pose.get(), &own, nullptr, matrix.data(), &error_)),
              "joint 2 does not exist: the model has 2 joints");
    message(bendy_socket_matrix(pose.get(), nullptr, nullptr, matrix.data(), &error_));
    message(bendy_socket_matrix(nullptr, &own, nullptr, matrix.data(), &error_));
    own.joint = 0;
    message(bendy_socket_matrix(pose.get(), &own, nullptr, nullptr, &error_));
}

void expect_box(const bendy_box& box, const Box& expected) {
    for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(box.minimum[c], expected.minimum[c]);
        EXPECT_EQ(box.maximum[c], expected.maximum[c]);
    }
}

TEST_F(CMotion, BoundsAreAsInCpp) {
    const BoundsHandle bounds(bendy_bounds_new(model_.get(), &error_));
    const Bounds cpp(*expected_);
    const PoseHandle pose = new_pose(model_);
    ASSERT_EQ(bendy_sample(pose.get(), 0, 0.5f, nullptr), BENDY_OK);
    Pose cpp_pose(*expected_);
    ASSERT_TRUE(sample(cpp_pose, &expected_->clips()[0], 0.5f));
    bendy_box box{};
    ASSERT_EQ(bendy_bounds_of_pose(bounds.get(), pose.get(), &box, &error_), BENDY_OK);
    expect_box(box, *cpp.of(cpp_pose));
    EXPECT_NEAR(box.minimum[0], 2.0f, 1e-4f);
    ASSERT_EQ(bendy_bounds_of_joint(bounds.get(), pose.get(), 0, &box, &error_), BENDY_OK);
    expect_box(box, *cpp.of(cpp_pose, 0));
    ASSERT_EQ(bendy_bounds_of_joint(bounds.get(), nullptr, 0, &box, &error_), BENDY_OK);
    expect_box(box, cpp.joint(0));
    EXPECT_NEAR(box.maximum[0], 1.0f, 1e-4f);
    ASSERT_EQ(bendy_bounds_of_joint(bounds.get(), nullptr, 1, &box, &error_), BENDY_OK);
    EXPECT_GT(box.minimum[0], box.maximum[0]) << "empty: the tip moves nothing";
    const ModelHandle other = open_copy(walker_file());
    const PoseHandle other_pose = new_pose(other);
    EXPECT_EQ(message(bendy_bounds_of_pose(bounds.get(), other_pose.get(), &box, &error_)),
              "pose is of another model than bounds");
    message(bendy_bounds_of_pose(bounds.get(), nullptr, &box, &error_));
    message(bendy_bounds_of_pose(bounds.get(), pose.get(), nullptr, &error_));
    message(bendy_bounds_of_joint(bounds.get(), other_pose.get(), 0, &box, &error_));
    message(bendy_bounds_of_joint(bounds.get(), nullptr, 2, &box, &error_));
    message(bendy_bounds_of_joint(nullptr, nullptr, 0, &box, &error_));
    EXPECT_EQ(bendy_bounds_new(nullptr, &error_), nullptr);
    bendy_bounds_free(nullptr);
}

}  // namespace
}  // namespace bendy::test::root_motion_test
