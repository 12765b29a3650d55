#pragma once

#include "reports/conversion.h"

#include <bendy/converter/report.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace bendy::tools {

struct BatchFile {
    std::filesystem::path input;
    std::filesystem::path folder;  ///< holds the record of the output: the output folder, or the input's own
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

/// Plans a batch. A file goes to `folder` under its own name. The files in a folder and its subfolders go to the same
/// relative paths below `folder`, if their names end with one of list_readable_suffixes(). If `folder` is empty, each
/// output goes beside its input. All outputs have the extension .bendy. Links to folders are not followed. Prints a
/// warning for a folder without such files.
/// \param rig  a file that is read in addition; may be empty
BatchPlan plan_batch(const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& folder,
                     const std::filesystem::path& rig);

/// Records what the outputs in a folder were made from and how, in the folder's file .bendy_batch.json. An output is up
/// to date if it and all its sources have the recorded sizes and times, and the recipe is the same. Outputs that the
/// record does not know, or all if it cannot be read, are converted again.
class BatchRecord {
public:
    explicit BatchRecord(const std::filesystem::path& folder);

    /// Returns the path of a folder's record.
    static std::filesystem::path file_in(const std::filesystem::path& folder);

    /// Returns true if a batch has written the output here, even if it has changed since.
    [[nodiscard]] bool knows(const BatchFile& file) const;
    [[nodiscard]] bool is_up_to_date(const BatchFile& file, const std::string& recipe) const;
    /// Call it once the output is in place.
    void note(const BatchFile& file, const std::string& recipe, const std::vector<converter::SourceFile>& sources);
    /// Writes the record; returns nothing, or why it failed.
    [[nodiscard]] std::string write() const;

private:
    struct Entry {
        std::string recipe;
        converter::FileStamp output;
        std::vector<converter::SourceFile> sources;  ///< the input is the first; absolute paths
    };

    void read();
    std::filesystem::path folder_;
    std::filesystem::path file_;
    std::map<std::string, Entry> entries_;  ///< by the output's path in the folder
};

/// Converts the inputs into the output folder, or each beside itself if there is none, several at a time; only those
/// that have changed. Prints a line per file in order, then what failed and a table; throws Failed if anything failed.
void convert_batch(const ConvertArguments& arguments);

}  // namespace bendy::tools
