#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace bendy::converter {

/// Sum of squared distances from planes, weighted: M. Garland and P. Heckbert, Surface Simplification Using Quadric
/// Error Metrics, 1997.
struct Quadric {
    float xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0, x = 0, y = 0, z = 0, constant = 0, weight = 0;

    /// The plane through `point` with the unit normal `n`.
    void add_plane(const glm::vec3& n, const glm::vec3& point, float w) {
        const float d = -glm::dot(n, point);
        xx += w * n.x * n.x, yy += w * n.y * n.y, zz += w * n.z * n.z;
        xy += w * n.x * n.y, xz += w * n.x * n.z, yz += w * n.y * n.z;
        x += w * n.x * d, y += w * n.y * d, z += w * n.z * d;
        constant += w * d * d;
        weight += w;
    }
    void add(const Quadric& q) {
        xx += q.xx, yy += q.yy, zz += q.zz, xy += q.xy, xz += q.xz, yz += q.yz;
        x += q.x, y += q.y, z += q.z, constant += q.constant, weight += q.weight;
    }
    /// The weighted mean of the squared distances of `p` from the planes.
    [[nodiscard]] float mean_error(const glm::vec3& p) const {
        if (!(weight > 0.0f)) return 0.0f;
        const float sum = p.x * (xx * p.x + 2.0f * (xy * p.y + xz * p.z + x)) +
                          p.y * (yy * p.y + 2.0f * (yz * p.z + y)) + p.z * (zz * p.z + 2.0f * z) + constant;
        return sum > 0.0f ? sum / weight : 0.0f;
    }
};

}  // namespace bendy::converter
