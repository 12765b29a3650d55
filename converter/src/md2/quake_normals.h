#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace bendy::converter::md2 {

inline constexpr std::size_t kNormals = 162;

/// The directions that a model's vertices name by number, in Quake's axes: the corners of an icosahedron whose faces
/// are cut in four twice, in the order in which the cutting meets them.
std::vector<glm::vec3> quake_normals();

}  // namespace bendy::converter::md2
