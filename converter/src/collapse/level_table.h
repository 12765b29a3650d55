#pragma once

#include <bendy/converter/scene.h>

#include "collapse/sequence.h"

#include <span>
#include <vector>

namespace bendy::converter {

/// Levels at which all meshes have gone as far as one error allows, from full detail to the least, some tens of them,
/// each with about the same share of the vertices of the one before.
std::vector<LodLevel> make_levels(std::span<const Mesh> meshes, std::span<const Sequence> sequences);

}  // namespace bendy::converter
