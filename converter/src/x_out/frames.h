#pragma once

#include "names.h"

#include <bendy/converter/report.h>

namespace bendy::converter::x_out {

/// Writes every joint as a Frame inside its parent's, with its constraints and the meshes that it carries; then the
/// meshes that no joint carries.
void write_frames(const Scene& scene, const Names& names, Text& text, Report& report);

}  // namespace bendy::converter::x_out
