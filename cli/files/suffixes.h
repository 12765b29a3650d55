#pragma once

#include <filesystem>
#include <string>
#include <string_view>

// What the suffixes of files mean.
namespace bendy::cli {

/// A suffix with a meaning, and who writes it.
struct Meaning {
    std::string_view suffix;
    std::string_view format;
    std::string_view command;  ///< empty: bendy does not write it
};

/// Null if the suffix has no meaning.
const Meaning* find_meaning(std::string_view suffix);

/// The suffix in small letters, ".glb".
std::string suffix_of(const std::filesystem::path& file);

/// The format that the suffix means, as "binary glTF"; empty if it has no meaning.
std::string_view format_named_by(const std::filesystem::path& file);

}  // namespace bendy::cli
