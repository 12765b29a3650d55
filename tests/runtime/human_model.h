#pragma once

#include "runtime/body_model.h"

#include <glm/vec3.hpp>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace bendy::test {

/// How a human is built. Lengths in metres, angles in degrees.
struct HumanSpec {
    double facing = 0.0;     ///< turned about the vertical
    bool is_z_up = false;    ///< the skeleton below its root has Z up, and centimetres
    double arms_down = 0.0;  ///< 0: a T-pose
    double collars_up = 0.0, feet_down = 0.0,
           bent = 0.0;  ///< of collarbones, soles and the trunk from the hips upwards
    double thigh = 0.45, shin = 0.42;
    double hip_width = 0.2, collar = 0.13;
    std::uint32_t spine = 3;
    bool is_detached = false;       ///< legs are not below the hips, feet not below the legs
    bool has_split_thighs = false;  ///< of two joints
    /// Of a detached one: they hang on a control beside the hips.
    bool has_loose_arms = false, has_loose_spine = false;
    bool has_arms = true, has_hands = true, has_head = true;
    bool has_neck = true, has_toes = true, has_fingers = true;
    unsigned axes = 1;  ///< of the joints: other ones for another number; 0: as model space
    bool has_roles = true;
    std::string prefix{};  ///< of names, except the sword's
    std::vector<ConstraintRecord> elbows{};
};

/// A human made of joints, standing on the ground. Joints lie at the places that the spec says, with axes of their own.
class HumanModel : public BodyModel {
public:
    explicit HumanModel(const HumanSpec& human)
        : BodyModel({human.facing, human.is_z_up, human.axes, human.prefix}), human_(human) {
        add_trunk();
        if (human_.has_loose_arms) chest_ = add("arms", 0, {0, 1, -0.5}, Role::none);
        for (const double side : {1.0, -1.0}) {
            if (human_.has_arms) add_arm(side);
        }
        for (const double side : {1.0, -1.0}) add_leg(side);
        if (human.has_roles) store_roles();
    }

private:
    void add_trunk() {
        const double hips = human_.thigh + human_.shin + 0.08;
        trunk_ = add("hips", 0, {0, hips + 0.05, 0}, Role::hips);
        hips_ = trunk_;
        if (human_.has_loose_spine) trunk_ = add("control", 0, {0, hips, -0.5}, Role::none);
        const Role roles[] = {Role::spine, Role::chest, Role::upper_chest};
        for (std::uint32_t k = 0; k < human_.spine; ++k) {
            const double height = hips + 0.1 + 0.4 * k / human_.spine;
            trunk_ = add("spine" + std::to_string(k), trunk_, bent({0, height, 0.01}), roles[k]);
        }
        const double shoulders = hips + 0.5;
        std::uint32_t neck = trunk_;
        if (human_.has_neck) neck = add("neck", trunk_, bent({0, shoulders + 0.05, 0}), Role::neck);
        if (human_.has_head) add("head", neck, bent({0, shoulders + 0.05, 0}) + glm::dvec3(0, 0.1, 0.01), Role::head);
    }

    void add_arm(double side) {
        const std::string name = side > 0.0 ? "left" : "right";
        const double down = human_.arms_down * M_PI / 180.0;
        const glm::dvec3 way(side * std::cos(down), -std::sin(down), 0.0);
        const double height = human_.thigh + human_.shin + 0.58;
        const double up = human_.collars_up * M_PI / 180.0;
        const glm::dvec3 collar = bent({side * 0.03, height, 0.02});
        const glm::dvec3 shoulder =
            collar + glm::dvec3(side * human_.collar * std::cos(up), human_.collar * std::sin(up), -0.02);
        const std::uint32_t clavicle =
            add(name + "Shoulder", human_.has_loose_arms ? chest_ : trunk_, collar, of(side, Role::left_shoulder));
        const std::uint32_t upper = add(name + "Arm", clavicle, shoulder, of(side, Role::left_upper_arm));
        const std::uint32_t lower = add(name + "ForeArm", upper, shoulder + 0.28 * way, of(side, Role::left_lower_arm));
        spec.joints[lower].constraints = human_.elbows;
        if (!human_.has_hands) return;
        const std::uint32_t hand = add(name + "Hand", lower, shoulder + 0.53 * way, of(side, Role::left_hand));
        if (human_.has_fingers) {
            const std::uint32_t finger =
                add(name + "Middle", hand, shoulder + 0.62 * way, of(side, Role::left_middle_proximal));
            add(name + "Middle2", finger, shoulder + 0.66 * way, of(side, Role::left_middle_intermediate));
        }
        if (side > 0.0) add("sword", hand, shoulder + 0.6 * way + glm::dvec3(0, 0, 0.1), Role::none);
    }

    void add_leg(double side) {
        const std::string name = side > 0.0 ? "left" : "right";
        const double x = side * 0.5 * human_.hip_width;
        const std::uint32_t upper = add(name + "UpLeg", human_.is_detached ? 0 : hips_,
                                        {x, human_.thigh + human_.shin + 0.08, 0}, of(side, Role::left_upper_leg));
        std::uint32_t thigh = upper;
        if (human_.has_split_thighs)
            thigh = add(name + "Thigh", upper, {x, human_.shin + 0.08 + 0.5 * human_.thigh, 0}, Role::none);
        const std::uint32_t lower =
            add(name + "Leg", thigh, {x, human_.shin + 0.08, 0.01 * human_.thigh}, of(side, Role::left_lower_leg));
        const std::uint32_t foot =
            add(name + "Foot", human_.is_detached ? 0 : lower, {x, 0.08, 0}, of(side, Role::left_foot));
        const double down = human_.feet_down * M_PI / 180.0;
        const glm::dvec3 sole(0, -0.06 * std::cos(down) - 0.13 * std::sin(down),
                              0.13 * std::cos(down) - 0.06 * std::sin(down));
        if (human_.has_toes) add(name + "Toes", foot, glm::dvec3(x, 0.08, 0) + sole, of(side, Role::left_toes));
        if (human_.is_detached && !human_.has_split_thighs) return;
        ChainRecord leg;
        leg.start = upper;
        leg.effector = human_.is_detached ? lower : foot;
        if (human_.is_detached) leg.tip_offset = place_in(lower, foot);
        leg.solver = static_cast<std::uint8_t>(Solver::two_bone);
        spec.chains.push_back(leg);  // "0": left, "1": right
    }

    /// A place on the trunk, with the body bent forward above the hips.
    [[nodiscard]] glm::dvec3 bent(const glm::dvec3& place) const {
        const glm::dvec3 hips(0, human_.thigh + human_.shin + 0.18, 0);
        return hips + glm::angleAxis(human_.bent * M_PI / 180.0, glm::dvec3(1, 0, 0)) * (place - hips);
    }

    /// The same role on that side.
    static Role of(double side, Role left) {
        if (side > 0.0) return left;
        const auto name = std::string(kValueNames<Role>[static_cast<std::size_t>(left)]);
        const std::string other = "right" + name.substr(4);
        for (std::size_t role = 0; role < kValueNames<Role>.size(); ++role) {
            if (kValueNames<Role>[role] == other) return static_cast<Role>(role);
        }
        throw std::runtime_error(other);
    }

    HumanSpec human_;
    std::uint32_t trunk_ = 0, hips_ = 0, chest_ = 0;
};

}  // namespace bendy::test
