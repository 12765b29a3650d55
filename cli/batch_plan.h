#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bendy::cli {

struct BatchFile {
    std::filesystem::path input;
    std::filesystem::path folder;  ///< that holds the record of the output: the one written to, or the input's own
    std::filesystem::path place;   ///< of the output in that folder
    std::filesystem::path output;
};

/// A file that cannot be written, or a folder that cannot be read, and why.
struct BatchProblem {
    std::filesystem::path input;  ///< empty where an output is to blame
    std::filesystem::path output;
    std::string what;
};

/// What a batch is to do.
struct BatchPlan {
    std::vector<BatchFile> files;       ///< by output
    std::vector<BatchProblem> unread;   ///< folders
    std::vector<BatchProblem> clashes;  ///< two inputs with the same output, or an output that is an input
};

/// A file goes to `folder` under its name; the files in a folder, and in the folders below it, to their places below
/// `folder`: those whose names end as list_readable_suffixes() says. Where `folder` is empty, each goes beside its
/// input. All with the extension .bendy. Links to folders are not followed. Prints a warning for a folder without such
/// files.
/// \param rig  a file that is read besides; may be empty
BatchPlan plan_batch(const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& folder,
                     const std::filesystem::path& rig);

}  // namespace bendy::cli
