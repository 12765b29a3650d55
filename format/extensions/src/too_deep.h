#pragma once

#include <string_view>

namespace bendy::extensions {

/// Returns true if brackets are nested too deeply for recursive parsing, copying and printing: kMostLevels.
bool is_too_deep(std::string_view text);

}  // namespace bendy::extensions
