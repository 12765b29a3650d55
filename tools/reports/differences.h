#pragma once

#include <bendy/converter/compare_characters.h>
#include <bendy/converter/error_bound.h>
#include <bendy/converter/import.h>
#include <bendy/converter/report.h>
#include <bendy/diff/compare_files.h>
#include <bendy/format/byte_reader.h>
#include <bendy/format/chunk_reader.h>
#include <bendy/format/result.h>
#include <bendy/json/json.h>

#include <cstdint>
#include <functional>
#include <string>

// The report of `bendy diff --json`: docs/cli.md.
namespace bendy::tools {

/// Returns the name of a chunk, or of its nearest named ancestor; empty if there is none.
std::string name_around(const ChunkTree& tree, std::uint32_t number);

/// Returns how two files differ, chunk by chunk. \param a_name, b_name  the names of the files in the report
OrderedJson differences_as_json(const std::string& a_name, const std::string& b_name, const diff::ReadFile& a,
                                const diff::ReadFile& b, const diff::Differences& differences);

/// The parts of a character that are compared.
struct ComparedCharacter {
    converter::Scene scene;
    std::string rig;  ///< the constraints and chains, as a rig file
};

/// Reads the character in the bytes of a valid file. \param report  receives a warning about anything that is not
/// compared
Result<ComparedCharacter, converter::ImportError> read_compared(Bytes bytes, converter::Report& report);

/// Compares the content of two files: converter::compare_characters, and their rigs. \param progress  0 to 1; may be
/// empty
converter::CharacterComparison compare_characters(const ComparedCharacter& a, const ComparedCharacter& b,
                                                  const converter::ErrorBound& tolerance,
                                                  const std::function<void(double)>& progress = {});

OrderedJson comparison_as_json(const std::string& a_name, const std::string& b_name,
                               const converter::CharacterComparison& comparison);

}  // namespace bendy::tools
