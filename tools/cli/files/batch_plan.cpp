#include "files/batch_plan.h"

#include "files/input.h"
#include "files/output.h"
#include "reports/messages.h"
#include "reports/suffixes.h"

#include <bendy/converter/source_format.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <system_error>
#include <utility>

namespace bendy::tools {
namespace {

namespace fs = std::filesystem;

/// Returns one path for one file, however the path was written.
fs::path plain(const fs::path& path) {
    std::error_code unknown;
    fs::path canonical = fs::weakly_canonical(path, unknown);
    return unknown ? fs::absolute(path).lexically_normal() : canonical;
}

bool is_folder(const fs::path& path) {
    std::error_code ignored;
    return fs::is_directory(path, ignored);
}

class Planner {
public:
    explicit Planner(const BatchRequest& request) : request_(request) {}

    BatchPlan plan() {
        for (const fs::path& input : request_.inputs) add(input);
        for (const fs::path& file : request_.reads) {
            if (!file.empty()) outputs_.reads(file);
        }
        std::set<fs::path> folders;
        for (const auto& [key, file] : files_) {
            claim(file.input, file.output);
            folders.insert(file.folder);
            plan_.files.push_back(file);
        }
        if (request_.record.empty()) return std::move(plan_);
        for (const fs::path& folder : folders) claim({}, folder / request_.record);
        return std::move(plan_);
    }

private:
    void claim(const fs::path& input, const fs::path& output) {
        if (std::string problem = outputs_.claim(output, NamedBy::user); !problem.empty())
            plan_.clashes.push_back({input, output, std::move(problem)});
    }

    void add(const fs::path& input) {
        const fs::path& folder = request_.folder;
        if (!is_folder(input)) return add_file(input, folder.empty() ? input.parent_path() : folder, input.filename());
        std::string problem;
        const std::vector<fs::path> files = files_in(input, request_.bendy_files_too, problem);
        for (const fs::path& file : files)
            add_file(file, folder.empty() ? input : folder, file.lexically_relative(input));
        if (!problem.empty()) {
            plan_.unread.push_back({input, {}, std::move(problem)});
        } else if (files.empty()) {
            warn(input, "has no file to convert (" + converter::list_readable_suffixes() + ')');
        }
    }

    void add_file(const fs::path& input, const fs::path& folder, fs::path place) {
        place.replace_extension(".bendy");
        const fs::path output = request_.replaces_inputs ? input : folder / place;
        const auto [earlier, is_new] = files_.try_emplace(plain(output), BatchFile{input, folder, place, output});
        if (!is_new && plain(earlier->second.input) != plain(input)) {
            plan_.clashes.push_back({input, output,
                                     "both " + escaped(earlier->second.input.string()) + " and " +
                                         escaped(input.string()) + " would be written there"});
        }
        if (!request_.replaces_inputs) outputs_.reads(input);
    }

    const BatchRequest& request_;
    std::map<fs::path, BatchFile> files_;  // by normalised output
    Outputs outputs_;
    BatchPlan plan_;
};

}  // namespace

bool is_batch(const std::vector<fs::path>& inputs, const fs::path& output) {
    return inputs.size() > 1 || std::any_of(inputs.begin(), inputs.end(), is_folder) ||
           (!output.empty() && (!output.has_filename() || is_folder(output)));
}

void check_batch(const std::vector<fs::path>& inputs, const fs::path& output) {
    if (std::any_of(inputs.begin(), inputs.end(), is_dash))
        throw CLI::ValidationError("-", "standard input must be the only input, and cannot go to a folder");
    if (is_dash(output))
        throw CLI::ValidationError("--output", "several files cannot go to standard output: give a folder");
    if (const auto format = format_named_by(output); !format.empty() && !is_folder(output)) {
        const std::string name = escaped(output.string());
        throw CLI::ValidationError("--output", "several files go to a folder, and " + name + " would be " +
                                                   std::string(format) + "; " + name + "/ is a folder");
    }
}

BatchPlan plan_batch(const BatchRequest& request) {
    return Planner(request).plan();
}

std::vector<fs::path> files_in(const fs::path& folder, bool bendy_files_too, std::string& problem) {
    std::vector<fs::path> files;
    std::error_code error;
    fs::recursive_directory_iterator entry(folder, error);
    for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
        const bool is_wanted =
            converter::has_readable_suffix(entry->path()) || (bendy_files_too && entry->path().extension() == ".bendy");
        if (is_wanted && !is_folder(entry->path())) files.push_back(entry->path());
    }
    if (error) problem = "cannot be read to its end: " + error.message();
    std::sort(files.begin(), files.end());
    return files;
}

void make_output_folder(const fs::path& folder) {
    std::error_code problem;
    if (!folder.empty()) fs::create_directories(folder, problem);
    if (problem) fail(folder, "cannot be made: " + problem.message());
}

}  // namespace bendy::tools
