#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace bendy::converter {

/// What can be converted.
enum class SourceFormat : std::uint8_t { gltf, bendy, x, md2 };

/// The endings of files that can be converted, in small letters.
inline constexpr std::array<std::string_view, 6> kReadableExtensions{".gltf", ".glb", ".vrm", ".bendy", ".x", ".md2"};

/// Told by the file's first bytes; where these say nothing, by its name. What is neither counts as glTF, whose importer
/// says what is wrong.
SourceFormat find_source_format(const std::filesystem::path& file);

}  // namespace bendy::converter
