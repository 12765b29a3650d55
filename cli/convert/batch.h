#pragma once

#include "convert/conversion.h"

#include <bendy/converter/report.h>

#include <filesystem>
#include <map>
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

/// What the outputs in a folder were made from and how, kept there in the file .bendy_batch.json. An output is up to
/// date if it, and all that it was made from, are as they were then (size and time), and the recipe is the same. What
/// the record does not know, or cannot be read of it, is made again.
class BatchRecord {
public:
    explicit BatchRecord(const std::filesystem::path& folder);

    /// Where the record of a folder is.
    static std::filesystem::path file_in(const std::filesystem::path& folder);

    /// Whether the output is one that a batch has written here, whatever became of it since.
    [[nodiscard]] bool knows(const BatchFile& file) const;
    [[nodiscard]] bool is_up_to_date(const BatchFile& file, const std::string& recipe) const;
    /// To be called when the output stands where it should.
    void note(const BatchFile& file, const std::string& recipe, const std::vector<converter::SourceFile>& sources);
    /// Nothing if it was written; or why not.
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
    std::map<std::string, Entry> entries_;  ///< by the output's place
};

/// Converts the inputs into the folder that is the output, or each beside itself where none is given, several at a
/// time; only what has changed. Prints a line for each file, in order, what went wrong with which, and a table at the
/// end; throws Failed if there was anything.
void convert_batch(const ConvertArguments& arguments);

}  // namespace bendy::cli
