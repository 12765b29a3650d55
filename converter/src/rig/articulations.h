#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <vector>

namespace bendy::converter {

/// Gives joints that name an articulation of AGI_articulations (in Joint::extensions and Scene::extensions), have no
/// limits and are not `claimed`, one limit of its stages. A joint moves as its stages say and no other way. What a
/// limit cannot say (scale, several turns about one axis, translation after rotation) is approximated or named in
/// `report`; malformed articulations are named by JSON path and left out. \param claimed  by joint: somebody has said
/// that it has no limits; empty: nobody has
void add_articulations(Scene& scene, const std::vector<bool>& claimed, Report& report);

}  // namespace bendy::converter
