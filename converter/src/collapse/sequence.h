#pragma once

#include <bendy/converter/scene.h>

#include "collapse/surface.h"

#include <cstdint>
#include <span>
#include <vector>

namespace bendy::converter {

/// A vertex that moves onto another one.
struct VertexMove {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    bool is_joined = false;  ///< goes together with the move before it
    float error = 0.0f;      ///< metres; does not fall from move to move
};

/// In the order in which they happen. What vertices are left keep their places.
struct Sequence {
    std::vector<VertexMove> moves;
};

/// The collapse sequence of a mesh. \param shapes as find_shapes has them \param surface of this mesh; used up
Sequence find_sequence(const Mesh& mesh, std::span<const Shape> shapes, Surface surface);

}  // namespace bendy::converter
