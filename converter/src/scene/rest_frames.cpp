#include "scene/rest_frames.h"

#include "scene/space.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace bendy::converter {
namespace {

Rotation rotation_of(const Transform& rest) {
    const glm::vec4& q = rest.rotation;
    return to_rotation({q.x, q.y, q.z, q.w});
}

/// The inverse; nothing for a matrix with no or almost no volume.
std::optional<glm::dmat3> inverse_of(const glm::dmat3& m) {
    const double volume = glm::length(m[0]) * glm::length(m[1]) * glm::length(m[2]);
    if (!std::isfinite(volume) || !(std::abs(glm::determinant(m)) > 1e-9 * volume)) return std::nullopt;
    return glm::inverse(m);
}

}  // namespace

std::optional<glm::dvec3> unit(glm::dvec3 vector) {
    const double length = glm::length(vector);
    if (!std::isfinite(length) || !(length > 1e-12)) return std::nullopt;
    return vector / length;
}

std::optional<glm::dvec3> unit_across(glm::dvec3 vector, glm::dvec3 axis) {
    const std::optional<glm::dvec3> direction = unit(vector);
    if (!direction) return std::nullopt;
    const glm::dvec3 across = *direction - glm::dot(*direction, axis) * axis;
    return glm::length(across) > 1e-6 ? unit(across) : std::nullopt;
}

glm::dquat rotation_of_axes(const glm::dmat3& axes) {
    return glm::normalize(glm::quat_cast(axes));
}

Rotation to_rotation(const std::array<float, 4>& xyzw) {
    return glm::normalize(Rotation(xyzw[3], xyzw[0], xyzw[1], xyzw[2]));
}

std::array<float, 4> to_record(const Rotation& rotation) {
    const Rotation unit = glm::normalize(rotation);
    return {static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z),
            static_cast<float>(unit.w)};
}

std::vector<Transform> rest_of(const Scene& scene) {
    std::vector<Transform> locals;
    locals.reserve(scene.joints.size());
    for (const Joint& joint : scene.joints) locals.push_back(joint.rest);
    return locals;
}

RestFrames::RestFrames(const Scene& scene) : RestFrames(scene, rest_of(scene)) {}

RestFrames::RestFrames(const Scene& scene, std::span<const Transform> locals) {
    joints_.reserve(scene.joints.size());
    for (std::uint32_t number = 0; number < scene.joints.size(); ++number) {
        const Joint& joint = scene.joints[number];
        const Transform& local = locals[number];
        const Rotation rotation = rotation_of(local);
        Placed placed{local.translation, rotation, glm::mat3_cast(rotation), glm::dmat3(1.0), number + 1, 0};
        if (joint.parent != kNone) {
            const Placed& parent = joints_[joint.parent];
            placed.position = parent.position + parent.space * placed.position;
            placed.turn = glm::normalize(parent.turn * rotation);
            placed.axes = parent.space * placed.axes;
            placed.depth = parent.depth + 1;
        }
        placed.space = placed.axes * stretch(glm::dvec3(local.scale), local.shear);
        joints_.push_back(placed);
    }
    for (auto number = static_cast<std::uint32_t>(joints_.size()); number-- > 0;) {
        const std::uint32_t parent = scene.joints[number].parent;
        if (parent != kNone) joints_[parent].end = std::max(joints_[parent].end, joints_[number].end);
    }
}

std::optional<glm::dvec3> RestFrames::direction(std::uint32_t from, std::uint32_t to) const {
    return unit(joints_[to].position - joints_[from].position);
}

std::optional<glm::dquat> RestFrames::orientation(std::uint32_t joint) const {
    constexpr double kTolerance = 0.01;
    glm::dmat3 axes = joints_[joint].axes;
    const double length = glm::length(axes[0]);
    if (!std::isfinite(length) || !(length > 1e-12)) return std::nullopt;
    axes /= length;
    for (int column = 0; column < 3; ++column) {
        const glm::dvec3 next = axes[(column + 1) % 3];
        if (!(std::abs(glm::length(axes[column]) - 1.0) < kTolerance)) return std::nullopt;
        if (!(std::abs(glm::dot(axes[column], next)) < kTolerance)) return std::nullopt;
    }
    if (!(glm::determinant(axes) > 0.0)) return std::nullopt;
    return rotation_of_axes(axes);
}

std::optional<glm::dquat> RestFrames::turning_axes(std::uint32_t joint) const {
    if (const std::optional<glm::dquat> exact = orientation(joint)) return exact;
    constexpr double kFlat = 0.2;
    const auto x = unit(joints_[joint].axes[0]);
    const auto y = unit(joints_[joint].axes[1]);
    const auto z = unit(joints_[joint].axes[2]);
    if (!x || !y || !z) return std::nullopt;
    const double volume = glm::dot(glm::cross(*x, *y), *z);
    if (!(std::abs(volume) > kFlat)) return std::nullopt;
    const double side = volume < 0.0 ? -1.0 : 1.0;
    const std::optional<glm::dvec3> across = unit_across(side * *y, side * *x);
    if (!across) return std::nullopt;
    return rotation_of_axes(glm::dmat3(side * *x, *across, glm::cross(side * *x, *across)));
}

std::optional<glm::dvec3> RestFrames::to_space_of(std::uint32_t joint, glm::dvec3 direction) const {
    if (joint == kNone) return unit(direction);
    const std::optional<glm::dmat3> inverse = inverse_of(joints_[joint].space);
    return inverse ? unit(*inverse * direction) : std::nullopt;
}

std::optional<glm::dvec3> RestFrames::point_in_space_of(std::uint32_t joint, glm::dvec3 point) const {
    const std::optional<glm::dmat3> inverse = inverse_of(joints_[joint].space);
    if (!inverse) return std::nullopt;
    const glm::dvec3 local = *inverse * (point - joints_[joint].position);
    return is_finite(local) ? std::optional(local) : std::nullopt;
}

}  // namespace bendy::converter
