#pragma once

#include "collapse/distances.h"
#include "collapse/surface.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bendy::converter {

/// Squared distances in other shapes than the rest pose count for so much: the skin is mostly seen near it.
inline constexpr float kPosedFactor = 0.2f;

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

/// The quadrics of a surface's points: of the planes in every shape, and at rest of borders.
class Quadrics {
public:
    /// \param places  of the points; must outlive this
    Quadrics(const Surface& surface, const ShapedPlaces& places, std::size_t shapes);

    /// About how far the surface would move if the point moved to the target, squared: to choose what is measured.
    [[nodiscard]] float estimate(std::uint32_t point, std::uint32_t target) const;
    /// What of it the borders say.
    [[nodiscard]] float border_error(std::uint32_t point, std::uint32_t target) const;
    /// The point is gone: its planes are the target's.
    void add_to(std::uint32_t target, std::uint32_t point);

private:
    void add_rims(const Surface& surface);
    void add_rim(const Surface& surface, std::uint32_t corner);
    [[nodiscard]] glm::vec3 place(std::size_t shape, std::uint32_t point) const { return places_.place(shape, point); }

    const ShapedPlaces& places_;
    std::size_t shapes_;
    std::vector<Quadric> quadrics_;  ///< by point, then shape
    std::vector<Quadric> rims_;      ///< by point: of borders, of the surface and of materials
};

}  // namespace bendy::converter
