#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace bendy::converter {

/// The point of a triangle that is nearest to `p`: its weights on the corners, and how far it is, squared. For a
/// triangle without area, of one of its edges.
struct ClosestPoint {
    glm::vec3 weights{1.0f, 0.0f, 0.0f};
    float distance_squared = 0.0f;
};

/// C. Ericson, Real-Time Collision Detection, 5.1.5.
inline ClosestPoint closest_point(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const auto at = [&](const glm::vec3& weights) {
        const glm::vec3 apart = p - (weights.x * a + weights.y * b + weights.z * c);
        return ClosestPoint{weights, glm::dot(apart, apart)};
    };
    const auto share = [](float part, float other) { return part + other > 0.0f ? part / (part + other) : 0.0f; };
    const glm::vec3 ab = b - a;
    const glm::vec3 ac = c - a;
    const float d1 = glm::dot(ab, p - a);
    const float d2 = glm::dot(ac, p - a);
    if (d1 <= 0.0f && d2 <= 0.0f) return at({1.0f, 0.0f, 0.0f});
    const float d3 = glm::dot(ab, p - b);
    const float d4 = glm::dot(ac, p - b);
    if (d3 >= 0.0f && d4 <= d3) return at({0.0f, 1.0f, 0.0f});
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f) {
        const float t = share(d1, -d3);
        return at({1.0f - t, t, 0.0f});
    }
    const float d5 = glm::dot(ab, p - c);
    const float d6 = glm::dot(ac, p - c);
    if (d6 >= 0.0f && d5 <= d6) return at({0.0f, 0.0f, 1.0f});
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f) {
        const float t = share(d2, -d6);
        return at({1.0f - t, 0.0f, t});
    }
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0.0f && d4 - d3 >= 0.0f && d5 - d6 >= 0.0f) {
        const float t = share(d4 - d3, d5 - d6);
        return at({0.0f, 1.0f - t, t});
    }
    const float sum = va + vb + vc;
    if (!(sum > 0.0f)) return at({1.0f, 0.0f, 0.0f});
    return at({va / sum, vb / sum, vc / sum});
}

}  // namespace bendy::converter
