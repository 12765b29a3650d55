#pragma once

#include <bendy/runtime/lod.h>
#include <bendy/runtime/model.h>

#include <CLI/CLI.hpp>

#include <filesystem>
#include <string>

// The option --lod of what writes geometry.
namespace bendy::cli {

/// A clip by its number, or else by its name. Fails with the clips that there are if it is none.
const Clip& find_clip(const std::string& clip, const std::filesystem::path& file, const Model& model);

/// Adds it; the share is from 0 to 1.
void add_lod(CLI::App& command, float& share);
/// Warns where a level is asked for of a file that has none.
void warn_without_levels(const std::filesystem::path& file, const Model& model, float share);
/// That level of the file's model; full detail, and a warning, if the file has no levels.
Lod level_of(const std::filesystem::path& file, const Model& model, float share);

}  // namespace bendy::cli
