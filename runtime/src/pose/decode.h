#pragma once

#include <bendy/format/mesh.h>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <span>

namespace bendy {

/// Decodes elements of a stream, from `first` on, with the kernel in use: as StreamView::decode, except for rounding.
void decode(const StreamView& stream, std::size_t first, std::span<glm::vec3> out);
void decode(const StreamView& stream, std::size_t first, std::span<glm::vec4> out);

}  // namespace bendy
