#pragma once

#include <bendy/converter/scene.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace bendy::converter {

/// x -> linear * x + origin, in double precision.
struct Affine {
    glm::dmat3 linear{1.0};
    glm::dvec3 origin{0.0};

    [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& point) const { return linear * point + origin; }
};

inline Affine operator*(const Affine& a, const Affine& b) {
    return {a.linear * b.linear, a.linear * b.origin + a.origin};
}

/// A joint's transform relative to its parent, at one moment.
struct Local {
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 translation{0.0};
    glm::dvec3 scale{1.0};
};

inline Local local_of(const Transform& rest) {
    const glm::vec4& q = rest.rotation;
    return {glm::normalize(glm::dquat(q.w, q.x, q.y, q.z)), glm::dvec3(rest.translation), glm::dvec3(rest.scale)};
}

/// Scale and shear: see Transform.
inline glm::dmat3 stretch(const glm::dvec3& scale, const glm::vec3& shear) {
    return {{scale.x, 0.0, 0.0}, {shear.x, scale.y, 0.0}, {shear.y, shear.z, scale.z}};
}

inline Affine to_affine(const Local& local, const glm::vec3& shear) {
    return {glm::mat3_cast(local.rotation) * stretch(local.scale, shear), local.translation};
}

}  // namespace bendy::converter
