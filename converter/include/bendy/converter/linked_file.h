#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace bendy::converter {

/// The file that a link to an image means, as LINK holds it: a relative URI is relative to the folder of `file`.
/// Nothing for data and for URIs of other schemes than `file`. The file need not exist. Throws nothing.
std::optional<std::filesystem::path> linked_file(std::string_view uri, const std::filesystem::path& file);

}  // namespace bendy::converter
