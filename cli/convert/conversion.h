#pragma once

#include "convert/convert_options.h"

#include <bendy/converter/convert.h>
#include <bendy/converter/report.h>
#include <bendy/format/byte_reader.h>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

// What `bendy convert --json` says of each input: docs/convert.md.
namespace bendy::cli {

/// What `bendy convert` is told.
struct ConvertArguments : ConvertChoices {
    std::vector<std::filesystem::path> inputs;
    std::filesystem::path output;  ///< a file; of several inputs, a folder
    std::filesystem::path depfile;
    bool exact = true;
    unsigned jobs = 0;  ///< files at a time, or threads for one file; 0: one for each processor
    bool force = false;
    bool json = false;
    bool quiet = false;
};

/// Of one file that is converted alone: with as many threads as there are jobs.
converter::ConvertOptions options_of(const ConvertArguments& arguments);

/// As asked for, or as many as there are processors; 1 at least.
unsigned jobs_of(const ConvertArguments& arguments);

/// All that decides which bytes come out, with the program's version, as one line of text.
std::string recipe_of(const ConvertArguments& arguments);

/// Of an input that was converted. \param bytes  of the output
nlohmann::ordered_json converted_report(const std::filesystem::path& input, const std::filesystem::path& output,
                                        const converter::Report& report, Bytes bytes);
/// Of an output that stays as it is.
nlohmann::ordered_json up_to_date_report(const std::filesystem::path& input, const std::filesystem::path& output);
/// Of an input that could not be converted. \param file  that is to blame
nlohmann::ordered_json failed_report(const std::filesystem::path& input, const std::filesystem::path& output,
                                     const converter::Report& report, const std::filesystem::path& file,
                                     const std::string& what);

}  // namespace bendy::cli
