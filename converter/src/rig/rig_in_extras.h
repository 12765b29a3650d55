#pragma once

#include "rig.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <optional>

namespace bendy::converter {

/// The member of a glTF scene's extras that holds a whole rig file: what `bendy export` writes.
inline constexpr const char* kRigInExtras = "bendy_rig";

/// Takes that member out of the scene's extras and reads it. Nothing if there is none, or if it is wrong, which the
/// report says.
std::optional<Rig> take_rig_from_extras(Scene& scene, Report& report);

}  // namespace bendy::converter
