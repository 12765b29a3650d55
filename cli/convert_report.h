#pragma once

#include <bendy/converter/report.h>
#include <bendy/format/byte_reader.h>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

// What `bendy convert --json` says of each input: docs/convert.md.
namespace bendy::cli {

/// Of an input that was converted. \param bytes  of the output
nlohmann::ordered_json converted_report(const std::filesystem::path& input, const std::filesystem::path& output,
                                        const converter::Report& report, Bytes bytes);
/// Of an output that stays as it is.
nlohmann::ordered_json up_to_date_report(const std::filesystem::path& input, const std::filesystem::path& output);
/// Of an input that could not be converted. \param file  that is to blame
nlohmann::ordered_json failed_report(const std::filesystem::path& input, const std::filesystem::path& output,
                                     const converter::Report& report, const std::filesystem::path& file,
                                     const std::string& what);

/// On a line of its own, to standard output.
void print_report(const nlohmann::ordered_json& report);

}  // namespace bendy::cli
