#pragma once

#include "plan/skin_block.h"
#include "pose/pose_state.h"

#include <cstdint>
#include <span>

namespace bendy {

/// Skins the first vertices of a skinned mesh. False, and nothing written, if the palette has numbers that are not
/// finite: they are for the linear kernels.
/// \param state       not stale
/// \param motions_of  the mesh whose palette state.dual has the motions of, kNone at first
/// \param weights     of the mesh's targets
/// \param outputs     how many vertices, and where they go; the rest is not looked at
bool skin_by_dual_quaternions(PoseState& state, std::uint32_t mesh, std::uint32_t& motions_of,
                              std::span<const float> weights, const SkinBlock& outputs);

}  // namespace bendy
