#include "rest_frames.h"

#include <glm/gtc/quaternion.hpp>

namespace bendy::converter {
namespace {

glm::dmat4 matrix_of(const Transform& transform, const Rotation& rotation) {
    glm::dmat4 matrix(1.0);
    matrix[0] = {transform.scale.x, 0.0, 0.0, 0.0};
    matrix[1] = {transform.shear.x, transform.scale.y, 0.0, 0.0};
    matrix[2] = {transform.shear.y, transform.shear.z, transform.scale.z, 0.0};
    matrix = glm::mat4_cast(rotation) * matrix;
    matrix[3] = {transform.translation.x, transform.translation.y, transform.translation.z, 1.0};
    return matrix;
}

}  // namespace

Rotation to_rotation(const std::array<float, 4>& xyzw) {
    return glm::normalize(Rotation(xyzw[3], xyzw[0], xyzw[1], xyzw[2]));
}

std::array<float, 4> to_record(const Rotation& rotation) {
    const Rotation unit = glm::normalize(rotation);
    return {static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z),
            static_cast<float>(unit.w)};
}

RestFrames::RestFrames(const Scene& scene) {
    orientations_.reserve(scene.joints.size());
    matrices_.reserve(scene.joints.size());
    for (const Joint& joint : scene.joints) {
        const glm::vec4& r = joint.rest.rotation;
        Rotation orientation = to_rotation({r.x, r.y, r.z, r.w});
        glm::dmat4 matrix = matrix_of(joint.rest, orientation);
        if (joint.parent != kNone) {
            orientation = glm::normalize(orientations_[joint.parent] * orientation);
            matrix = matrices_[joint.parent] * matrix;
        }
        orientations_.push_back(orientation);
        matrices_.push_back(matrix);
    }
}

glm::dvec3 RestFrames::place(std::uint32_t joint, const glm::dvec3& point) const {
    const glm::dvec4 placed = matrices_[joint] * glm::dvec4(point, 1.0);
    return {placed.x, placed.y, placed.z};
}

}  // namespace bendy::converter
