#pragma once

#include "collapse/find_shapes.h"
#include "compare/looks.h"

#include <bendy/converter/scene.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace bendy::converter {

struct Polygon {
    std::array<std::uint32_t, 3> vertices{};
    std::uint32_t corners = 3;  ///< 2: a line; 1: a point
    std::uint32_t material = kNone;
};

/// Which polygons of two meshes are the same.
struct MatchedPolygons {
    struct Corner {
        std::uint32_t a, b;  ///< vertices
        friend bool operator==(const Corner& x, const Corner& y) { return x.a == y.a && x.b == y.b; }
        friend bool operator<(const Corner& x, const Corner& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; }
    };
    std::vector<Corner> corners;  ///< of all pairs, each once, sorted
    std::vector<Polygon> only_in_a, only_in_b;
    bool gave_up = false;  ///< too many lie within the tolerance of one another
};

/// Pairs polygons of the same material one to one, whatever their order and their vertices: those whose corners lie
/// together in all shapes, at best within the tolerance, the more alike the better. Where several lie within it, as
/// many as possible get a partner. What is left then is paired with what rests at the same place, or else is nearest,
/// up to a tenth of the mesh's extent away; what has no partner at all is named, but for polygons that are smaller than
/// the tolerance. \param shapes_a     as find_shapes has them, for both meshes on the same skeleton: more of one are
/// left aside \param material_of  A's number of each of B's materials; kNone: A has none like it
MatchedPolygons match_polygons(const Mesh& a, const Mesh& b, std::span<const Shape> shapes_a,
                               std::span<const Shape> shapes_b, std::span<const std::uint32_t> material_of,
                               const Looks& looks, double tolerance);

}  // namespace bendy::converter
