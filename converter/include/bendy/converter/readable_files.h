#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>

namespace bendy::converter {

/// What the names of files that `convert` reads end in, bendy files apart; the one list of them. What a file really is
/// its content tells.
inline constexpr std::array<std::string_view, 5> kReadableExtensions{".gltf", ".glb", ".vrm", ".x", ".md2"};

/// ".gltf, .glb, ...": for messages.
inline std::string list_readable_extensions() {
    std::string list;
    for (const std::string_view extension : kReadableExtensions)
        list.append(list.empty() ? "" : ", ").append(extension);
    return list;
}

/// True if the file's name ends in one of them, in capitals or not.
inline bool has_readable_extension(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
    return std::find(kReadableExtensions.begin(), kReadableExtensions.end(), extension) != kReadableExtensions.end();
}

}  // namespace bendy::converter
