#pragma once

#include <bendy/converter/scene.h>

#include <cstdint>
#include <span>

namespace bendy::converter {

/// Keeps one level of detail: the first `vertices[m]` of each mesh's vertices, the others collapsed onto those;
/// triangles that lose their area go, and so do the collapse sequences. Throws Failure where there are not as many
/// numbers as meshes, or a number is below a mesh's base or, without a sequence, not all of it.
void keep_level(Scene& scene, std::span<const std::uint32_t> vertices);

}  // namespace bendy::converter
