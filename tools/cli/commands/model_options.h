#pragma once

#include "reports/convert_options.h"

#include <bendy/runtime.h>

#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// Options that several commands share, and what they ask of a model.
namespace bendy::tools {

/// Adds FILE, for a command that takes a character of any kind.
CLI::Option* add_character(CLI::App& command, std::filesystem::path& file);
/// Adds --root, for a command that reads the files that its input names.
CLI::Option* add_root(CLI::App& command, std::filesystem::path& root);

/// Adds --clip, for a command that shows the rest pose without it.
CLI::Option* add_clip(CLI::App& command, std::string& clip);
/// Returns a clip by its name or number, see find_by_key. If there is none, fails with a list of the clips.
const Clip& find_clip(const std::string& clip, const std::filesystem::path& file, const Model& model);

/// Splits "walk.glb:Walk" into a file that exists and a clip in it; the clip is empty if there is a file of that name.
std::pair<std::filesystem::path, std::string> split_clip(const std::string& text);

/// Adds --format. \param formats  the first is the default for standard output
void add_format(CLI::App& command, std::string& format, const std::vector<std::string>& formats);

/// Parses numbers separated by commas; empty if the text is anything else.
std::vector<float> read_numbers(std::string_view text);

/// Adds --lod; the fraction is from 0 to 1.
void add_lod(CLI::App& command, float& share);
/// Warns if a level of detail is requested but the file has none.
void warn_without_levels(const std::filesystem::path& file, const Model& model, float share);
/// Returns that level of the file's model; full detail, with a warning, if the file has no levels.
Lod level_of(const std::filesystem::path& file, const Model& model, float share);

}  // namespace bendy::tools
