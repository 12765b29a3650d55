#pragma once

#include "joints.h"
#include "source/budget.h"
#include "x_file.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

namespace bendy::converter::x {

/// Fills Scene::meshes; faces become triangles, and positions that have several normals several vertices. A rigid mesh
/// outside of all frames gets a joint of its own.
void import_meshes(const XFile& file, const FrameIndex& frames, Budget& budget, Scene& scene, Report& report);

}  // namespace bendy::converter::x
