#pragma once

#include <bendy/converter/scene.h>

#include <cstdint>
#include <vector>

namespace bendy::converter {

/// Branches of the skeleton that may each be a character: below the lowest joint that carries them all, or roots.
/// \param chosen  by joint: a branch has at least kFewestCharacterJoints of these
/// \return their topmost joints; none or one if the skeleton does not divide
std::vector<std::uint32_t> find_branches(const Scene& scene, const std::vector<bool>& chosen);

/// By joint: whether it is one of the chosen and `top`, or below it.
std::vector<bool> only_below(const Scene& scene, const std::vector<bool>& chosen, std::uint32_t top);

}  // namespace bendy::converter
