#pragma once

#include <bendy/converter/scene.h>

#include "collapse/shaped_places.h"
#include "collapse/surface.h"

#include <glm/vec3.hpp>

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

}  // namespace bendy::converter
