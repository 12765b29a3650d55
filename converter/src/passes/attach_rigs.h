#pragma once

#include "rig/parse_rig.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <optional>

namespace bendy::converter {

/// Gives a scene its joint constraints and IK chains, and clips the markers and curves of rig files. The sources come
/// in the order of their authority (spec/rig.md): what an earlier one says of a joint, or of a chain's name, no later
/// one changes. Fails where the rig file does not go with the scene. \param with_proposals  what is left gets
/// constraints and chains by the joints' names
void attach_rigs(Scene& scene, const std::optional<Rig>& rig_file, bool with_proposals, Report& report);

/// The same for a scene that has its rig already: only the rig file goes before what is there, "complete" ones replace
/// all of it; extras and extensions have spoken when the rig was made.
void change_rig(Scene& scene, const std::optional<Rig>& rig_file, bool with_proposals, Report& report);

}  // namespace bendy::converter
