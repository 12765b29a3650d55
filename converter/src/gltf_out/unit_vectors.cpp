#include "gltf_out/unit_vectors.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace bendy::converter::gltf_out {
namespace {

constexpr double kTolerance = 0.00674;  // the validator's

bool make_unit(glm::vec3& vector) {
    const glm::dvec3 exact(vector);
    const double length = glm::length(exact);
    if (std::abs(length - 1.0) <= kTolerance) return false;
    vector = length > 0.0 && std::isfinite(length) ? glm::vec3(exact / length) : glm::vec3(0.0f, 0.0f, 1.0f);
    return true;
}

}  // namespace

std::uint64_t make_unit(std::vector<glm::vec3>& normals) {
    std::uint64_t changed = 0;
    for (glm::vec3& normal : normals) changed += make_unit(normal) ? 1 : 0;
    return changed;
}

std::uint64_t make_unit(std::vector<glm::vec4>& tangents) {
    std::uint64_t changed = 0;
    for (glm::vec4& tangent : tangents) {
        glm::vec3 direction(tangent);
        const float hand = tangent.w < 0.0f ? -1.0f : 1.0f;
        const bool is_changed = make_unit(direction) || tangent.w != hand;
        if (!is_changed) continue;
        tangent = glm::vec4(direction, hand);
        ++changed;
    }
    return changed;
}

}  // namespace bendy::converter::gltf_out
