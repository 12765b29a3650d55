#pragma once

#include "optimise/collapse/distances.h"
#include "optimise/collapse/surface.h"
#include "scene/space.h"

#include <bendy/converter/scene.h>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bendy::converter {

/// How a vertex looks besides its position, as numbers whose squared differences can be added to squared distances:
/// normals, texture coordinates and colours, each scaled to a length.
struct Appearance {
    std::uint32_t components = 0;
    std::vector<float> values;  ///< components of each vertex

    [[nodiscard]] const float* of(std::uint32_t vertex) const {
        return values.data() + std::size_t{vertex} * components;
    }
};

/// \param shape the mesh at rest, scaled to an extent of about 1
Appearance make_appearance(const Mesh& mesh, const Surface& surface, std::span<const glm::vec3> shape);

/// Points of the original surface at which a simplified one is measured: every vertex and, for a mesh with few
/// vertices, additional ones spread over the triangles by area. Each is assigned to its nearest triangle.
struct Samples {
    explicit Samples(std::size_t shapes) : places(shapes) {}

    ShapedPlaces places;
    std::uint32_t components = 0;
    std::vector<float> appearance;           ///< `components` floats of each sample
    std::vector<std::uint32_t> first, next;  ///< linked lists: head per triangle, next per sample; kNone: end

    void hold(std::uint32_t triangle, std::uint32_t sample) {
        next[sample] = first[triangle];
        first[triangle] = sample;
    }
};

/// \param places of the vertices, by shape
Samples make_samples(const Surface& surface, std::span<const std::vector<glm::vec3>> places,
                     const Appearance& appearance);

/// The surface before any collapse, in every shape, for distance queries. One tree of boxes over the triangles, split
/// along the longest side at rest; each shape has its own boxes.
class Original {
public:
    /// \param places of the vertices, by shape; must outlive this
    Original(const Surface& surface, std::span<const std::vector<glm::vec3>> places);

    /// The squared distance of a place from the surface in a shape, if it is above `enough`; else any value up to
    /// `enough`. Where very many triangles overlap, it may be too large: the work is bounded.
    /// \param near  a triangle of the surface to start with: the nearer, the faster; becomes the nearest one that was
    ///              tested
    [[nodiscard]] float distance_squared(std::size_t shape, const glm::vec3& place, float enough, std::uint32_t& near);
    /// The number of triangles tested so far.
    [[nodiscard]] std::uint64_t work() const { return work_; }

private:
    /// The nodes of a subtree are consecutive: the left child is the next node.
    struct Node {
        std::uint32_t right = 0;
        std::uint32_t first = 0;
        std::uint32_t count = 0;  ///< triangles in order_; 0: an inner node
    };

    [[nodiscard]] glm::vec3 centre(std::uint32_t triangle) const;
    void build();
    [[nodiscard]] int longest_side(std::uint32_t first, std::uint32_t count) const;
    void fit_boxes();

    std::span<const std::vector<glm::vec3>> places_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
    std::vector<std::vector<Box<glm::vec3>>> boxes_;  // by shape, then node
    std::uint64_t work_ = 0;
};

/// Weight of squared distances in shapes other than the rest pose: the skin is mostly seen near rest.
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

/// The quadrics of a surface's points: of the planes in every shape, and of borders at rest.
class Quadrics {
public:
    /// \param places  of the points; must outlive this
    Quadrics(const Surface& surface, const ShapedPlaces& places, std::size_t shapes);

    /// Estimates the squared distance by which the surface would move if the point moved to the target; ranks
    /// candidates.
    [[nodiscard]] float estimate(std::uint32_t point, std::uint32_t target) const;
    /// The part of the estimate that comes from borders.
    [[nodiscard]] float border_error(std::uint32_t point, std::uint32_t target) const;
    /// Adds the planes of a removed point to those of the target.
    void add_to(std::uint32_t target, std::uint32_t point);

private:
    void add_rims(const Surface& surface);
    void add_rim(const Surface& surface, std::uint32_t corner);
    [[nodiscard]] glm::vec3 place(std::size_t shape, std::uint32_t point) const { return places_.place(shape, point); }

    const ShapedPlaces& places_;
    std::size_t shapes_;
    std::vector<Quadric> quadrics_;  ///< by point, then shape
    std::vector<Quadric> rims_;      ///< by point: borders of the surface and of materials
};

}  // namespace bendy::converter
