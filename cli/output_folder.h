#pragma once

#include <filesystem>

namespace bendy::cli {

/// Fails, naming the folder, where the one that an output goes to is not there: before the work, not after it.
void require_folder_of(const std::filesystem::path& output);

}  // namespace bendy::cli
