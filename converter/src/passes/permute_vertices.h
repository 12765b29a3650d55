#pragma once

#include <bendy/converter/scene.h>

#include <cstdint>
#include <span>
#include <vector>

namespace bendy::converter {

/// Puts a mesh's vertices in another order, with all streams, targets and indices; its collapse sequence is not looked
/// at. \param order the old number of each new vertex; every one once, but for vertices that nothing is drawn with:
/// they may be left out \return the new number of each old vertex, kNone if it was left out
std::vector<std::uint32_t> permute_vertices(Mesh& mesh, std::span<const std::uint32_t> order);

}  // namespace bendy::converter
