#pragma once

#include "text.h"

#include <bendy/converter/export.h>
#include <bendy/converter/report.h>

// The parts of an export.

namespace bendy::converter::x_out {

/// BendyConstraint of a joint, once for each scope.
void write_constraints(const Joint& joint, Text& text);

/// BendyIkChain of every chain.
void write_chains(const Scene& scene, const Names& names, Text& text);

/// Writes a mesh, at the place in the text of the frame that carries it.
void write_mesh(const Scene& scene, std::uint32_t number, const Names& names, Text& text, Report& report);

/// Writes every joint as a Frame inside its parent's, with its constraints and the meshes that it carries; then the
/// meshes that no joint carries.
void write_frames(const Scene& scene, const Names& names, Text& text, Report& report);

/// Writes every material at the file's top. Images that the scene embeds become files beside it.
void write_materials(const Scene& scene, const Names& names, const std::string& image_stem, Text& text,
                     std::vector<XAsset::File>& images, Report& report);

/// Writes AnimTicksPerSecond, an AnimationSet for every clip, and the clips' names where they are others.
void write_clips(const Scene& scene, const Names& names, Text& text, Report& report);

}  // namespace bendy::converter::x_out
