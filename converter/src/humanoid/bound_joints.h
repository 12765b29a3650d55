#pragma once

#include <bendy/converter/scene.h>

#include <cstdint>
#include <vector>

namespace bendy::converter {

/// By joint: whether a mesh is bound to it, or to one below it. All where no mesh is bound.
std::vector<bool> find_bound_joints(const Scene& scene);

/// By joint: its children among those of `chosen`, in the joints' order.
std::vector<std::vector<std::uint32_t>> list_children(const Scene& scene, const std::vector<bool>& chosen);

}  // namespace bendy::converter
