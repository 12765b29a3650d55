#pragma once

#include "x_file.h"

#include <bendy/converter/report.h>

#include <string_view>

namespace bendy::converter::x {

/// Reads an X-file, text or binary. Indices inside a mesh are in range, counts agree; what refers to frames and
/// materials by name is not looked up yet. Fails at `line 3, column 7`; what is not known is named in `report`.
XFile read_x_file(std::string_view file, Report& report);

}  // namespace bendy::converter::x
