#pragma once

#include "files/progress.h"

#include <bendy/format/byte_reader.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace bendy::tools {

/// Why a job failed.
struct Failure {
    std::filesystem::path file;  ///< empty: the job's input
    std::string what;
};

/// Prints it as an error. \param input  of the job
void print_failure(const std::filesystem::path& input, const Failure& failure);

/// Writes the output of a job, and the folders above it if need be. Fails if it is one of the files that were read.
std::optional<Failure> write_output(const std::filesystem::path& output, Bytes bytes,
                                    std::span<const std::filesystem::path> read);

/// Many jobs, several at a time, whose outcomes are told in their order. Each thread does one job at a time, so that
/// only the files of as many jobs as there are threads are in memory.
class Jobs {
public:
    Jobs(const Jobs&) = delete;
    Jobs& operator=(const Jobs&) = delete;
    Jobs(Jobs&&) = delete;
    Jobs& operator=(Jobs&&) = delete;
    virtual ~Jobs() = default;

protected:
    using WriteLock = std::shared_lock<std::shared_mutex>;
    using Seconds = std::chrono::duration<double>;

    /// \param doing  for the progress bar, as in "converting"
    /// \param shows  whether to show the bar
    Jobs(const std::string& doing, bool shows) : bar_(doing), shows_(shows) {}

    /// Does all jobs and returns; after an interrupt, ends the program between two outputs.
    /// \param inputs   of the jobs, one each: the bar goes by their sizes
    /// \param threads  at most as many as there are jobs are started
    void do_all(const std::vector<std::filesystem::path>& inputs, std::size_t threads);

    /// Does a job, in any thread. \param writing  to be locked before anything is written
    virtual std::optional<Failure> work(std::size_t job, WriteLock& writing) = 0;
    /// Takes the outcome of a job that has just been done. The state is locked, as in all functions that follow.
    virtual void finish(std::size_t job, std::optional<Failure> failure, Seconds time) = 0;
    /// Tells the outcome, in the order of the jobs; nothing else uses the standard streams meanwhile.
    virtual void tell(std::size_t job) = 0;
    /// Is called once before the end, also if the program is about to end by an interrupt.
    virtual void end(bool is_interrupted) = 0;
    /// Returns what the bar says besides the time, as in ", 2 failed".
    [[nodiscard]] virtual std::string note() const { return {}; }

    /// How much of a job is done, 0 to 1; from any thread.
    void set_share(std::size_t job, double done) {
        shares_[job].done.store(static_cast<float>(done), std::memory_order_relaxed);
    }
    [[nodiscard]] std::mutex& state() { return state_; }
    [[nodiscard]] std::size_t done() const { return done_; }
    [[nodiscard]] Seconds passed() const { return Clock::now() - start_; }

private:
    using Clock = std::chrono::steady_clock;
    struct Share {
        std::atomic<float> done{0.0f};
    };

    void start_workers(std::size_t count);
    void work_on();
    void tell_those_done();
    void wait();
    [[noreturn]] void stop(std::unique_lock<std::mutex>& lock);
    void show_bar();
    [[nodiscard]] double share_done() const;

    const Clock::time_point start_ = Clock::now();
    std::vector<double> sizes_;  // of the inputs, in bytes, each plus a little
    std::vector<Share> shares_;
    std::vector<std::thread> workers_;
    std::atomic<std::size_t> next_{0};
    std::shared_mutex writing_;  // shared while an output is written and accounted for; locked before `state_`

    std::mutex state_;  // guards what follows, and the standard streams
    std::condition_variable finished_;
    std::vector<char> is_done_;
    std::size_t told_ = 0, done_ = 0;
    ProgressBar bar_;
    bool shows_;
};

}  // namespace bendy::tools
