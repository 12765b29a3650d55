#pragma once

#include <bendy/converter/compare_characters.h>
#include <bendy/diff/compare_files.h>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>

// What `bendy diff --json` says, without the names of the files.
namespace bendy::cli {

/// The name of a chunk, or of the nearest around it that has one.
std::string name_around(const ChunkTree& tree, std::uint32_t number);

nlohmann::ordered_json differences_as_json(const diff::ReadFile& a, const diff::ReadFile& b,
                                           const diff::Differences& differences);

/// Adds the difference of two rigs, as rig files, if there is one.
void add_rig_difference(converter::CharacterComparison& comparison, const std::string& a, const std::string& b);

nlohmann::ordered_json comparison_as_json(const converter::CharacterComparison& comparison);

}  // namespace bendy::cli
