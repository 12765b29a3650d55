#pragma once

#include "batch_plan.h"

#include <bendy/converter/report.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace bendy::cli {

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

}  // namespace bendy::cli
