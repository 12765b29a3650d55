#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace bendy::viewer {

/// The file that an image's URI names inside `folder`, where pictures are drawn from; nothing for what leads elsewhere.
std::optional<std::filesystem::path> linked_file(const std::filesystem::path& folder, std::string_view uri);

}  // namespace bendy::viewer
