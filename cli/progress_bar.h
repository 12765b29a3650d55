#pragma once

#include <cstdint>
#include <string>

namespace bendy::cli {

/// A bar on standard error while long work goes on; nothing where that is no terminal.
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
    /// Takes the bar away, so that lines can be printed; the next show() brings it back.
    void clear() const;
    [[nodiscard]] bool is_terminal() const { return is_terminal_; }

private:
    std::string what_;
    bool is_terminal_;
};

}  // namespace bendy::cli
