#include "convert/batch.h"
#include "files/output.h"
#include "files/progress.h"
#include "files/signals.h"
#include "reports/conversion.h"
#include "reports/json.h"
#include "reports/messages.h"

#include <bendy/format/diagnostics.h>
#include <bendy/format/file.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <iomanip>
#include <iostream>
#include <map>
#include <mutex>
#include <new>
#include <optional>
#include <set>
#include <shared_mutex>
#include <sstream>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace bendy::tools {
namespace {

using Clock = std::chrono::steady_clock;

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

struct Failure {
    std::filesystem::path file;
    std::string what;
};

/// The outcome for one file.
struct Outcome {
    converter::Report report;
    std::uint64_t size = 0;  ///< of the output
    std::chrono::duration<double> time{0.0};
    std::optional<Failure> failure;
    OrderedJson json;  ///< with --json, for a successful conversion
};

/// The share of a file that is done; updated from any thread. It is outside Batch's lock, to keep progress reports
/// cheap.
struct Share {
    std::atomic<float> done{0.0f};
};

/// Each worker converts one file at a time, so that only the workers' files are in memory.
class Batch {
public:
    Batch(const ConvertArguments& arguments, BatchPlan plan)
        : arguments_(arguments), recipe_(recipe_of(arguments)), plan_(std::move(plan)), bar_("converting") {}

    void run() {
        const Interrupt interrupt;
        for (const BatchProblem& problem : plan_.unread) print_problem(arguments_, problem);
        totals_.failed += plan_.unread.size();
        skip_what_is_up_to_date();
        show_bar();
        const std::size_t jobs = jobs_of(arguments_);
        const std::size_t files = std::max<std::size_t>(to_do_.size(), 1);
        threads_per_file_ = static_cast<unsigned>(std::max<std::size_t>(jobs / files, 1));
        start_workers(std::min(jobs, files));
        wait();
        for (std::thread& worker : workers_) worker.join();
        write_record();
        bar_.clear();
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
        shares_ = std::vector<Share>(to_do_.size());
        for (const BatchFile* file : to_do_) {
            std::error_code unknown;
            const std::uintmax_t size = std::filesystem::file_size(file->input, unknown);
            sizes_.push_back(unknown ? 1.0 : 1.0 + static_cast<double>(size));
        }
    }

    BatchRecord& record_of(const BatchFile& file) {
        return records_.try_emplace(file.folder, file.folder).first->second;
    }

    void start_workers(std::size_t count) {
        try {
            while (workers_.size() < count) workers_.emplace_back([this] { work(); });
        } catch (const std::system_error&) {  // no more threads are available
            if (workers_.empty()) work();
        }
    }

    void work() {
        for (std::size_t next = next_++; next < to_do_.size() && !Interrupt::has_come(); next = next_++) {
            const BatchFile& file = *to_do_[next];
            const Clock::time_point start = Clock::now();
            Outcome outcome;
            std::shared_lock writing(writing_, std::defer_lock);  // held until the written file is recorded
            try {
                outcome.failure = convert(next, outcome, writing);
            } catch (const std::bad_alloc&) {
                outcome.failure = Failure{file.input, "not enough memory"};
            } catch (const std::exception& problem) {
                outcome.failure = Failure{file.input, printable(problem.what())};
            }
            outcome.time = Clock::now() - start;
            shares_[next].done.store(1.0f, std::memory_order_relaxed);
            const std::lock_guard lock(state_);
            ++done_;
            account(file, outcome);
            outcomes_[next] = std::move(outcome);
            print_outcomes();
            finished_.notify_one();
        }
    }

    /// Returns why an existing output must stay: neither this program nor a batch to the same place has written it.
    /// Empty if it may be replaced.
    [[nodiscard]] std::string why_it_stays(const BatchFile& file) {
        std::error_code ignored;
        if (arguments_.force || !std::filesystem::exists(file.output, ignored)) return {};
        std::string problem = why_not_replaced(file.output);
        if (problem.empty()) return {};
        const std::lock_guard lock(state_);
        return record_of(file).knows(file) ? std::string() : problem;
    }

    /// \param writing  is locked before anything is written
    std::optional<Failure> convert(std::size_t number, Outcome& outcome, std::shared_lock<std::shared_mutex>& writing) {
        const BatchFile& file = *to_do_[number];
        if (const std::string problem = why_it_stays(file); !problem.empty()) return Failure{file.output, problem};
        converter::ConvertOptions options = options_of(arguments_);
        options.output = file.output;
        options.threads = threads_per_file_;
        options.progress = [&share = shares_[number]](double done) {
            share.done.store(static_cast<float>(done), std::memory_order_relaxed);
        };
        const auto bytes = converter::convert(file.input, options, outcome.report);
        if (!bytes) return Failure{file_of(bytes.error(), file.input), describe(bytes.error())};
        outcome.size = bytes->size();
        if (arguments_.json) outcome.json = converted_report(file.input, file.output, outcome.report, *bytes);
        writing.lock();
        std::error_code problem;
        if (file.output.has_parent_path()) std::filesystem::create_directories(file.output.parent_path(), problem);
        if (problem) return Failure{file.output.parent_path(), "cannot be made: " + problem.message()};
        const auto identity = identity_of(file.output);
        for (const converter::SourceFile& source : outcome.report.sources()) {
            if (identity && identity_of(source.file) == identity)
                return Failure{file.output, "is an input as well as an output"};
        }
        const auto written = write_file(file.output, *bytes);
        if (!written) return Failure{file.output, bendy::describe(written.error())};
        return std::nullopt;
    }

    /// Requires `state_` to be locked.
    void account(const BatchFile& file, const Outcome& outcome) {
        if (outcome.failure) {
            ++totals_.failed;
            return;
        }
        ++totals_.converted;
        for (const converter::SourceFile& source : outcome.report.sources()) totals_.bytes_in += source.stamp.size;
        totals_.bytes_out += outcome.size;
        record_of(file).note(file, recipe_, outcome.report.sources());
        noted_.insert(file.folder);
    }

    /// Prints the outcomes in the order of the outputs, whichever finished first. Requires `state_` to be locked, so
    /// that the lines about one file stay together.
    void print_outcomes() {
        if (!outcomes_[told_]) return;
        bar_.clear();
        for (; told_ < outcomes_.size() && outcomes_[told_]; ++told_) {
            print(*to_do_[told_], *outcomes_[told_]);
            *outcomes_[told_] = {};  // frees everything except the fact that it is done
        }
        show_bar();
    }

    static void print_failure(const BatchFile& file, const Failure& failure) {
        std::cerr << error_label() << escaped(failure.file.string()) << ": " << printable(failure.what);
        if (failure.file != file.input) std::cerr << " (for " << escaped(file.input.string()) << ')';
        std::cerr << '\n';
    }

    void print(const BatchFile& file, const Outcome& outcome) const {
        if (arguments_.json) {
            if (outcome.failure) print_failure(file, *outcome.failure);
            print_report(outcome.failure ? failed_report(file.input, file.output, outcome.report, outcome.failure->file,
                                                         outcome.failure->what)
                                         : outcome.json);
            std::cout.flush();
            return;
        }
        print_warnings(file.input, outcome.report);
        if (!arguments_.quiet) print_proposals(file.input, outcome.report, arguments_.verbose);
        if (outcome.failure) {
            print_failure(file, *outcome.failure);
        } else if (!arguments_.quiet) {
            std::ostringstream line;
            line << escaped(file.input.string()) << " -> " << escaped(file.output.string()) << "  "
                 << grouped(outcome.size) << " bytes  ";
            if (const std::uint64_t count = outcome.report.warnings().size(); count != 0)
                line << count << (count == 1 ? " warning  " : " warnings  ");
            line << std::fixed << std::setprecision(1) << outcome.time.count() << " s";
            std::cout << line.str() << std::endl;
        }
    }

    void show_bar() {
        if (arguments_.quiet) return;
        const std::chrono::duration<double> passed = Clock::now() - start_;
        std::ostringstream note;
        if (done_ != 0) note << ", " << std::fixed << std::setprecision(1) << rate(passed.count()) << " files/s";
        if (totals_.failed != 0) note << ", " << totals_.failed << " failed";
        note << ", " << clock_text(passed) << time_left_text(share_done(), passed);
        bar_.show(done_, to_do_.size(), note.str());
    }

    /// Returns the fraction of all work that is done, weighted by the sizes of the inputs.
    [[nodiscard]] double share_done() const {
        double done = 0.0;
        double all = 0.0;
        for (std::size_t k = 0; k < sizes_.size(); ++k) {
            done += sizes_[k] * static_cast<double>(shares_[k].done.load(std::memory_order_relaxed));
            all += sizes_[k];
        }
        return all > 0.0 ? done / all : 1.0;
    }

    [[nodiscard]] double rate(double seconds) const { return static_cast<double>(done_) / std::max(seconds, 1e-3); }

    /// Waits until everything is done; after an interrupt, ends the program between two outputs.
    void wait() {
        std::unique_lock lock(state_);
        for (std::size_t turn = 1; done_ < to_do_.size(); ++turn) {
            constexpr auto kPatience = std::chrono::milliseconds(50);
            constexpr std::size_t kTurnsPerFrame = 5;
            finished_.wait_for(lock, kPatience);
            if (Interrupt::has_come()) stop(lock);
            if (turn % kTurnsPerFrame == 0 && bar_.is_terminal()) show_bar();
        }
    }

    /// Waits for writes in progress and records them. No output is written afterwards.
    [[noreturn]] void stop(std::unique_lock<std::mutex>& lock) {
        lock.unlock();  // a thread that writes locks `state_` last
        const std::unique_lock none_writes(writing_);
        lock.lock();
        write_record();
        bar_.clear();
        for (; told_ < outcomes_.size(); ++told_) {
            if (outcomes_[told_]) print(*to_do_[told_], *outcomes_[told_]);
        }
        std::cout.flush();
        std::cerr << "bendy: interrupted: " << totals_.converted << " of " << to_do_.size() << " files converted\n";
        Interrupt::obey();
    }

    void write_record() {
        for (const std::filesystem::path& folder : noted_) {
            const std::string problem = records_.at(folder).write();
            if (!problem.empty())
                warn(folder.empty() ? "." : folder, "the record of conversions cannot be written: " + problem);
        }
    }

    void print_table() const {
        const std::chrono::duration<double> passed = Clock::now() - start_;
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
        std::cout << "\n  time        " << std::fixed << std::setprecision(2) << std::setw(10) << passed.count()
                  << " s\n";
    }

    const ConvertArguments& arguments_;
    const std::string recipe_;
    const BatchPlan plan_;
    const Clock::time_point start_ = Clock::now();
    std::vector<const BatchFile*> to_do_;
    std::vector<double> sizes_;  // of its inputs, in bytes, each plus a little
    std::vector<Share> shares_;
    std::vector<std::thread> workers_;
    unsigned threads_per_file_ = 1;
    std::atomic<std::size_t> next_{0};
    std::shared_mutex writing_;  // shared while an output is written and accounted for; locked before `state_`

    std::mutex state_;  // guards what follows, and the standard streams
    std::condition_variable finished_;
    std::map<std::filesystem::path, BatchRecord> records_;  // by folder
    std::set<std::filesystem::path> noted_;                 // folders whose records need writing
    std::vector<std::optional<Outcome>> outcomes_;          // parallel to to_do_
    std::size_t told_ = 0;                                  // index of the first outcome not yet printed
    ProgressBar bar_;
    Totals totals_;
    std::size_t done_ = 0;
};

}  // namespace

void convert_batch(const ConvertArguments& arguments) {
    BatchPlan plan = plan_batch(arguments.inputs, arguments.output, arguments.rig);
    for (const BatchProblem& clash : plan.clashes) print_problem(arguments, clash);
    if (!plan.clashes.empty()) throw Failed{};
    std::error_code problem;
    if (!arguments.output.empty()) std::filesystem::create_directories(arguments.output, problem);
    if (problem) fail(arguments.output, "cannot be made: " + problem.message());
    Batch(arguments, std::move(plan)).run();
}

}  // namespace bendy::tools
