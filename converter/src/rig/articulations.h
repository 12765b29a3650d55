#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

namespace bendy::converter {

/// Gives joints that name an articulation of AGI_articulations (in Joint::extensions and Scene::extensions), and have
/// no limits, one limit of its stages. A joint moves as its stages say and no other way. What a limit cannot say
/// (scale, several turns about one axis, translation after rotation) is approximated or named in `report`; malformed
/// articulations are named by JSON path and left out.
void add_articulations(Scene& scene, Report& report);

}  // namespace bendy::converter
