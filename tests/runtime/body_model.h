#pragma once

#include "runtime/build_model.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace bendy::test {

/// How a body lies in model space.
struct BodyAxes {
    double facing = 0.0;   ///< degrees about the vertical
    bool is_z_up = false;  ///< the skeleton below its root has Z up, and centimetres
    unsigned axes = 1;     ///< of the joints: other ones for another number; 0: as model space
    std::string prefix{};  ///< of names of joints with a role
};

/// Joints with roles, at given places, with axes of their own.
class BodyModel {
public:
    explicit BodyModel(BodyAxes axes) : axes_(std::move(axes)), random_(axes_.axes) {
        const glm::dquat z_up = glm::angleAxis(-M_PI / 2.0, glm::dvec3(1, 0, 0));
        turns_.push_back(axes_.is_z_up ? z_up : glm::dquat(1, 0, 0, 0));
        places_.emplace_back(0.0);
        RestRecord root;
        root.rotation = numbers(turns_[0]);
        if (axes_.is_z_up) root.scale = {0.01f, 0.01f, 0.01f};
        spec.joints.push_back({kNone, root, {}, axes_.prefix + "root"});
        numbers_["root"] = 0;
    }

    [[nodiscard]] Buffer file() const { return build_file(spec); }
    [[nodiscard]] std::uint32_t joint(const std::string& name) const { return numbers_.at(name); }

    /// Joints keep their places and lose these roles.
    void forget(const std::vector<Role>& roles) {
        std::erase_if(roles_, [&](const RoleRecord& one) {
            return std::find(roles.begin(), roles.end(), static_cast<Role>(one.role)) != roles.end();
        });
        spec.more.pop_back();
        store_roles();
    }

    ModelSpec spec;

protected:
    /// A joint without a role is a prop, whose name has no prefix.
    /// \param place  metres, in axes of the body
    std::uint32_t add(const std::string& name, std::uint32_t parent, const glm::dvec3& place, Role role,
                      std::size_t place_in_chain = 0) {
        const glm::dquat facing = glm::angleAxis(axes_.facing * M_PI / 180.0, glm::dvec3(0, 1, 0));
        const glm::dquat turn = axes_.axes == 0 ? facing : glm::normalize(facing * own_axes());
        const glm::dvec3 there = facing * place;
        RestRecord rest;
        rest.rotation = numbers(glm::conjugate(turns_[parent]) * turn);
        const glm::dvec3 way = glm::conjugate(turns_[parent]) * (there - places_[parent]);
        const double unit = axes_.is_z_up ? 100.0 : 1.0;
        rest.translation = {static_cast<float>(unit * way.x), static_cast<float>(unit * way.y),
                            static_cast<float>(unit * way.z)};
        const auto number = static_cast<std::uint32_t>(spec.joints.size());
        spec.joints.push_back({parent, rest, {}, role == Role::none ? name : axes_.prefix + name});
        places_.push_back(there);
        turns_.push_back(turn);
        numbers_[name] = number;
        if (role != Role::none)
            roles_.push_back({number, static_cast<std::uint16_t>(role), static_cast<std::uint16_t>(place_in_chain)});
        return number;
    }

    /// Where a joint is in the axes of another one, metres.
    [[nodiscard]] std::array<float, 3> place_in(std::uint32_t space, std::uint32_t joint) const {
        const glm::vec3 way(glm::conjugate(turns_[space]) * (places_[joint] - places_[space]));
        return {way.x, way.y, way.z};
    }

    /// Puts the roles into the file; call it last.
    void store_roles() {
        Buffer bytes;
        for (const RoleRecord& role : roles_) {
            const auto one = bytes_of(role);
            bytes.insert(bytes.end(), one.begin(), one.end());
        }
        spec.more.push_back(make_leaf(FourCC("ROLE"), bytes));
    }

private:
    glm::dquat own_axes() {
        std::normal_distribution<double> number;
        return glm::normalize(glm::dquat(number(random_), number(random_), number(random_), number(random_)));
    }

    static std::array<float, 4> numbers(const glm::dquat& q) {
        return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z), static_cast<float>(q.w)};
    }

    BodyAxes axes_;
    std::mt19937 random_;
    std::vector<glm::dvec3> places_;  // of joints at rest, model space
    std::vector<glm::dquat> turns_;
    std::vector<RoleRecord> roles_;
    std::map<std::string, std::uint32_t> numbers_;
};

}  // namespace bendy::test
