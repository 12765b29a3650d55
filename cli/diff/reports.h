#pragma once

#include <bendy/converter/compare_characters.h>
#include <bendy/converter/error_bound.h>
#include <bendy/converter/import.h>
#include <bendy/converter/report.h>
#include <bendy/diff/compare_files.h>
#include <bendy/format/byte_reader.h>
#include <bendy/format/chunk_reader.h>
#include <bendy/format/result.h>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <functional>
#include <string>

// What `bendy diff --json` says: docs/cli.md.
namespace bendy::cli {

/// The name of a chunk, or of the nearest around it that has one; empty if none has.
std::string name_around(const ChunkTree& tree, std::uint32_t number);

/// How two files differ, chunk by chunk. \param a_name, b_name  what the report calls the files
nlohmann::ordered_json differences_as_json(const std::string& a_name, const std::string& b_name,
                                           const diff::ReadFile& a, const diff::ReadFile& b,
                                           const diff::Differences& differences);

/// What is compared of a character.
struct ComparedCharacter {
    converter::Scene scene;
    std::string rig;  ///< its constraints and chains, as a rig file
};

/// The character in the bytes of a valid file. \param report  receives a warning for what is not compared
Result<ComparedCharacter, converter::ImportError> read_compared(Bytes bytes, converter::Report& report);

/// Compares what two files mean: converter::compare_characters, and their rigs. \param progress  0 to 1; may be empty
converter::CharacterComparison compare_characters(const ComparedCharacter& a, const ComparedCharacter& b,
                                                  const converter::ErrorBound& tolerance,
                                                  const std::function<void(double)>& progress = {});

nlohmann::ordered_json comparison_as_json(const std::string& a_name, const std::string& b_name,
                                          const converter::CharacterComparison& comparison);

}  // namespace bendy::cli
