#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::cli {

/// The suffix in small letters, ".glb".
std::string suffix_of(const std::filesystem::path& file);

/// The format that the suffix means, as "binary glTF"; empty if it has no meaning.
std::string_view format_named_by(const std::filesystem::path& file);

/// What a subcommand writes.
struct Writes {
    std::string_view command;                ///< "convert"
    std::string_view option;                 ///< whose value the output is: "--output"
    std::vector<std::string_view> suffixes;  ///< what it writes, in small letters
    bool others_too = true;                  ///< suffixes without a meaning, and none, name the same format
};

/// Throws CLI::ValidationError where the output's suffix means a format that the subcommand does not write, saying by
/// which commands `input` becomes it; or, unless `others_too`, where it is none of the suffixes. Standard output is
/// always right.
void check_suffix(const Writes& writes, const std::filesystem::path& input, const std::filesystem::path& output);

/// The same for a subcommand with --format: a format that is given goes before a suffix without a meaning, and must
/// agree with one that has it. \param format  a suffix without its dot; empty: not given
void check_format(const Writes& writes, const std::string& format, const std::filesystem::path& input,
                  const std::filesystem::path& output);

}  // namespace bendy::cli
