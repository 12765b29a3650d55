#include "progress_bar.h"

#include "console.h"

#include <algorithm>
#include <iostream>

namespace bendy::cli {

ProgressBar::ProgressBar(std::string what) : what_(std::move(what)), is_terminal_(cli::is_terminal()) {}

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

}  // namespace bendy::cli
