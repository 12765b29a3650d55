#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <span>

namespace bendy {

/// The caller's memory for posed vertices, in model space. An empty span means: not wanted.
struct Vertices {
    std::span<glm::vec3> positions;
    std::span<glm::vec3> normals;   ///< unit; zero where the source has none
    std::span<glm::vec4> tangents;  ///< unit xyz, w = handedness +-1; zero where the source has none
};

}  // namespace bendy
