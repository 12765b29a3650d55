#pragma once

#include "files/batch_plan.h"
#include "reports/conversion.h"

#include <bendy/converter/report.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace bendy::tools {

/// Records what the outputs in a folder were made from and how, in the folder's file .bendy_batch.json. An output is up
/// to date if it and all its sources have the recorded sizes and times, and the recipe is the same. Outputs that the
/// record does not know, or all if it cannot be read, are converted again.
class BatchRecord {
public:
    explicit BatchRecord(const std::filesystem::path& folder);

    static constexpr const char* kName = ".bendy_batch.json";

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
