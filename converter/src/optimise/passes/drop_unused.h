#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

namespace bendy::converter {

/// Drops per-vertex data that changes nothing in a picture of the scene: texture coordinates that no texture of the
/// mesh's materials uses, COLOR_1 and up, colours that are white everywhere, tangents without a normal map, and normals
/// if all materials are unlit; with them the displacements by morph targets. Then merges vertices of these meshes that
/// differ in nothing else; the first of equal ones stays. Drops the palettes' entries that move no vertex. The report
/// names what was dropped.
///
/// Attributes of the author's own stay, as does everything of a mesh without polygons. An extension of a material that
/// is not interpreted counts as a user of what its member names speak of. Vertices of a mesh with a collapse sequence
/// are not merged.
void drop_unused(Scene& scene, Report& report);

}  // namespace bendy::converter
