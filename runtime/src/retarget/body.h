#pragma once

#include <bendy/runtime/model.h>
#include <bendy/runtime/retarget.h>
#include <bendy/runtime/transform.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace bendy {

/// A leg or an arm.
struct Limb {
    std::vector<std::uint32_t> girdle;  ///< what carries it: an animal's shoulder blade or pelvis
    /// From hip or shoulder outwards, as far as they are there: three or more of a whole limb, the last of which are
    /// those of the paw.
    std::vector<std::uint32_t> joints;
    std::size_t foot = 2;  ///< among the joints: foot or hand
    bool is_leg = true;

    [[nodiscard]] bool is_whole() const { return joints.size() > foot; }
    [[nodiscard]] std::uint32_t upper() const { return joints.front(); }
    /// Foot or hand, or else the last joint that is there.
    [[nodiscard]] std::uint32_t end() const { return joints[std::min(foot, joints.size() - 1)]; }
    // Only if is_whole():
    [[nodiscard]] std::uint32_t foot_joint() const { return joints[foot]; }
    /// kNone if nothing is below the foot.
    [[nodiscard]] std::uint32_t toes() const { return foot + 1 < joints.size() ? joints.back() : kNone; }
};

/// A model as a body: what its joints are, and where they are in model space in a pose in which it stands.
class Body {
public:
    /// \param locals  the pose: by joint, relative to its parent
    /// \param standing_pose  says up, front and ground of the pose; null: they are measured
    Body(const Model& model, std::span<const JointTransform> locals, const StandingPoseRecord* standing_pose);

    [[nodiscard]] const Model& model() const { return model_; }
    /// Returns the joint with that role; kNone if there is none.
    [[nodiscard]] std::uint32_t joint(Role role) const;
    /// Returns the joints of these roles that are there, in that order.
    [[nodiscard]] std::vector<std::uint32_t> joints(std::initializer_list<Role> roles) const;
    /// Returns the joints of a chain, from the body outwards.
    [[nodiscard]] std::vector<std::uint32_t> chain(Role role) const;
    [[nodiscard]] bool has_role(std::uint32_t joint) const { return has_role_[joint]; }
    [[nodiscard]] BodyKind kind() const { return kind_; }
    [[nodiscard]] const glm::dmat4& rest(std::uint32_t joint) const { return rest_[joint]; }
    [[nodiscard]] glm::dvec3 place(std::uint32_t joint) const { return {rest_[joint][3]}; }
    /// The head, or else the highest joint of the trunk from there down to the hips; kNone if there is none.
    [[nodiscard]] std::uint32_t top() const;
    /// The joint's orientation: the product of the rotations down to it. Uneven scales above it are ignored, mirroring
    /// ones are half turns.
    [[nodiscard]] const glm::dquat& turn(std::uint32_t joint) const { return turns_[joint]; }
    /// The orientation that joints below it are relative to: that of the joint, and a half turn if it mirrors. The
    /// identity for kNone.
    [[nodiscard]] glm::dquat space(std::uint32_t joint) const;
    /// The half turn of a joint that mirrors, otherwise the identity.
    [[nodiscard]] glm::dquat flip(std::uint32_t joint) const;

    // Only if a joint has a role; measure() first:
    /// Measures the body; returns false if a number is not finite.
    bool measure();
    /// The body's axes, to model space: X left, Y up, Z forward. Where they nearly are axes of model space, they are
    /// exactly.
    [[nodiscard]] const glm::dquat& axes() const { return axes_; }
    [[nodiscard]] glm::dvec3 up() const { return axes_ * glm::dvec3(0.0, 1.0, 0.0); }
    /// Left leg, right leg, left arm, right arm. Of an animal, the hind legs, then the front legs if it has any.
    [[nodiscard]] const std::vector<Limb>& limbs() const { return limbs_; }
    [[nodiscard]] bool has_hip_joints() const { return !limbs_[0].joints.empty() && !limbs_[1].joints.empty(); }
    /// Both of the first two are whole.
    [[nodiscard]] bool has_legs() const { return limbs_[0].is_whole() && limbs_[1].is_whole(); }
    /// Lengths that two bodies are compared by, metres: of the legs from hip by knee to foot (of an animal, the hind
    /// legs), of their upper bones, of the trunk, of the arms or front legs. 0: the body has none.
    [[nodiscard]] const std::array<double, 4>& lengths() const { return lengths_; }
    /// The middle of the hip joints, or else the joint of the hips, or the lowest that there is of the body.
    [[nodiscard]] const glm::dvec3& hips() const { return hips_; }
    /// Below the hips, at the height of the feet.
    [[nodiscard]] const glm::dvec3& ground() const { return ground_; }
    /// How far clips have the body above where its standing pose has it, metres along up.
    [[nodiscard]] double raised() const { return raised_; }
    /// Whether it stands as in a moment of a clip, or as it is assumed to: how its bones run then does not say how they
    /// run in its rig.
    [[nodiscard]] bool stands_anyhow() const;

private:
    void find_limbs();
    void find_animal_limbs();
    [[nodiscard]] std::uint32_t base() const;
    [[nodiscard]] glm::dvec3 find_feet() const;
    [[nodiscard]] double length_of(std::size_t first_limb, std::size_t bones) const;
    [[nodiscard]] glm::dvec3 find_up(const glm::dvec3& feet) const;
    [[nodiscard]] glm::dvec3 find_left(const glm::dvec3& up) const;
    [[nodiscard]] double least_way() const;
    void stand_on(const std::array<float, 4>& axes, double ground, const glm::dvec3& feet);

    Model model_;
    BodyKind kind_ = BodyKind::human;
    std::vector<std::uint32_t> by_role_;
    std::vector<bool> has_role_;
    std::vector<glm::dmat4> rest_;
    std::vector<glm::dquat> turns_;
    std::optional<StandingPoseRecord> standing_pose_;
    std::vector<Limb> limbs_;
    glm::dquat axes_{1.0, 0.0, 0.0, 0.0};
    std::array<double, 4> lengths_{};
    glm::dvec3 hips_{0.0}, ground_{0.0};
    double raised_ = 0.0;
};

}  // namespace bendy
