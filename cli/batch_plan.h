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

/// What a batch is to do.
struct BatchPlan {
    std::vector<BatchFile> files;     ///< by output
    std::vector<std::string> unread;  ///< folders that could not be read, and why
};

/// A file goes to `folder` under its name; the files in a folder, and in the folders below it, to their places below
/// `folder`: those whose names end as kReadableExtensions say. Where `folder` is empty, each goes beside its input. All
/// with the extension .bendy. Links to folders are not followed. Prints a warning for a folder without such files.
/// Fails, before anything is done, where two inputs have the same output, or an output is an input.
BatchPlan plan_batch(const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& folder);

}  // namespace bendy::cli
