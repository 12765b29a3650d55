// Constraints and the details of IK chains through the C API, held against the C++ one.
#include "capi/open_handles.h"

#include <array>
#include <string>

namespace bendy::test::constraint_test {
namespace {

class CConstraint : public testing::Test {
protected:
    const Owned expected_{sample_file()};
    const ModelHandle model_ = open_copy(sample_file());
    bendy_error error_ = BENDY_ERROR_INIT;
};

TEST_F(CConstraint, IsTheFiles) {
    ASSERT_EQ(bendy_constraint_count(model_.get()), 2u);
    EXPECT_EQ(bendy_constraint_count(nullptr), 0u);
    auto constraint = sized<bendy_constraint>();
    ASSERT_EQ(bendy_get_constraint(model_.get(), 1, &constraint, &error_), BENDY_OK) << error_.message;
    const ConstraintRecord record = swing_and_twist();
    EXPECT_EQ(constraint.joint, 1u);
    EXPECT_EQ(constraint.model, static_cast<std::uint32_t>(BENDY_CONSTRAINT_SWING_TWIST_ELLIPSE));
    EXPECT_EQ(constraint.scope, static_cast<std::uint32_t>(BENDY_SCOPE_IK_ONLY));
    EXPECT_EQ(constraint.flags, static_cast<std::uint32_t>(BENDY_PROPOSED));
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(constraint.rotation_min[k], record.rotation_min[k]);
        EXPECT_EQ(constraint.rotation_max[k], record.rotation_max[k]);
        EXPECT_EQ(constraint.translation_min[k], record.translation_min[k]);
        EXPECT_EQ(constraint.translation_max[k], record.translation_max[k]);
        EXPECT_EQ(constraint.stiffness[k], record.stiffness[k]);
    }
    EXPECT_EQ(constraint.frame[3], 0.5f);
    ASSERT_EQ(bendy_get_constraint(model_.get(), 0, &constraint, &error_), BENDY_OK);
    EXPECT_EQ(constraint.model, static_cast<std::uint32_t>(BENDY_CONSTRAINT_HINGE));
    EXPECT_EQ(constraint.soft_zone, 0.125f);
    EXPECT_EQ(constraint.preferred[0], 0.25f);
    EXPECT_EQ(bendy_get_constraint(model_.get(), 2, &constraint, &error_), BENDY_BAD_ARGUMENT);
    EXPECT_STREQ(error_.message, "constraint 2 does not exist: the model has 2 constraints");
}

TEST_F(CConstraint, IsFoundByItsJoint) {
    EXPECT_EQ(bendy_joint_constraint(model_.get(), 1), 0u);
    EXPECT_EQ(bendy_joint_ik_constraint(model_.get(), 1), 1u);
    EXPECT_EQ(bendy_joint_constraint(model_.get(), 0), BENDY_NONE);
    EXPECT_EQ(bendy_joint_ik_constraint(model_.get(), 4), BENDY_NONE);
    EXPECT_EQ(bendy_joint_constraint(nullptr, 1), BENDY_NONE);
}

TEST_F(CConstraint, ClampsAsInCpp) {
    const Constraint& hinge = expected_->constraints()[0];
    const std::array<float, 4> turned{0.6f, 0.48f, 0.0f, 0.64f};
    std::array<double, 4> r{};
    ASSERT_EQ(bendy_to_constraint_space(model_.get(), 0, turned.data(), r.data(), &error_), BENDY_OK);
    const glm::dquat expected =
        to_constraint_space(hinge, expected_->joints()[1].rest.rotation, glm::quat(0.64f, 0.6f, 0.48f, 0.0f));
    EXPECT_EQ(r, (std::array<double, 4>{expected.x, expected.y, expected.z, expected.w}));
    std::array<double, 4> clamped{};
    double violated = -1.0;
    ASSERT_EQ(bendy_clamp_rotation(model_.get(), 0, r.data(), clamped.data(), &violated, &error_), BENDY_OK);
    const glm::dquat legal = clamp_rotation(hinge, expected);
    EXPECT_EQ(clamped, (std::array<double, 4>{legal.x, legal.y, legal.z, legal.w}));
    EXPECT_EQ(violated, violation(hinge, expected));
    EXPECT_GT(violated, 0.1) << "the rotation is not legal";
    double none = -1.0;
    ASSERT_EQ(bendy_clamp_rotation(model_.get(), 0, clamped.data(), clamped.data(), &none, &error_), BENDY_OK);
    EXPECT_LT(none, 1e-6);
    std::array<float, 4> back{};
    ASSERT_EQ(bendy_from_constraint_space(model_.get(), 0, r.data(), back.data(), &error_), BENDY_OK);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(back[k], turned[k], 1e-6f);
}

TEST_F(CConstraint, ClampsTranslationsAsInCpp) {
    const std::array<float, 3> moved{1.0f, 2.0f, 3.0f};
    std::array<float, 3> clamped{};
    ASSERT_EQ(bendy_clamp_translation(model_.get(), 1, moved.data(), clamped.data(), &error_), BENDY_OK);
    const glm::vec3 legal = clamp_translation(expected_->constraints()[1], expected_->joints()[1].rest, {1, 2, 3});
    EXPECT_EQ(clamped, (std::array<float, 3>{legal.x, legal.y, legal.z}));
    EXPECT_NE(clamped, moved);
}

TEST_F(CConstraint, BadArgumentsAreErrors) {
    std::array<double, 4> r{0, 0, 0, 2};
    std::array<float, 4> rotation{0, 0, 0, 1};
    EXPECT_EQ(bendy_clamp_rotation(model_.get(), 0, r.data(), r.data(), nullptr, &error_), BENDY_BAD_ARGUMENT);
    EXPECT_STREQ(error_.message, "rotation is not a unit quaternion (x, y, z, w)");
    EXPECT_EQ(r[3], 2.0);
    EXPECT_EQ(bendy_clamp_rotation(model_.get(), 0, nullptr, r.data(), nullptr, &error_), BENDY_BAD_ARGUMENT);
    EXPECT_STREQ(error_.message, "R is NULL");
    EXPECT_EQ(bendy_to_constraint_space(model_.get(), 2, rotation.data(), r.data(), &error_), BENDY_BAD_ARGUMENT);
    EXPECT_EQ(bendy_to_constraint_space(model_.get(), 0, nullptr, r.data(), &error_), BENDY_BAD_ARGUMENT);
    EXPECT_EQ(bendy_from_constraint_space(model_.get(), 0, r.data(), rotation.data(), &error_), BENDY_BAD_ARGUMENT);
    EXPECT_EQ(bendy_clamp_translation(model_.get(), 0, nullptr, rotation.data(), &error_), BENDY_BAD_ARGUMENT);
    EXPECT_EQ(bendy_clamp_translation(nullptr, 0, rotation.data(), rotation.data(), &error_), BENDY_BAD_ARGUMENT);
}

TEST_F(CConstraint, ChainHasEveryParameter) {
    auto chain = sized<bendy_chain>();
    ASSERT_EQ(bendy_get_chain(model_.get(), 0, &chain, &error_), BENDY_OK);
    const ChainRecord& record = expected_->chains()[0].record;
    EXPECT_EQ(chain.solver, static_cast<std::uint32_t>(BENDY_SOLVER_FABRIK));
    EXPECT_EQ(chain.flags, static_cast<std::uint32_t>(BENDY_APPROXIMATED));
    EXPECT_EQ(chain.iterations, 12u);
    EXPECT_EQ(chain.priority, 7u);
    EXPECT_EQ(chain.tolerance, record.tolerance);
    EXPECT_EQ(chain.pole_vector[2], 1.0f);
    EXPECT_EQ(chain.pole_angle, -0.5f);
    EXPECT_EQ(chain.tip_offset[1], 0.25f);
    EXPECT_EQ(chain.tip_rotation[1], 1.0f);
    EXPECT_EQ(chain.position_weight, 0.75f);
    EXPECT_EQ(chain.rotation_weight, 0.25f);
    EXPECT_EQ(chain.influence, 0.5f);
    EXPECT_EQ(chain.stretch, 1.5f);
    EXPECT_EQ(chain.compress, 0.125f);
    EXPECT_STREQ(chain.extras, "[1]");
}

TEST_F(CConstraint, LinksGoFromStartToEffector) {
    std::array<std::uint32_t, 3> joints{};
    std::array<float, 3> weights{};
    ASSERT_EQ(bendy_get_links(model_.get(), 0, joints.data(), weights.data(), 3, &error_), BENDY_OK);
    EXPECT_EQ(joints, (std::array<std::uint32_t, 3>{0, 1, 2}));
    EXPECT_EQ(weights, (std::array<float, 3>{0.5f, 1.0f, 1.0f}));
    EXPECT_EQ(bendy_get_links(model_.get(), 0, joints.data(), nullptr, 2, &error_), BENDY_BAD_ARGUMENT);
    EXPECT_STREQ(error_.message, "joints has room for 2, 3 are needed");
    EXPECT_EQ(bendy_get_links(model_.get(), 0, nullptr, weights.data(), 3, &error_), BENDY_BAD_ARGUMENT);
    EXPECT_EQ(bendy_get_links(model_.get(), 2, joints.data(), nullptr, 3, &error_), BENDY_BAD_ARGUMENT);
    ASSERT_NE(bendy_chain_order(model_.get()), nullptr);
    for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(bendy_chain_order(model_.get())[k], expected_->chain_order()[k]);
    EXPECT_EQ(bendy_chain_order(model_.get())[0], 1u) << "chain 0 has the higher priority";
    EXPECT_EQ(bendy_chain_order(nullptr), nullptr);
}

}  // namespace
}  // namespace bendy::test::constraint_test
