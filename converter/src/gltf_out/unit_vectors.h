#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <vector>

namespace bendy::converter::gltf_out {

/// glTF demands unit vectors; those that are none by more than Khronos' validator lets pass are normalised, and those
/// without a direction point along +Z. The others keep their bits. \return how many were changed
std::uint64_t make_unit(std::vector<glm::vec3>& normals);

/// The same for xyz; w, the handedness, becomes 1 or -1.
std::uint64_t make_unit(std::vector<glm::vec4>& tangents);

}  // namespace bendy::converter::gltf_out
