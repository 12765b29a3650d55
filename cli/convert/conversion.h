#pragma once

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
struct ConvertArguments {
    std::vector<std::filesystem::path> inputs;
    std::filesystem::path output;  ///< a file; of several inputs, a folder
    std::string scene;
    std::string images = "embed";
    bool instances = false;
    std::filesystem::path rig;
    std::filesystem::path root;  ///< see ReadableFolders; may be empty
    std::filesystem::path depfile;
    bool exact = true;
    std::filesystem::path texture;  ///< of Quake II models; empty: as the file says
    double ticks_per_second = 0.0;  ///< of X-files; 0: as the file says
    bool merge_clips = false;
    bool auto_rig = false;
    bool auto_skin = false;
    std::string skeleton;
    bool compact = false;
    std::string max_error;
    bool lod = false;
    bool sort_vertices = false;
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
