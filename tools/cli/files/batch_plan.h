#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bendy::tools {

struct BatchFile {
    std::filesystem::path input;
    std::filesystem::path folder;  ///< the output folder, or the input's own
    std::filesystem::path place;   ///< of the output, relative to that folder
    std::filesystem::path output;
};

/// A file that cannot be written, or a folder that cannot be read, and the reason.
struct BatchProblem {
    std::filesystem::path input;  ///< empty if the problem is with an output
    std::filesystem::path output;
    std::string what;
};

/// The work of a batch.
struct BatchPlan {
    std::vector<BatchFile> files;       ///< by output
    std::vector<BatchProblem> unread;   ///< folders that could not be read
    std::vector<BatchProblem> clashes;  ///< two inputs with the same output, or an output that is an input
};

struct BatchRequest {
    std::vector<std::filesystem::path> inputs;
    std::filesystem::path folder{};              ///< where outputs go; empty: beside their inputs
    std::vector<std::filesystem::path> reads{};  ///< files that are read in addition; may be empty paths
    bool bendy_files_too = false;                ///< in folders; otherwise only what `convert` converts
    bool replaces_inputs = false;                ///< outputs are to be their inputs
    std::string record{};                        ///< a file that is written in each output's folder; empty: none
};

/// Returns true for one input that is a folder, for several inputs, and if the output is a folder.
bool is_batch(const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& output);

/// Throws CLI::ValidationError if several outputs cannot go to this path, which --output names, or none can be read
/// from standard input.
void check_batch(const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& output);

/// Plans a batch. A file goes to the folder under its own name. The files in a folder and its subfolders go to the same
/// relative paths below it, if their names end with one of list_readable_suffixes(). All outputs have the extension
/// .bendy. Links to folders are not followed. Prints a warning for a folder without such files.
BatchPlan plan_batch(const BatchRequest& request);

/// Returns the files in a folder and its subfolders that `plan_batch` finds, sorted.
/// \param problem  receives why the folder could not be read to its end
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder, bool bendy_files_too,
                                            std::string& problem);

/// Makes the folder of a batch's outputs; fails if it cannot be made.
void make_output_folder(const std::filesystem::path& folder);

}  // namespace bendy::tools
