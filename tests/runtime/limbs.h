#pragma once

#include <bendy/runtime/constraint.h>
#include <bendy/runtime/pose.h>

#include "runtime/build_model.h"
#include "runtime/local_joints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

// Chains with limits, for the tests of IK.
namespace bendy::limbs_test {

inline float radians(double degrees) {
    return static_cast<float>(degrees * M_PI / 180.0);
}

inline ConstraintRecord ellipse(double twist, double swing) {
    ConstraintRecord constraint;
    constraint.model = static_cast<std::uint8_t>(ConstraintModel::swing_twist_ellipse);
    constraint.frame = {0.5f, 0.5f, 0.5f, 0.5f};  // the twist is about the joint's Y
    constraint.rotation_min = {radians(-twist), radians(-swing), radians(-swing)};
    constraint.rotation_max = {radians(twist), radians(swing), radians(swing)};
    return constraint;
}

inline ConstraintRecord hinge(double low, double high) {
    ConstraintRecord constraint;
    constraint.model = static_cast<std::uint8_t>(ConstraintModel::hinge);
    constraint.rotation_min[0] = radians(low);
    constraint.rotation_max[0] = radians(high);
    return constraint;
}

/// A rope up the Y axis, one joint more than bones; bent by `bend` degrees to either side in turn; one chain over it
/// all.
inline test::ModelSpec rope(std::uint32_t bones, double bend = 5.0, float bone = 1.0f) {
    test::ModelSpec spec;
    for (std::uint32_t joint = 0; joint <= bones; ++joint) {
        test::JointSpec j;
        j.parent = joint == 0 ? kNone : joint - 1;
        j.rest = test::turned(joint == 0 || joint == bones ? 0.0 : joint % 2 == 1 ? bend : -bend, 0);
        j.rest.translation = {0.0f, joint == 0 ? 0.0f : bone, 0.0f};
        spec.joints.push_back(j);
    }
    ChainRecord chain;
    chain.effector = bones;
    spec.chains.push_back(chain);
    return spec;
}

inline glm::vec3 position_of(Pose& pose, std::uint32_t joint) {
    return glm::vec3(pose.model_space()[joint][3]);
}

inline double worst_violation(const Model& model, const Pose& pose) {
    double worst = 0.0;
    for (std::uint32_t joint = 0; joint < model.joints().size(); ++joint) {
        const Constraint* constraint = model.ik_constraint(joint);
        if (constraint == nullptr) continue;
        const glm::dquat R =
            to_constraint_space(*constraint, model.joints()[joint].rest.rotation, pose.local(joint).rotation);
        worst = std::max(worst, violation(*constraint, R));
    }
    return worst;
}

/// Poses a chain's links at random inside their constraints: `share` of the way from rest to where they stop it.
inline void pose_at_random(const Model& model, const Chain& chain, double share, Pose& pose, std::mt19937& random) {
    std::uniform_real_distribution<double> angle(-2.0, 2.0);
    pose.set_rest();
    for (std::uint32_t joint = chain.record.start; joint <= chain.record.effector; ++joint) {
        glm::dvec3 turn;
        for (const int axis : {2, 1, 0}) turn[axis] = angle(random);  // in the same order by every compiler
        const glm::dquat R = glm::angleAxis(glm::length(turn), glm::normalize(turn));
        const glm::quat rest = model.joints()[joint].rest.rotation;
        const Constraint* constraint = model.ik_constraint(joint);
        const glm::quat legal = constraint == nullptr
                                    ? glm::quat(glm::dquat(rest) * R)
                                    : from_constraint_space(*constraint, rest, clamp_rotation(*constraint, R));
        test::local_of(pose, joint)->rotation = glm::slerp(rest, legal, static_cast<float>(share));
    }
}

inline ConstraintRecord constraint_record_of(ConstraintModel model, std::array<double, 3> low,
                                             std::array<double, 3> high) {
    ConstraintRecord constraint;
    constraint.model = static_cast<std::uint8_t>(model);
    constraint.frame = {0.5f, 0.5f, 0.5f, 0.5f};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        constraint.rotation_min.at(axis) = radians(low.at(axis));
        constraint.rotation_max.at(axis) = radians(high.at(axis));
    }
    return constraint;
}

/// Limbs as characters have them, constrained: an arm with and without a pole, straight and bent at rest, a leg with a
/// hinge, a tentacle of stiff joints, a chain of every model.
inline std::vector<test::ModelSpec> limbs() {
    std::vector<test::ModelSpec> all;
    for (const double bend : {0.0, 5.0}) {
        for (const bool has_pole : {false, true}) {
            test::ModelSpec arm = rope(2, bend);
            arm.joints[0].rest.translation = {0.3f, 1.0f, 0.1f};
            arm.joints[0].rest.rotation = test::turned(-90, 2).rotation;
            arm.joints[0].constraints = {
                constraint_record_of(ConstraintModel::swing_twist_ellipse, {-90, -45, -60}, {90, 110, 90})};
            arm.joints[1].constraints = {hinge(-5, 150)};
            if (has_pole) arm.chains[0].pole_vector = {0.0f, 0.0f, -1.0f};
            all.push_back(arm);
            arm.joints[1].constraints = {
                constraint_record_of(ConstraintModel::swing_twist_ellipse, {-90, 0, 0}, {90, 0, 150})};
            all.push_back(arm);
            arm.joints[0].constraints = {hinge(-60, 100)};
            arm.joints[1].constraints = {
                constraint_record_of(ConstraintModel::euler_box, {-20, -30, -40}, {120, 40, 30})};
            all.push_back(arm);
        }
    }
    // An elbow that hardly moves sideways, and is bent at rest as it may not be: as proposed from a character's clips.
    test::ModelSpec thin = rope(2);
    thin.joints[0].rest.rotation = test::turned(-90, 2).rotation;
    thin.joints[0].constraints = {
        constraint_record_of(ConstraintModel::swing_twist_ellipse, {-90, -135, -138}, {70, 90, 92})};
    thin.joints[1].constraints = {
        constraint_record_of(ConstraintModel::swing_twist_ellipse, {-80, -11, -0.2}, {80, 10, 149.8})};
    thin.chains[0].pole_vector = {0.0f, 0.0f, -1.0f};
    all.push_back(thin);
    test::ModelSpec tentacle = rope(9, 4.0, 0.2f);
    for (std::size_t joint = 0; joint < 9; ++joint) {
        ConstraintRecord constraint = constraint_record_of(ConstraintModel::swing_twist_ellipse,
                                                           {-8, -17 - 2.0 * static_cast<double>(joint), -17},
                                                           {8, 17 + 2.0 * static_cast<double>(joint), 30});
        constraint.stiffness = {0.8f, 0.2f, 0.2f};
        tentacle.joints[joint].constraints = {constraint};
    }
    all.push_back(tentacle);
    test::ModelSpec mixed = rope(5, 5.0, 0.3f);
    mixed.joints[0].constraints = {
        constraint_record_of(ConstraintModel::swing_twist_ellipse, {-45, -60, -90}, {45, 90, 60})};
    mixed.joints[1].constraints = {hinge(-10, 140)};
    mixed.joints[2].constraints = {constraint_record_of(ConstraintModel::euler_box, {-30, -40, -40}, {30, 40, 60})};
    mixed.joints[3].constraints = {
        constraint_record_of(ConstraintModel::swing_twist_pyramid, {-20, -35, -35}, {20, 35, 50})};
    all.push_back(mixed);
    return all;
}

}  // namespace bendy::limbs_test
