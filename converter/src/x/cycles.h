#pragma once

#include "joints.h"
#include "x_file.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

namespace bendy::converter::x {

/// Fills Scene::cycles. Keys are linear; a single key that says no more than the rest pose is none.
void import_cycles(const XFile& file, const FrameIndex& frames, Scene& scene, Report& report);

}  // namespace bendy::converter::x
