#pragma once

#include <filesystem>

namespace bendy {

/// The folder of the project's sources. Compiled into one source of its own: all others are then the same in every
/// clone, and a compiler cache has them.
std::filesystem::path source_folder();

}  // namespace bendy
