#pragma once

#include "names.h"

#include <bendy/converter/report.h>

namespace bendy::converter::x_out {

/// Writes a mesh, at the place in the text of the frame that carries it.
void write_mesh(const Scene& scene, std::uint32_t number, const Names& names, Text& text, Report& report);

}  // namespace bendy::converter::x_out
