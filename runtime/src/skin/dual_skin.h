#pragma once

#include "plan/blocks.h"
#include "pose/pose_state.h"

#include <cstdint>
#include <span>

namespace bendy {

/// Skins the first vertices of a skinned mesh. Returns false, and writes nothing, if the palette has numbers that are
/// not finite: the linear kernels handle these.
/// \param state       not stale
/// \param motions_of  the mesh whose motions are in state.dual, kNone at first
/// \param weights     of the mesh's targets
/// \param outputs     number of vertices, and their destination; the rest is ignored
bool skin_by_dual_quaternions(PoseState& state, std::uint32_t mesh, std::uint32_t& motions_of,
                              std::span<const float> weights, const SkinBlock& outputs);

}  // namespace bendy
