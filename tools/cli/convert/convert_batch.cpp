#include "convert/batch.h"
#include "files/jobs.h"
#include "files/output.h"
#include "reports/conversion.h"
#include "reports/json.h"
#include "reports/messages.h"

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

namespace bendy::tools {
namespace {

struct Totals {
    std::uint64_t converted = 0;
    std::uint64_t up_to_date = 0;
    std::uint64_t failed = 0;
    std::uint64_t bytes_in = 0;   ///< of the files read for those that are converted
    std::uint64_t bytes_out = 0;  ///< of the same
};

void print_problem(const ConvertArguments& arguments, const BatchProblem& problem) {
    const std::filesystem::path& file = problem.output.empty() ? problem.input : problem.output;
    std::cerr << error_label() << escaped(file.string()) << ": " << printable(problem.what) << '\n';
    if (arguments.json) print_report(failed_report(problem.input, problem.output, {}, file, problem.what));
}

/// The outcome for one file.
struct Outcome {
    converter::Report report;
    std::uint64_t size = 0;  ///< of the output
    double seconds = 0.0;
    std::optional<Failure> failure;
    OrderedJson json;  ///< with --json, for a successful conversion
};

class Batch : Jobs {
public:
    Batch(const ConvertArguments& arguments, BatchPlan plan)
        : Jobs("converting", !arguments.quiet),
          arguments_(arguments),
          recipe_(recipe_of(arguments)),
          plan_(std::move(plan)) {}

    void run() {
        for (const BatchProblem& problem : plan_.unread) print_problem(arguments_, problem);
        totals_.failed += plan_.unread.size();
        skip_what_is_up_to_date();
        std::vector<std::filesystem::path> inputs;
        for (const BatchFile* file : to_do_) inputs.push_back(file->input);
        const std::size_t jobs = jobs_of(arguments_.jobs);
        threads_per_file_ =
            static_cast<unsigned>(std::max<std::size_t>(jobs / std::max<std::size_t>(inputs.size(), 1), 1));
        do_all(inputs, jobs);
        if (!arguments_.quiet && !arguments_.json) print_table();
        if (totals_.failed != 0) throw Failed{};
    }

private:
    void skip_what_is_up_to_date() {
        for (const BatchFile& file : plan_.files) {
            if (!arguments_.force && record_of(file).is_up_to_date(file, recipe_)) {
                ++totals_.up_to_date;
                if (arguments_.json) print_report(up_to_date_report(file.input, file.output));
            } else {
                to_do_.push_back(&file);
            }
        }
        outcomes_.resize(to_do_.size());
    }

    BatchRecord& record_of(const BatchFile& file) {
        return records_.try_emplace(file.folder, file.folder).first->second;
    }

    /// Returns why an existing output must stay: neither this program nor a batch to the same place has written it.
    /// Empty if it may be replaced.
    [[nodiscard]] std::string why_it_stays(const BatchFile& file) {
        std::error_code ignored;
        if (arguments_.force || !std::filesystem::exists(file.output, ignored)) return {};
        std::string problem = why_not_replaced(file.output);
        if (problem.empty()) return {};
        const std::lock_guard lock(state());
        return record_of(file).knows(file) ? std::string() : problem;
    }

    std::optional<Failure> work(std::size_t job, WriteLock& writing) override {
        Outcome& outcome = outcomes_[job];
        const BatchFile& file = *to_do_[job];
        if (const std::string problem = why_it_stays(file); !problem.empty()) return Failure{file.output, problem};
        converter::ConvertOptions options = options_of(arguments_);
        options.output = file.output;
        options.threads = threads_per_file_;
        options.progress = [this, job](double done) { set_share(job, done); };
        const auto bytes = converter::convert(file.input, options, outcome.report);
        if (!bytes) return Failure{file_of(bytes.error(), file.input), describe(bytes.error())};
        outcome.size = bytes->size();
        if (arguments_.json) outcome.json = converted_report(file.input, file.output, outcome.report, *bytes);
        std::vector<std::filesystem::path> sources;
        for (const converter::SourceFile& source : outcome.report.sources()) sources.push_back(source.file);
        writing.lock();
        return write_output(file.output, *bytes, sources);
    }

    void finish(std::size_t job, std::optional<Failure> failure, Seconds time) override {
        const BatchFile& file = *to_do_[job];
        Outcome& outcome = outcomes_[job];
        outcome.seconds = time.count();
        outcome.failure = std::move(failure);
        if (outcome.failure) {
            if (outcome.failure->file.empty()) outcome.failure->file = file.input;
            ++totals_.failed;
            return;
        }
        ++totals_.converted;
        for (const converter::SourceFile& source : outcome.report.sources()) totals_.bytes_in += source.stamp.size;
        totals_.bytes_out += outcome.size;
        record_of(file).note(file, recipe_, outcome.report.sources());
        noted_.insert(file.folder);
    }

    void tell(std::size_t job) override {
        print(*to_do_[job], outcomes_[job]);
        outcomes_[job] = {};  // frees the memory
    }

    [[nodiscard]] std::string note() const override {
        return totals_.failed == 0 ? std::string() : ", " + std::to_string(totals_.failed) + " failed";
    }

    void end(bool is_interrupted) override {
        write_record();
        if (!is_interrupted) return;
        std::cout.flush();
        std::cerr << "bendy: interrupted: " << totals_.converted << " of " << to_do_.size() << " files converted\n";
    }

    void print(const BatchFile& file, const Outcome& outcome) const {
        if (arguments_.json) {
            if (outcome.failure) print_failure(file.input, *outcome.failure);
            print_report(outcome.failure ? failed_report(file.input, file.output, outcome.report, outcome.failure->file,
                                                         outcome.failure->what)
                                         : outcome.json);
            std::cout.flush();
            return;
        }
        print_warnings(file.input, outcome.report);
        if (!arguments_.quiet) print_proposals(file.input, outcome.report, arguments_.verbose);
        if (outcome.failure) {
            print_failure(file.input, *outcome.failure);
        } else if (!arguments_.quiet) {
            std::ostringstream line;
            line << escaped(file.input.string()) << " -> " << escaped(file.output.string()) << "  "
                 << grouped(outcome.size) << " bytes  ";
            if (const std::uint64_t count = outcome.report.warnings().size(); count != 0)
                line << count << (count == 1 ? " warning  " : " warnings  ");
            line << std::fixed << std::setprecision(1) << outcome.seconds << " s";
            std::cout << line.str() << std::endl;
        }
    }

    void write_record() {
        for (const std::filesystem::path& folder : noted_) {
            const std::string problem = records_.at(folder).write();
            if (!problem.empty())
                warn(folder.empty() ? "." : folder, "the record of conversions cannot be written: " + problem);
        }
    }

    void print_table() const {
        const auto line = [](std::string_view what, std::uint64_t count) {
            std::cout << "  " << std::left << std::setw(12) << what << std::right << std::setw(10) << grouped(count);
        };
        line("files", plan_.files.size());
        std::cout << '\n';
        line("converted", totals_.converted);
        if (totals_.converted != 0) {
            std::cout << "  " << grouped(totals_.bytes_in) << " bytes read, " << grouped(totals_.bytes_out)
                      << " written";
        }
        std::cout << '\n';
        line("up to date", totals_.up_to_date);
        std::cout << '\n';
        line("failed", totals_.failed);
        std::cout << "\n  time        " << std::fixed << std::setprecision(2) << std::setw(10) << passed().count()
                  << " s\n";
    }

    const ConvertArguments& arguments_;
    const std::string recipe_;
    const BatchPlan plan_;
    std::vector<const BatchFile*> to_do_;
    unsigned threads_per_file_ = 1;
    std::vector<Outcome> outcomes_;  // parallel to to_do_
    // The state of Jobs guards what follows.
    std::map<std::filesystem::path, BatchRecord> records_;  // by folder
    std::set<std::filesystem::path> noted_;                 // folders whose records need writing
    Totals totals_;
};

}  // namespace

void convert_batch(const ConvertArguments& arguments) {
    BatchPlan plan =
        plan_batch({arguments.inputs, arguments.output, {arguments.rig}, false, false, BatchRecord::kName});
    for (const BatchProblem& clash : plan.clashes) print_problem(arguments, clash);
    if (!plan.clashes.empty()) throw Failed{};
    make_output_folder(arguments.output);
    Batch(arguments, std::move(plan)).run();
}

}  // namespace bendy::tools
