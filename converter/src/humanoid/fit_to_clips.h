#pragma once

#include "anatomy.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <vector>

namespace bendy::converter {

/// Holds proposed limits against the scene's own cycles, key by key: a character that leaves them is no human there, or
/// its joint has other axes than we think. A hinge that turns about other axes becomes its looser form. A limit that is
/// left by up to 30 degrees is widened to hold the keys; one that is left further is taken out, with a warning.
void fit_to_clips(const Scene& scene, std::vector<ProposedLimit>& limits, Report& report);

}  // namespace bendy::converter
