#pragma once

#include "progress_bar.h"

#include <chrono>
#include <functional>
#include <string>

namespace bendy::cli {

/// A progress bar that comes up when the work has gone on for a second, and is drawn ten times a second.
class LateProgress {
public:
    explicit LateProgress(std::string what) : bar_(std::move(what)) {}

    /// To be called with what is done and all of it, in bytes. Refers to this object.
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

}  // namespace bendy::cli
