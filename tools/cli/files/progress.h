#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace bendy::tools {

/// "0:05", "12:30", "1:02:03".
std::string clock_text(std::chrono::duration<double> time);

/// Estimates how long the remaining work takes at the current rate: ", about 0:12 left"; empty while it is too early.
std::string time_left_text(double share, std::chrono::duration<double> passed);

/// A line on standard error during one long operation: how much is done, the time so far, and the time left. It appears
/// after half a second, if standard error is a terminal, and moves even while the operation reports nothing.
class LiveProgress {
public:
    /// \param what   as in "converting fox.glb", already escaped for a terminal
    /// \param shows  false: nothing is shown at all
    LiveProgress(std::string what, bool shows);
    LiveProgress(const LiveProgress&) = delete;
    LiveProgress& operator=(const LiveProgress&) = delete;
    LiveProgress(LiveProgress&&) = delete;
    LiveProgress& operator=(LiveProgress&&) = delete;
    /// Removes the line.
    ~LiveProgress();

    /// Sets the fraction that is done, 0 to 1; from any thread. A value below an earlier one is ignored.
    void set(double share);

private:
    using Clock = std::chrono::steady_clock;

    void show_again_and_again();
    void show() const;

    std::string what_;
    Clock::time_point start_ = Clock::now();
    std::atomic<double> share_{0.0};
    std::mutex mutex_;
    std::condition_variable ended_;
    bool has_ended_ = false;
    std::thread thread_;
};

/// A bar on standard error during a long operation; nothing if standard error is not a terminal.
class ProgressBar {
public:
    explicit ProgressBar(std::string what);
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    ProgressBar(ProgressBar&&) = delete;
    ProgressBar& operator=(ProgressBar&&) = delete;
    /// Clears the line.
    ~ProgressBar();

    void show(std::uint64_t done, std::uint64_t all, const std::string& note = {});
    /// Removes the bar, so that lines can be printed; the next show() brings it back.
    void clear() const;
    [[nodiscard]] bool is_terminal() const { return is_terminal_; }

private:
    std::string what_;
    bool is_terminal_;
};

/// A progress bar that appears after a second, and is drawn ten times a second.
class LateProgress {
public:
    explicit LateProgress(std::string what) : bar_(std::move(what)) {}

    /// Returns a callback that takes the bytes done and the bytes in all. It refers to this object.
    std::function<void(std::uint64_t, std::uint64_t)> callback() {
        return [this](std::uint64_t done, std::uint64_t all) { show(done, all); };
    }

private:
    using Clock = std::chrono::steady_clock;

    void show(std::uint64_t done, std::uint64_t all) {
        const Clock::time_point now = Clock::now();
        if (now < next_) return;
        constexpr std::uint64_t kMegabyte = 1'000'000;
        bar_.show(done / kMegabyte, all / kMegabyte);
        next_ = now + std::chrono::milliseconds(100);
    }

    ProgressBar bar_;
    Clock::time_point next_ = Clock::now() + std::chrono::seconds(1);
};

}  // namespace bendy::tools
