#pragma once

#include <bendy/converter/scene.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace bendy::converter {

/// A joint's rest transform as a record.
inline RestRecord to_record(const Transform& rest) {
    RestRecord record;
    for (int c = 0; c < 4; ++c) record.rotation[static_cast<std::size_t>(c)] = rest.rotation[c];
    for (int c = 0; c < 3; ++c) {
        const auto at = static_cast<std::size_t>(c);
        record.translation[at] = rest.translation[c];
        record.scale[at] = rest.scale[c];
        record.shear[at] = rest.shear[c];
    }
    return record;
}

/// By joint: its rest transform.
std::vector<Transform> rest_of(const Scene& scene);

using Rotation = glm::dquat;

/// x y z w as in records, unit.
Rotation to_rotation(const std::array<float, 4>& xyzw);
std::array<float, 4> to_record(const Rotation& rotation);

/// The rest pose in model space, and the hierarchy. Numbers in odd files may be huge: results that are not finite, or
/// have no direction, are returned as nothing.
class RestFrames {
public:
    explicit RestFrames(const Scene& scene);
    /// Uses another pose in place of the rest pose.
    /// \param locals  by joint: the transform relative to the parent
    RestFrames(const Scene& scene, std::span<const Transform> locals);

    /// The joint's origin in metres.
    [[nodiscard]] glm::dvec3 position(std::uint32_t joint) const { return joints_[joint].position; }

    /// A point in the joint's space, transformed to model space; metres.
    [[nodiscard]] glm::dvec3 place(std::uint32_t joint, const glm::dvec3& point = glm::dvec3(0.0)) const {
        return joints_[joint].position + joints_[joint].space * point;
    }

    /// The joint's axes: the product of the rotations from the root, ignoring scale; unit.
    [[nodiscard]] const Rotation& turn(std::uint32_t joint) const { return joints_[joint].turn; }

    /// The unit vector from one joint to the other.
    [[nodiscard]] std::optional<glm::dvec3> direction(std::uint32_t from, std::uint32_t to) const;

    /// The joint's rest axes in model space; nothing if the ancestors' scale makes them other than a rotation.
    [[nodiscard]] std::optional<glm::dquat> orientation(std::uint32_t joint) const;

    /// A rotation that maps axes of the joint's rotations to model space, even if the ancestors' scale stretches or
    /// mirrors them (a mirror reverses an axis of rotation); nothing if it flattens them.
    [[nodiscard]] std::optional<glm::dquat> turning_axes(std::uint32_t joint) const;

    /// Transforms a direction from model space to the joint's space, as a unit vector; kNone: a root's parent.
    [[nodiscard]] std::optional<glm::dvec3> to_space_of(std::uint32_t joint, glm::dvec3 direction) const;

    /// Transforms a point from model space to the joint's space.
    [[nodiscard]] std::optional<glm::dvec3> point_in_space_of(std::uint32_t joint, glm::dvec3 point) const;

    /// Whether `joint` is a descendant of `ancestor`.
    [[nodiscard]] bool is_below(std::uint32_t joint, std::uint32_t ancestor) const {
        return ancestor < joint && joint < joints_[ancestor].end;
    }

    /// Number of ancestors.
    [[nodiscard]] std::uint32_t depth(std::uint32_t joint) const { return joints_[joint].depth; }

private:
    struct Placed {
        glm::dvec3 position;
        Rotation turn;        ///< product of the rotations from the root
        glm::dmat3 axes;      ///< the parents' linear part times the joint's rotation
        glm::dmat3 space;     ///< with the joint's own scale: joint to model space
        std::uint32_t end;    ///< one past the last descendant: the order is pre-order
        std::uint32_t depth;  ///< number of ancestors
    };
    std::vector<Placed> joints_;
};

/// The vector with length 1; nothing if it has no direction.
std::optional<glm::dvec3> unit(glm::dvec3 vector);

/// The component of `vector` at right angles to the unit vector `axis`, normalised.
std::optional<glm::dvec3> unit_across(glm::dvec3 vector, glm::dvec3 axis);

/// The rotation whose X, Y, Z axes are the columns, orthonormal and right-handed.
glm::dquat rotation_of_axes(const glm::dmat3& axes);

}  // namespace bendy::converter
