#include "progress.h"

#include "reports/console.h"
#include "reports/messages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <string_view>
#include <system_error>
#include <utility>

namespace bendy::tools {

std::string clock_text(std::chrono::duration<double> time) {
    constexpr long long kMost = 99LL * 3600;
    const long long seconds = std::llround(std::clamp(time.count(), 0.0, static_cast<double>(kMost)));
    std::array<char, 48> text{};
    if (seconds >= 3600) {
        std::snprintf(text.data(), text.size(), "%lld:%02lld:%02lld", seconds / 3600, seconds / 60 % 60, seconds % 60);
    } else {
        std::snprintf(text.data(), text.size(), "%lld:%02lld", seconds / 60, seconds % 60);
    }
    return text.data();
}

std::string time_left_text(double share, std::chrono::duration<double> passed) {
    constexpr double kLittle = 0.01;  // of the work: too little to predict the rest
    if (share < kLittle || share >= 1.0 || passed < std::chrono::seconds(1)) return {};
    return ", about " + clock_text(passed * ((1.0 - share) / share)) + " left";
}

LiveProgress::LiveProgress(std::string what, bool shows) : what_(std::move(what)) {
    if (!shows || !is_terminal()) return;
    try {
        thread_ = std::thread([this] { show_again_and_again(); });
    } catch (const std::system_error&) {  // no more threads are available: it works silently
    }
}

LiveProgress::~LiveProgress() {
    if (!thread_.joinable()) return;
    {
        const std::lock_guard lock(mutex_);
        has_ended_ = true;
    }
    ended_.notify_one();
    thread_.join();
    std::cerr << "\r\x1b[K" << std::flush;
}

void LiveProgress::set(double share) {
    double before = share_.load(std::memory_order_relaxed);
    while (share > before && !share_.compare_exchange_weak(before, share, std::memory_order_relaxed)) {
    }
}

void LiveProgress::show_again_and_again() {
    constexpr auto kPatience = std::chrono::milliseconds(500);
    constexpr auto kPause = std::chrono::milliseconds(200);
    std::unique_lock lock(mutex_);
    if (ended_.wait_for(lock, kPatience, [this] { return has_ended_; })) return;
    do {
        show();
    } while (!ended_.wait_for(lock, kPause, [this] { return has_ended_; }));
}

void LiveProgress::show() const {
    constexpr std::size_t kWidth = 30;
    constexpr std::size_t kLeastWidth = 5;
    const std::chrono::duration<double> passed = Clock::now() - start_;
    const double share = std::clamp(share_.load(std::memory_order_relaxed), 0.0, 1.0);
    const std::string time = clock_text(passed) + time_left_text(share, passed);
    const std::size_t columns = columns_of(Stream::error);
    const std::size_t most = columns == 0 ? std::string::npos : columns - 1;  // a full line would wrap
    std::string bar;
    if (share > 0.0) {
        std::array<char, 12> percent{};
        std::snprintf(percent.data(), percent.size(), "%3d %%, ", static_cast<int>(100.0 * share));
        constexpr std::string_view kAround = " [] ";
        const std::size_t others = width_of(what_) + kAround.size() + std::strlen(percent.data()) + time.size();
        const std::size_t width = std::min(kWidth, most - std::min(most, others));
        const auto full = static_cast<std::size_t>(static_cast<double>(width) * share);
        if (width >= kLeastWidth) bar = '[' + std::string(full, '#') + std::string(width - full, ' ') + "] ";
        bar += percent.data();
    }
    std::cerr << '\r' << cut_to(what_ + ' ' + bar + time, columns == 0 ? 0 : most) << "\x1b[K" << std::flush;
}

ProgressBar::ProgressBar(std::string what) : what_(std::move(what)), is_terminal_(tools::is_terminal()) {}

ProgressBar::~ProgressBar() {
    clear();
}

void ProgressBar::clear() const {
    if (is_terminal_) std::cerr << "\r\x1b[K" << std::flush;
}

void ProgressBar::show(std::uint64_t done, std::uint64_t all, const std::string& note) {
    if (!is_terminal_) return;
    constexpr std::uint64_t kWidth = 40;
    const std::uint64_t full = kWidth * done / std::max<std::uint64_t>(all, 1);
    std::cerr << '\r' << what_ << " [" << std::string(full, '#') << std::string(kWidth - full, ' ') << "] " << done
              << '/' << all << note << (note.empty() ? "" : "\x1b[K") << std::flush;
}

}  // namespace bendy::tools
