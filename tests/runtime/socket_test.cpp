#include <bendy/runtime/socket.h>

#include "pose/pose_state.h"
#include "runtime/build_model.h"
#include "runtime/local_joints.h"

#include <glm/vec4.hpp>

#include <gtest/gtest.h>

#include <vector>

namespace bendy::socket_test {
namespace {

using test::Owned;

glm::mat4 at(float x, float y, float z) {
    glm::mat4 m(1.0f);
    m[3] = {x, y, z, 1.0f};
    return m;
}

/// Column by column, with a small tolerance.
void expect_matrix(const glm::mat4& is, const std::vector<float>& expected) {
    for (std::size_t k = 0; k < 16; ++k)
        EXPECT_NEAR(is[static_cast<int>(k / 4)][static_cast<int>(k % 4)], expected[k], 1e-5) << k;
}

/// An arm of metres under a joint that scales by 1/100 and a hand that is turned a quarter about z.
test::ModelSpec arm() {
    test::ModelSpec spec;
    spec.joints.resize(3);
    spec.joints[0] = {kNone, test::scaled(0.01f, 0.01f, 0.01f), {}, "armature"};
    spec.joints[1] = {0, test::moved(0, 100, 0), {}, "shoulder"};
    spec.joints[2] = {1, test::turned(90, 2), {}, "hand"};
    spec.joints[2].rest.translation = {200, 0, 0};
    return spec;
}

TEST(Socket, FollowsItsJoint) {
    const Owned model(test::build_file(arm()));
    Pose pose(*model);
    Socket socket = make_socket(*model, "hand", at(0.5f, 0, 0));
    EXPECT_EQ(socket.joint, 2u);
    // The hand at (2, 1, 0), its x axis up.
    expect_matrix(*socket_matrix(pose, socket), {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 2, 1.5f, 0, 1});
    socket.keeps_size = false;
    expect_matrix(*socket_matrix(pose, socket), {0, 0.01f, 0, 0, -0.01f, 0, 0, 0, 0, 0, 0.01f, 0, 2, 1.005f, 0, 1});
    // A quarter turn more about z, and the character elsewhere, twice as large.
    test::local_of(pose, 1)->rotation = glm::quat(std::sqrt(0.5f), 0, 0, std::sqrt(0.5f));
    socket.keeps_size = true;
    glm::mat4 world(2.0f);
    world[3] = {10, 0, 0, 1};
    // The hand at (0, 3, 0), its x axis along -x: (-0.5, 3, 0), doubled and moved.
    expect_matrix(*socket_matrix(pose, socket, world), {-2, 0, 0, 0, 0, -2, 0, 0, 0, 0, 2, 0, 9, 6, 0, 1});
    EXPECT_TRUE(PoseState::of(pose).stale.is_empty());
}

TEST(Socket, WithoutAJointItIsInTheModel) {
    const Owned model(test::build_file(arm()));
    Pose pose(*model);
    const Socket socket = make_socket(*model, "tail", at(1, 2, 3));
    EXPECT_EQ(socket.joint, kNone);
    expect_matrix(*socket_matrix(pose, socket, at(0, 0, 5)), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 8, 1});
}

TEST(Socket, FlatMirroredAndShearedJointsStillHoldAThing) {
    test::ModelSpec spec = arm();
    const std::vector<RestRecord> rests{test::scaled(0, 1, 1), test::scaled(1, 0, 1),  test::scaled(1, 1, 0),
                                        test::scaled(0, 0, 1), test::scaled(1, 0, 0),  test::scaled(0, 1, 0),
                                        test::scaled(0, 0, 0), test::scaled(-1, 1, 1), test::scaled(-3, -2, -1),
                                        test::scaled(1, -1, 1)};
    for (RestRecord rest : rests) {
        rest.shear = {0.0f, 0.5f, 0.25f};
        spec.joints[0].rest = rest;
        const Owned model(test::build_file(spec));
        Pose pose(*model);
        const glm::mat4 m = *socket_matrix(pose, make_socket(*model, "hand"));
        for (int a = 0; a < 3; ++a) {
            for (int b = 0; b < 3; ++b) {
                const double product = double{m[a].x} * m[b].x + double{m[a].y} * m[b].y + double{m[a].z} * m[b].z;
                EXPECT_NEAR(product, a == b ? 1.0 : 0.0, 1e-6);
            }
        }
        const double volume = double{m[0].x} * (double{m[1].y} * m[2].z - double{m[1].z} * m[2].y) -
                              double{m[1].x} * (double{m[0].y} * m[2].z - double{m[0].z} * m[2].y) +
                              double{m[2].x} * (double{m[0].y} * m[1].z - double{m[0].z} * m[1].y);
        EXPECT_NEAR(volume, 1.0, 1e-6);
    }
}

}  // namespace
}  // namespace bendy::socket_test
