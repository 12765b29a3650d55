#pragma once

#include <bendy/format/public.h>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <span>

namespace BENDY_PUBLIC bendy {

/// The caller's memory for posed vertices, in model space. An empty span means: not wanted.
struct Vertices {
    std::span<glm::vec3> positions;
    std::span<glm::vec3> normals;   ///< unit; zero where the source has none
    std::span<glm::vec4> tangents;  ///< unit xyz, w = handedness +-1; zero where the source has none
};

/// One attribute in a layout of the caller's: vertex v's numbers are floats[v * stride] and those after it. What lies
/// between is neither read nor written. An empty span means: not wanted.
struct StridedFloats {
    std::span<float> floats;  ///< from the first vertex' first number; the last vertex needs no whole stride
    std::size_t stride = 0;   ///< floats from vertex to vertex, at least the attribute's own
};

/// Vertices for a buffer of any layout, interleaved or not; it is only written, so it may be a mapped graphics buffer.
struct VertexBuffer {
    StridedFloats positions;  ///< x y z
    StridedFloats normals;    ///< x y z, as in Vertices
    StridedFloats tangents;   ///< x y z w, as in Vertices
};

}  // namespace bendy
