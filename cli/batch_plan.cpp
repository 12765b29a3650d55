#include "batch_plan.h"

#include "batch_record.h"
#include "output.h"
#include "problem.h"

#include <bendy/converter/source_format.h>

#include <algorithm>
#include <map>
#include <set>
#include <system_error>
#include <utility>

namespace bendy::cli {
namespace {

namespace fs = std::filesystem;

/// A path that is the same for the same file, however it was written.
fs::path plain(const fs::path& path) {
    std::error_code unknown;
    fs::path canonical = fs::weakly_canonical(path, unknown);
    return unknown ? fs::absolute(path).lexically_normal() : canonical;
}

class Planner {
public:
    explicit Planner(fs::path folder) : folder_(std::move(folder)) {}

    void add(const fs::path& input) {
        std::error_code ignored;
        if (fs::is_directory(input, ignored)) {
            add_folder(input);
        } else {
            add_file(input, folder_.empty() ? input.parent_path() : folder_, input.filename());
        }
    }

    BatchPlan finish() {
        std::set<fs::path> folders;
        for (const auto& [key, file] : files_) {
            if (const std::string problem = outputs_.claim(file.output, NamedBy::user); !problem.empty())
                plan_.clashes.push_back({file.input, file.output, problem});
            folders.insert(file.folder);
            plan_.files.push_back(file);
        }
        for (const fs::path& folder : folders) {
            const fs::path record = BatchRecord::file_in(folder);
            if (const std::string problem = outputs_.claim(record, NamedBy::user); !problem.empty())
                plan_.clashes.push_back({{}, record, problem});
        }
        return std::move(plan_);
    }

    void reads(const fs::path& file) { outputs_.reads(file); }

private:
    void add_folder(const fs::path& folder) {
        const std::size_t before = files_.size();
        std::error_code error;
        fs::recursive_directory_iterator entry(folder, error);
        for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
            std::error_code ignored;
            if (converter::has_readable_suffix(entry->path()) && !entry->is_directory(ignored))
                add_file(entry->path(), folder_.empty() ? folder : folder_, entry->path().lexically_relative(folder));
        }
        if (error) {
            plan_.unread.push_back({folder, {}, "cannot be read to its end: " + error.message()});
        } else if (files_.size() == before) {
            warn(folder, "has no file to convert (" + converter::list_readable_suffixes() + ')');
        }
    }

    void add_file(const fs::path& input, const fs::path& folder, fs::path place) {
        place.replace_extension(".bendy");
        const fs::path output = folder / place;
        const auto [earlier, is_new] = files_.try_emplace(plain(output), BatchFile{input, folder, place, output});
        if (!is_new && plain(earlier->second.input) != plain(input)) {
            plan_.clashes.push_back({input, output,
                                     "both " + printable(earlier->second.input.string()) + " and " +
                                         printable(input.string()) + " would be written there"});
        }
        outputs_.reads(input);
    }

    fs::path folder_;
    std::map<fs::path, BatchFile> files_;  // by output, plain
    Outputs outputs_;
    BatchPlan plan_;
};

}  // namespace

BatchPlan plan_batch(const std::vector<fs::path>& inputs, const fs::path& folder, const fs::path& rig) {
    Planner planner(folder);
    for (const fs::path& input : inputs) planner.add(input);
    if (!rig.empty()) planner.reads(rig);
    return planner.finish();
}

}  // namespace bendy::cli
