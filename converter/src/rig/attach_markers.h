#pragma once

#include "rig.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

namespace bendy::converter {

/// Gives the scene's cycles the markers of a source, in place of their own; a complete one that says anything of
/// markers leaves no others. An entry that no cycle takes is named in `report`. Fails at the JSON path of a marker
/// outside its cycle, and of a second entry for one cycle.
void attach_markers(Scene& scene, const Rig& rig, Report& report);

}  // namespace bendy::converter
