#include "files/jobs.h"

#include "files/output.h"
#include "files/signals.h"
#include "reports/messages.h"

#include <bendy/format/diagnostics.h>
#include <bendy/format/file.h>

#include <algorithm>
#include <exception>
#include <iomanip>
#include <iostream>
#include <new>
#include <sstream>
#include <system_error>
#include <utility>

namespace bendy::tools {

void print_failure(const std::filesystem::path& input, const Failure& failure) {
    std::cerr << error_label() << escaped(failure.file.string()) << ": " << printable(failure.what);
    if (failure.file != input) std::cerr << " (for " << escaped(input.string()) << ')';
    std::cerr << '\n';
}

std::optional<Failure> write_output(const std::filesystem::path& output, Bytes bytes,
                                    std::span<const std::filesystem::path> read) {
    std::error_code problem;
    if (output.has_parent_path()) std::filesystem::create_directories(output.parent_path(), problem);
    if (problem) return Failure{output.parent_path(), "cannot be made: " + problem.message()};
    const auto identity = identity_of(output);
    for (const std::filesystem::path& file : read) {
        if (identity && identity_of(file) == identity) return Failure{output, "is an input as well as an output"};
    }
    const auto written = write_file(output, bytes);
    if (!written) return Failure{output, bendy::describe(written.error())};
    return std::nullopt;
}

void Jobs::do_all(const std::vector<std::filesystem::path>& inputs, std::size_t threads) {
    const Interrupt interrupt;
    for (const std::filesystem::path& input : inputs) {
        std::error_code unknown;
        const std::uintmax_t size = std::filesystem::file_size(input, unknown);
        sizes_.push_back(unknown ? 1.0 : 1.0 + static_cast<double>(size));
    }
    shares_ = std::vector<Share>(inputs.size());
    is_done_.resize(inputs.size());
    show_bar();
    start_workers(std::clamp<std::size_t>(threads, 1, std::max<std::size_t>(inputs.size(), 1)));
    wait();
    for (std::thread& worker : workers_) worker.join();
    end(false);
    bar_.clear();
}

void Jobs::start_workers(std::size_t count) {
    try {
        while (workers_.size() < count) workers_.emplace_back([this] { work_on(); });
    } catch (const std::system_error&) {  // no more threads are available
        if (workers_.empty()) work_on();
    }
}

void Jobs::work_on() {
    for (std::size_t job = next_++; job < sizes_.size() && !Interrupt::has_come(); job = next_++) {
        const Clock::time_point start = Clock::now();
        std::optional<Failure> failure;
        WriteLock writing(writing_, std::defer_lock);  // held until the written file is accounted for
        try {
            failure = work(job, writing);
        } catch (const std::bad_alloc&) {
            failure = Failure{{}, "not enough memory"};
        } catch (const std::exception& problem) {
            failure = Failure{{}, printable(problem.what())};
        }
        const Seconds time = Clock::now() - start;
        set_share(job, 1.0);
        const std::lock_guard lock(state_);
        ++done_;
        finish(job, std::move(failure), time);
        is_done_[job] = 1;
        tell_those_done();
        finished_.notify_one();
    }
}

void Jobs::tell_those_done() {
    if (is_done_[told_] == 0) return;
    bar_.clear();
    for (; told_ < is_done_.size() && is_done_[told_] != 0; ++told_) tell(told_);
    show_bar();
}

void Jobs::wait() {
    std::unique_lock lock(state_);
    for (std::size_t turn = 1; done_ < sizes_.size(); ++turn) {
        constexpr auto kPatience = std::chrono::milliseconds(50);
        constexpr std::size_t kTurnsPerFrame = 5;
        finished_.wait_for(lock, kPatience);
        if (Interrupt::has_come()) stop(lock);
        if (turn % kTurnsPerFrame == 0 && bar_.is_terminal()) show_bar();
    }
}

/// Waits for writes in progress and accounts for them. No output is written afterwards.
void Jobs::stop(std::unique_lock<std::mutex>& lock) {
    lock.unlock();  // a thread that writes locks `state_` last
    const std::unique_lock none_writes(writing_);
    lock.lock();
    bar_.clear();
    for (; told_ < is_done_.size(); ++told_) {
        if (is_done_[told_] != 0) tell(told_);
    }
    end(true);
    std::cout.flush();
    Interrupt::obey();
}

void Jobs::show_bar() {
    if (!shows_) return;
    std::ostringstream text;
    const double seconds = passed().count();
    if (done_ != 0) {
        text << ", " << std::fixed << std::setprecision(1) << static_cast<double>(done_) / std::max(seconds, 1e-3)
             << " files/s";
    }
    text << note() << ", " << clock_text(passed()) << time_left_text(share_done(), passed());
    bar_.show(done_, sizes_.size(), text.str());
}

/// Returns the fraction of all work that is done, weighted by the sizes of the inputs.
double Jobs::share_done() const {
    double done = 0.0;
    double all = 0.0;
    for (std::size_t k = 0; k < sizes_.size(); ++k) {
        done += sizes_[k] * static_cast<double>(shares_[k].done.load(std::memory_order_relaxed));
        all += sizes_[k];
    }
    return all > 0.0 ? done / all : 1.0;
}

}  // namespace bendy::tools
