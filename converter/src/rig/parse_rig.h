#pragma once

#include "rig.h"

#include <bendy/converter/report.h>

#include <filesystem>
#include <string_view>

namespace bendy::converter {

/// A rig file (spec/rig.md). Fails at the JSON path of what is wrong; text that is no JSON, with line and column.
Rig parse_rig(std::string_view text, Report& report);

/// The same from a file. Fails with an empty place where it cannot be read.
Rig read_rig(const std::filesystem::path& file, Report& report);

}  // namespace bendy::converter
