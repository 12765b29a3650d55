#pragma once

#include "runtime/build_model.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace bendy::test {

/// How a human is built. Lengths in metres, angles in degrees.
struct HumanSpec {
    double facing = 0.0;     ///< turned about the vertical
    bool is_z_up = false;    ///< the skeleton below its root has Z up, and centimetres
    double arms_down = 0.0;  ///< 0: a T-pose
    double thigh = 0.45, shin = 0.42;
    double hip_width = 0.2;
    std::uint32_t spine = 3;
    bool is_detached = false;  ///< legs are not below the hips, feet not below the legs
    bool has_neck = true, has_toes = true, has_fingers = true;
    unsigned axes = 1;  ///< of the joints: other ones for another number; 0: as model space
    bool has_roles = true;
    std::string prefix{};  ///< of names, except the sword's
    std::vector<ConstraintRecord> elbows{};
};

/// A human made of joints, standing on the ground. Joints lie at the places that the spec says, with axes of their own.
class HumanModel {
public:
    explicit HumanModel(const HumanSpec& human) : human_(human), random_(human.axes) {
        add_trunk();
        for (const double side : {1.0, -1.0}) add_arm(side);
        for (const double side : {1.0, -1.0}) add_leg(side);
        if (human.has_roles) spec.more.push_back(make_leaf(FourCC("ROLE"), role_bytes()));
    }

    [[nodiscard]] Buffer file() const { return build_file(spec); }
    [[nodiscard]] std::uint32_t joint(const std::string& name) const { return numbers_.at(name); }

    ModelSpec spec;

private:
    void add_trunk() {
        const double hips = human_.thigh + human_.shin + 0.08;
        const glm::dquat z_up = glm::angleAxis(-M_PI / 2.0, glm::dvec3(1, 0, 0));
        turns_.push_back(human_.is_z_up ? z_up : glm::dquat(1, 0, 0, 0));
        places_.emplace_back(0.0);
        RestRecord root;
        root.rotation = numbers(turns_[0]);
        if (human_.is_z_up) root.scale = {0.01f, 0.01f, 0.01f};
        spec.joints.push_back({kNone, root, {}, human_.prefix + "root"});
        numbers_["root"] = 0;
        trunk_ = add("hips", 0, {0, hips + 0.05, 0}, Role::hips);
        hips_ = trunk_;
        const Role roles[] = {Role::spine, Role::chest, Role::upper_chest};
        for (std::uint32_t k = 0; k < human_.spine; ++k) {
            const double height = hips + 0.1 + 0.4 * k / human_.spine;
            trunk_ = add("spine" + std::to_string(k), trunk_, {0, height, 0.01}, roles[k]);
        }
        const double shoulders = hips + 0.5;
        std::uint32_t neck = trunk_;
        if (human_.has_neck) neck = add("neck", trunk_, {0, shoulders + 0.05, 0}, Role::neck);
        add("head", neck, {0, shoulders + 0.15, 0.01}, Role::head);
    }

    void add_arm(double side) {
        const std::string name = side > 0.0 ? "left" : "right";
        const double down = human_.arms_down * M_PI / 180.0;
        const glm::dvec3 way(side * std::cos(down), -std::sin(down), 0.0);
        const double height = human_.thigh + human_.shin + 0.58;
        const glm::dvec3 shoulder(side * 0.16, height, 0.0);
        const std::uint32_t clavicle =
            add(name + "Shoulder", trunk_, {side * 0.03, height, 0.02}, of(side, Role::left_shoulder));
        const std::uint32_t upper = add(name + "Arm", clavicle, shoulder, of(side, Role::left_upper_arm));
        const std::uint32_t lower = add(name + "ForeArm", upper, shoulder + 0.28 * way, of(side, Role::left_lower_arm));
        spec.joints[lower].constraints = human_.elbows;
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
        const std::uint32_t lower =
            add(name + "Leg", upper, {x, human_.shin + 0.08, 0.01 * human_.thigh}, of(side, Role::left_lower_leg));
        const std::uint32_t foot =
            add(name + "Foot", human_.is_detached ? 0 : lower, {x, 0.08, 0}, of(side, Role::left_foot));
        if (human_.has_toes) add(name + "Toes", foot, {x, 0.02, 0.13}, of(side, Role::left_toes));
        if (human_.is_detached) return;
        ChainRecord leg;
        leg.start = upper;
        leg.effector = foot;
        leg.solver = static_cast<std::uint8_t>(Solver::two_bone);
        spec.chains.push_back(leg);  // "0": left, "1": right
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

    /// A joint without a role is a prop, whose name has no prefix.
    /// \param place  metres, in axes of the body
    std::uint32_t add(const std::string& name, std::uint32_t parent, const glm::dvec3& place, Role role) {
        const glm::dquat facing = glm::angleAxis(human_.facing * M_PI / 180.0, glm::dvec3(0, 1, 0));
        const glm::dquat turn = human_.axes == 0 ? facing : glm::normalize(facing * own_axes());
        const glm::dvec3 there = facing * place;
        RestRecord rest;
        rest.rotation = numbers(glm::conjugate(turns_[parent]) * turn);
        const glm::dvec3 way = glm::conjugate(turns_[parent]) * (there - places_[parent]);
        const double unit = human_.is_z_up ? 100.0 : 1.0;
        rest.translation = {static_cast<float>(unit * way.x), static_cast<float>(unit * way.y),
                            static_cast<float>(unit * way.z)};
        const auto number = static_cast<std::uint32_t>(spec.joints.size());
        spec.joints.push_back({parent, rest, {}, role == Role::none ? name : human_.prefix + name});
        places_.push_back(there);
        turns_.push_back(turn);
        numbers_[name] = number;
        if (role != Role::none) roles_.push_back({number, static_cast<std::uint16_t>(role), 0});
        return number;
    }

    glm::dquat own_axes() {
        std::normal_distribution<double> number;
        return glm::normalize(glm::dquat(number(random_), number(random_), number(random_), number(random_)));
    }

    static std::array<float, 4> numbers(const glm::dquat& q) {
        return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z), static_cast<float>(q.w)};
    }

    [[nodiscard]] Buffer role_bytes() const {
        Buffer bytes;
        for (const RoleRecord& role : roles_) {
            const auto one = bytes_of(role);
            bytes.insert(bytes.end(), one.begin(), one.end());
        }
        return bytes;
    }

    HumanSpec human_;
    std::mt19937 random_;
    std::uint32_t trunk_ = 0, hips_ = 0;
    std::vector<glm::dvec3> places_;  // of joints at rest, model space
    std::vector<glm::dquat> turns_;
    std::vector<RoleRecord> roles_;
    std::map<std::string, std::uint32_t> numbers_;
};

}  // namespace bendy::test
