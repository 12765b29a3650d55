#pragma once

#include <bendy/runtime/model.h>

#include <filesystem>
#include <string>

namespace bendy::cli {

/// A cycle by its number, or else by its name. Fails with the cycles that there are if it is none.
const Cycle& find_cycle(const std::string& clip, const std::filesystem::path& file, const Model& model);

}  // namespace bendy::cli
