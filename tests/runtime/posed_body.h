#pragma once

#include <bendy/runtime/retarget.h>

#include "runtime/local_joints.h"

#include <gtest/gtest.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>

namespace bendy::test {

/// Returns the angle between two orientations, radians.
inline double angle_of(const glm::dquat& a, const glm::dquat& b) {
    const glm::dquat d = glm::conjugate(a) * b;
    return 2.0 * std::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::abs(d.w));
}

/// A body, its model and a pose of it. Places and turns are in axes of the body: Y is up, Z forward.
/// \tparam Body  HumanModel, AnimalModel
template <typename Body>
class PosedBody {
public:
    /// \param facing  degrees about Y
    PosedBody(const Body& body, double facing)
        : body_(body),
          model_(body_.file()),
          pose_(*model_),
          rest_(*model_),
          back_(glm::angleAxis(-facing * M_PI / 180.0, glm::dvec3(0, 1, 0))) {}

    [[nodiscard]] const Model& model() const { return *model_; }
    Pose& pose() { return pose_; }
    [[nodiscard]] std::uint32_t joint(const std::string& name) const { return body_.joint(name); }

    glm::dvec3 place(const std::string& name) { return back_ * glm::dvec3(pose_.model_space()[joint(name)][3]); }
    glm::dvec3 rest_place(const std::string& name) { return back_ * glm::dvec3(rest_.model_space()[joint(name)][3]); }
    glm::dvec3 way(const std::string& from, const std::string& to) { return glm::normalize(place(to) - place(from)); }
    /// Since rest.
    glm::dquat turn(const std::string& name) {
        const glm::dmat3 now(pose_.model_space()[joint(name)]);
        const glm::dmat3 rest(rest_.model_space()[joint(name)]);
        return back_ * glm::normalize(glm::quat_cast(now * glm::inverse(rest))) * glm::conjugate(back_);
    }
    /// Turns a joint about an axis of the body, with all below it.
    void turn_by(const std::string& name, const glm::dvec3& axis, double degrees) {
        const glm::dmat3 parent(pose_.model_space()[model_->parents()[joint(name)]]);
        const glm::dvec3 own = glm::normalize(glm::inverse(parent) * to_model(axis));
        const glm::dquat turn = glm::angleAxis(degrees * M_PI / 180.0, own);
        local_of(pose_, joint(name))->rotation =
            glm::quat(glm::normalize(turn * glm::dquat(pose_.local(joint(name)).rotation)));
    }
    [[nodiscard]] glm::dvec3 to_model(const glm::dvec3& place) const { return glm::conjugate(back_) * place; }
    /// Gives a joint the orientation that it has at rest.
    void level(const std::string& name) {
        const glm::dmat3 parent(pose_.model_space()[model_->parents()[joint(name)]]);
        const glm::dmat3 rest(rest_.model_space()[joint(name)]);
        local_of(pose_, joint(name))->rotation =
            glm::quat(glm::normalize(glm::conjugate(glm::quat_cast(parent)) * glm::quat_cast(rest)));
    }
    void pose_at_random(unsigned seed, double size) {
        std::mt19937 random(seed);
        std::normal_distribution<double> number;
        pose_.set_rest();
        for (const JointRole& role : model_->roles()) {
            const glm::dquat turn =
                glm::normalize(glm::dquat(1.0, size * number(random), size * number(random), size * number(random)));
            local_of(pose_, role.joint)->rotation = glm::quat(turn * glm::dquat(pose_.local(role.joint).rotation));
        }
        move_hips({0.1, 0.05, -0.2});
    }
    /// Along the axes of the root's space.
    void move_hips(const glm::vec3& way) { local_of(pose_, joint("hips"))->translation += way; }

private:
    Body body_;
    Owned model_;
    Pose pose_, rest_;
    glm::dquat back_;
};

/// Returns how the poses of one body are put on another one; the test fails if they cannot be.
template <typename Body>
Retarget made(const PosedBody<Body>& source, const PosedBody<Body>& target, const RetargetOptions& options = {}) {
    auto retarget = Retarget::make(source.model(), target.model(), options);
    EXPECT_TRUE(retarget) << (retarget ? "" : error_text(retarget.error()));
    return *std::move(retarget);
}

/// Only the joints' turns and the hips' travel.
inline constexpr RetargetOptions kDirections{RestPoses::measured, Limits::off, false};

}  // namespace bendy::test
