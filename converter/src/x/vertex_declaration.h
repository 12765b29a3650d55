#pragma once

#include "object_reader.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <vector>

namespace bendy::converter::x {

/// What a DeclData has of each vertex; empty: nothing.
struct DeclaredStreams {
    std::vector<glm::vec3> normals;
    std::vector<glm::vec2> coords;   ///< the first set
    std::vector<glm::vec4> colours;  ///< the first set, 0 to 1
};

/// Reads a DeclData, whose type's name has been read: a Direct3D 9 vertex declaration (D3DVERTEXELEMENT9: type, method,
/// usage, index of the usage) and the vertices' bytes as 32-bit numbers. Other usages, such as tangents and further
/// texture coordinates, are named in the report. Fails on types that Direct3D does not have and on a size that is not
/// that of `vertices`.
DeclaredStreams read_vertex_declaration(ObjectReader& in, std::size_t vertices);

}  // namespace bendy::converter::x
