#pragma once

#include <filesystem>
#include <string>
#include <string_view>

// The meanings of file name suffixes.
namespace bendy::tools {

/// A suffix with a meaning, and the command that writes it.
struct Meaning {
    std::string_view suffix;
    std::string_view format;
    std::string_view command;  ///< empty: bendy does not write it
};

/// Returns null if the suffix has no meaning.
const Meaning* find_meaning(std::string_view suffix);

/// Returns the suffix in lower case, ".glb".
std::string suffix_of(const std::filesystem::path& file);

/// Returns the format that the suffix means, such as "binary glTF"; empty if it has no meaning.
std::string_view format_named_by(const std::filesystem::path& file);

}  // namespace bendy::tools
