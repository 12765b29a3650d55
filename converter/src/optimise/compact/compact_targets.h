#pragma once

#include "optimise/compact/compact_geometry.h"

#include <bendy/converter/scene.h>

#include <cstdint>

namespace bendy::converter {

/// Quantises the displacements of a mesh's morph targets, with one step for all, and replaces the scene's numbers with
/// those that the integers decode to. The targets together move no vertex farther off than the bound at the weights of
/// the rest pose and of the clips, and each of them alone at a weight of 1.
/// \param number      the mesh
/// \param compact     its targets: as many as the mesh has
/// \param most_error  in the mesh's space
void compact_targets(Scene& scene, std::uint32_t number, CompactMesh& compact, double most_error);

}  // namespace bendy::converter
