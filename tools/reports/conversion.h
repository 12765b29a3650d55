#pragma once

#include "reports/convert_options.h"

#include <bendy/converter/convert.h>
#include <bendy/converter/report.h>
#include <bendy/format/byte_reader.h>
#include <bendy/json/json.h>

#include <filesystem>
#include <string>
#include <vector>

// The report of `bendy convert --json` on each input: docs/convert.md.
namespace bendy::tools {

/// The arguments of `bendy convert`.
struct ConvertArguments : ConvertChoices {
    std::vector<std::filesystem::path> inputs;
    std::filesystem::path output;  ///< a file; a folder if there are several inputs
    std::filesystem::path depfile;
    bool exact = false;  ///< said, although it is the default
    unsigned jobs = 0;   ///< files at a time, or threads for one file; 0: one per processor
    bool force = false;
    bool json = false;
    bool quiet = false;
    bool verbose = false;
};

/// Returns the options for converting a single file, with as many threads as there are jobs.
converter::ConvertOptions options_of(const ConvertArguments& arguments);

/// Returns how many threads to use: as many as asked for, or as there are processors for 0; at least 1.
unsigned jobs_of(unsigned asked);

/// Returns everything that determines the output's bytes, including the program's version, as one line of text.
std::string recipe_of(const ConvertArguments& arguments);

/// Reports a successful conversion. \param bytes  of the output
OrderedJson converted_report(const std::filesystem::path& input, const std::filesystem::path& output,
                             const converter::Report& report, Bytes bytes);
/// Reports an output that is up to date.
OrderedJson up_to_date_report(const std::filesystem::path& input, const std::filesystem::path& output);
/// Reports a failed conversion. \param file  the file that caused it
OrderedJson failed_report(const std::filesystem::path& input, const std::filesystem::path& output,
                          const converter::Report& report, const std::filesystem::path& file, const std::string& what);

}  // namespace bendy::tools
