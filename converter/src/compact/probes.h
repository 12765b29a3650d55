#pragma once

#include "compact/affine.h"

#include <bendy/converter/scene.h>

#include <cstdint>
#include <vector>

namespace bendy::converter {

enum class Probes : std::uint8_t {
    skin_and_shell,  ///< the skin's extreme points and the shell
    shell,           ///< the shell alone: for comparison with what others measure
};

/// Where errors are measured: points in each joint's space. The skin moves no farther than the hull of the points that
/// a joint influences; the shell, three points at 3 % of the character's height from a joint along its axes, stands for
/// what hangs on it.
std::vector<std::vector<glm::dvec3>> find_probes(const Scene& scene, Probes kind);

}  // namespace bendy::converter
