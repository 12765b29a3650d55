#include "convert_batch.h"

#include "batch_plan.h"
#include "batch_record.h"
#include "import_problem.h"
#include "interrupt.h"
#include "problem.h"
#include "progress_bar.h"
#include "warnings.h"

#include <bendy/format/diagnostics.h>
#include <bendy/format/file.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <iomanip>
#include <iostream>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <sstream>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace bendy::cli {
namespace {

using Clock = std::chrono::steady_clock;

struct Totals {
    std::uint64_t converted = 0;
    std::uint64_t up_to_date = 0;
    std::uint64_t failed = 0;
    std::uint64_t bytes_in = 0;   ///< of the files that were read for those that are converted
    std::uint64_t bytes_out = 0;  ///< of the same
};

struct Failure {
    std::filesystem::path file;
    std::string what;
};

/// Workers take one file each at a time: no more is in memory than their files.
class Batch {
public:
    Batch(const ConvertArguments& arguments, BatchPlan plan)
        : arguments_(arguments),
          recipe_(recipe_of(arguments)),
          plan_(std::move(plan)),
          record_(arguments.output),
          bar_("converting") {}

    void run() {
        const Interrupt interrupt;
        for (const std::string& what : plan_.unread) {
            std::cerr << "bendy: error: " << printable(what) << '\n';
            ++totals_.failed;
        }
        skip_what_is_up_to_date();
        show_bar();
        const std::size_t wanted = arguments_.jobs != 0 ? arguments_.jobs : std::thread::hardware_concurrency();
        start_workers(std::clamp<std::size_t>(wanted, 1, std::max<std::size_t>(to_do_.size(), 1)));
        wait();
        for (std::thread& worker : workers_) worker.join();
        write_record();
        bar_.clear();
        if (!arguments_.quiet) print_table();
        if (totals_.failed != 0) throw Failed{};
    }

private:
    void skip_what_is_up_to_date() {
        for (const BatchFile& file : plan_.files) {
            if (!arguments_.force && record_.is_up_to_date(file, recipe_)) {
                ++totals_.up_to_date;
            } else {
                to_do_.push_back(&file);
            }
        }
    }

    void start_workers(std::size_t count) {
        try {
            while (workers_.size() < count) workers_.emplace_back([this] { work(); });
        } catch (const std::system_error&) {  // no more threads are to be had
            if (workers_.empty()) work();
        }
    }

    void work() {
        for (std::size_t next = next_++; next < to_do_.size() && !Interrupt::has_come(); next = next_++) {
            const BatchFile& file = *to_do_[next];
            converter::Report report;
            std::uint64_t size = 0;
            std::optional<Failure> failure;
            try {
                failure = convert(file, report, size);
            } catch (const std::exception& problem) {
                failure = Failure{file.input, problem.what()};
            }
            const std::lock_guard lock(state_);
            ++done_;
            account(file, report, size, failure);
            finished_.notify_one();
        }
    }

    /// Converts one file and writes it; `size` becomes that of the output.
    std::optional<Failure> convert(const BatchFile& file, converter::Report& report, std::uint64_t& size) {
        converter::ConvertOptions options = options_of(arguments_);
        options.output = file.output;
        const auto bytes = converter::convert(file.input, options, report);
        if (!bytes) return Failure{file_of(bytes.error(), file.input), describe(bytes.error())};
        size = bytes->size();
        const std::shared_lock writing(writing_);
        std::error_code problem;
        std::filesystem::create_directories(file.output.parent_path(), problem);
        if (problem) return Failure{file.output.parent_path(), "cannot be made: " + problem.message()};
        if (std::filesystem::equivalent(file.input, file.output, problem))
            return Failure{file.output, "is the input itself"};
        const auto written = write_file(file.output, *bytes);
        if (!written) return Failure{file.output, bendy::describe(written.error())};
        return std::nullopt;
    }

    /// Says how it went with a file. `state_` is held: what is said of one file stands together.
    void account(const BatchFile& file, const converter::Report& report, std::uint64_t size,
                 const std::optional<Failure>& failure) {
        bar_.clear();
        print_warnings(file.input, report);
        for (const std::string& line : report.proposals())
            std::cerr << "bendy: proposed: " << printable(file.input.string()) << ": " << printable(line) << '\n';
        if (failure) {
            ++totals_.failed;
            std::cerr << "bendy: error: " << printable(failure->file.string()) << ": " << failure->what;
            if (failure->file != file.input) std::cerr << " (for " << printable(file.input.string()) << ')';
            std::cerr << '\n';
        } else {
            ++totals_.converted;
            for (const converter::SourceFile& source : report.sources()) totals_.bytes_in += source.stamp.size;
            totals_.bytes_out += size;
            record_.note(file, recipe_, report.sources());
            if (!arguments_.quiet && !bar_.is_terminal()) {
                std::cout << printable(file.input.string()) << " -> " << printable(file.output.string()) << ": "
                          << grouped(size) << " bytes" << std::endl;
            }
        }
        show_bar();
    }

    void show_bar() {
        if (arguments_.quiet) return;
        const std::chrono::duration<double> passed = Clock::now() - start_;
        std::ostringstream note;
        if (done_ != 0) note << ", " << std::fixed << std::setprecision(1) << rate(passed.count()) << " files/s";
        if (totals_.failed != 0) note << ", " << totals_.failed << " failed";
        bar_.show(done_, to_do_.size(), note.str());
    }

    [[nodiscard]] double rate(double seconds) const { return static_cast<double>(done_) / std::max(seconds, 1e-3); }

    /// Until all is done; or, after an interrupt, ends the program between two outputs.
    void wait() {
        std::unique_lock lock(state_);
        while (done_ < to_do_.size()) {
            constexpr auto kPatience = std::chrono::milliseconds(50);
            finished_.wait_for(lock, kPatience);
            if (Interrupt::has_come()) stop();
        }
    }

    /// `state_` is held; who writes does not wait for it.
    [[noreturn]] void stop() {
        const std::unique_lock none_writes(writing_);
        write_record();
        bar_.clear();
        std::cout.flush();
        std::cerr << "bendy: interrupted: " << totals_.converted << " of " << to_do_.size() << " files converted\n";
        Interrupt::obey();
    }

    void write_record() {
        if (totals_.converted == 0) return;
        const std::string problem = record_.write();
        if (!problem.empty()) warn(arguments_.output, "what was done cannot be noted: " + problem);
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
    std::vector<std::thread> workers_;
    std::atomic<std::size_t> next_{0};
    std::shared_mutex writing_;  // shared while an output is written

    std::mutex state_;  // guards what follows, and the output streams
    std::condition_variable finished_;
    BatchRecord record_;
    ProgressBar bar_;
    Totals totals_;
    std::size_t done_ = 0;
};

}  // namespace

void convert_batch(const ConvertArguments& arguments) {
    BatchPlan plan = plan_batch(arguments.inputs, arguments.output);
    std::error_code problem;
    std::filesystem::create_directories(arguments.output, problem);
    if (problem) fail(arguments.output, "cannot be made: " + problem.message());
    Batch(arguments, std::move(plan)).run();
}

}  // namespace bendy::cli
