#pragma once

#include "collapse/distances.h"
#include "collapse/surface.h"
#include "space.h"

#include <bendy/converter/scene.h>

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace bendy::converter {

/// What of a vertex is seen besides its place, as numbers whose squared differences can be added to squared distances:
/// normals, texture coordinates, colours, each times a length.
struct Appearance {
    std::uint32_t components = 0;
    std::vector<float> values;  ///< components of each vertex

    [[nodiscard]] const float* of(std::uint32_t vertex) const {
        return values.data() + std::size_t{vertex} * components;
    }
};

/// \param shape the mesh at rest, scaled to an extent of about 1
Appearance make_appearance(const Mesh& mesh, const Surface& surface, std::span<const glm::vec3> shape);

/// Points of the original surface that a simplified one is measured at: every vertex, and on a mesh with few vertices
/// more of them, spread over the triangles by area. Each is held by the triangle that it is nearest to.
struct Samples {
    explicit Samples(std::size_t shapes) : places(shapes) {}

    ShapedPlaces places;
    std::uint32_t components = 0;
    std::vector<float> appearance;           ///< components of each sample
    std::vector<std::uint32_t> first, next;  ///< lists: of each triangle, of each sample; kNone: end

    void hold(std::uint32_t triangle, std::uint32_t sample) {
        next[sample] = first[triangle];
        first[triangle] = sample;
    }
};

/// \param places of the vertices, by shape
Samples make_samples(const Surface& surface, std::span<const std::vector<glm::vec3>> places,
                     const Appearance& appearance);

/// A surface as it was before anything was collapsed, in every shape, to ask how far a place is from it. One tree of
/// boxes over the triangles, halved along the longest side at rest; each shape has its own boxes.
class Original {
public:
    /// \param places of the vertices, by shape; must outlive this
    Original(const Surface& surface, std::span<const std::vector<glm::vec3>> places);

    /// The squared distance of a place from the surface in a shape, if it is above `enough`; else anything up to
    /// `enough`. \param near a triangle, by its number in the surface, to begin with: the nearer, the sooner done;
    /// becomes the nearest that was met
    [[nodiscard]] float distance_squared(std::size_t shape, const glm::vec3& place, float enough,
                                         std::uint32_t& near) const;

private:
    /// The nodes of a subtree follow one another: the left child is the next node.
    struct Node {
        std::uint32_t right = 0;
        std::uint32_t first = 0;
        std::uint32_t count = 0;  ///< of triangles in order_; 0: has children
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
};

}  // namespace bendy::converter
