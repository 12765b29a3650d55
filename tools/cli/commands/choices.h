#pragma once

#include <CLI/App.hpp>

#include <string>
#include <vector>

namespace bendy::tools {

/// "a, b and c"
std::string enumerate(const std::vector<std::string>& words);

/// "; did you mean "fabrik"?" if one of the words is close to what was typed, otherwise nothing.
std::string suggest(const std::vector<std::string>& words, const std::string& typed);

/// Accepts these words only. Help shows them as "{glb,gltf,x}"; the error lists them, and suggests the closest one.
CLI::Validator one_of(const std::vector<std::string>& words);

}  // namespace bendy::tools
