#pragma once

#include "names.h"

#include <bendy/converter/report.h>

namespace bendy::converter::x_out {

/// Writes AnimTicksPerSecond, an AnimationSet for every cycle, and the cycles' names where they are others.
void write_cycles(const Scene& scene, const Names& names, Text& text, Report& report);

}  // namespace bendy::converter::x_out
