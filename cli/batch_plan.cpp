#include "batch_plan.h"

#include "output.h"
#include "problem.h"

#include <bendy/converter/readable_files.h>

#include <algorithm>
#include <map>
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
            add_file(input, input.filename());
        }
    }

    BatchPlan finish(const fs::path& record) {
        if (const std::string problem = outputs_.claim(record, NamedBy::user); !problem.empty())
            plan_.clashes.push_back({{}, record, problem});
        for (const auto& [place, input] : inputs_) {
            const fs::path output = folder_ / place;
            if (const std::string problem = outputs_.claim(output, NamedBy::user); !problem.empty())
                plan_.clashes.push_back({input, output, problem});
            plan_.files.push_back({input, place, output});
        }
        return std::move(plan_);
    }

    void reads(const fs::path& file) { outputs_.reads(file); }

private:
    void add_folder(const fs::path& folder) {
        const std::size_t before = inputs_.size();
        std::error_code error;
        fs::recursive_directory_iterator entry(folder, error);
        for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
            std::error_code ignored;
            if (converter::has_readable_extension(entry->path()) && !entry->is_directory(ignored))
                add_file(entry->path(), entry->path().lexically_relative(folder));
        }
        if (error) {
            plan_.unread.push_back({folder, {}, "cannot be read to its end: " + error.message()});
        } else if (inputs_.size() == before) {
            warn(folder, "has no file to convert (" + converter::list_readable_extensions() + ')');
        }
    }

    void add_file(const fs::path& input, fs::path place) {
        place.replace_extension(".bendy");
        const auto [earlier, is_new] = inputs_.try_emplace(place, input);
        if (!is_new && plain(earlier->second) != plain(input)) {
            plan_.clashes.push_back({input, folder_ / place,
                                     "both " + printable(earlier->second.string()) + " and " +
                                         printable(input.string()) + " would be written there"});
        }
        outputs_.reads(input);
    }

    fs::path folder_;
    std::map<fs::path, fs::path> inputs_;  // by the output's place
    Outputs outputs_;
    BatchPlan plan_;
};

}  // namespace

BatchPlan plan_batch(const std::vector<fs::path>& inputs, const fs::path& folder, const fs::path& record,
                     const fs::path& rig) {
    Planner planner(folder);
    for (const fs::path& input : inputs) planner.add(input);
    if (!rig.empty()) planner.reads(rig);
    return planner.finish(record);
}

}  // namespace bendy::cli
