#pragma once

#include <bendy/format/error.h>
#include <bendy/format/public.h>

#include <cstddef>
#include <vector>

namespace BENDY_PUBLIC bendy {

/// A list of faults, where more than the first is wanted. Keeps at most kMost, so that a hostile file cannot make the
/// list larger than itself, and counts the rest.
class Faults {
public:
    static constexpr std::size_t kMost = 1'000;

    void add(const Error& fault) {
        if (list_.size() < kMost) {
            list_.push_back(fault);
        } else {
            ++left_out_;
        }
    }
    [[nodiscard]] const std::vector<Error>& list() const& { return list_; }
    const std::vector<Error>& list() const&& = delete;  // it would outlive its owner
    [[nodiscard]] std::size_t left_out() const { return left_out_; }
    /// Number of all faults so far, kept or not.
    [[nodiscard]] std::size_t count() const { return list_.size() + left_out_; }
    [[nodiscard]] bool empty() const { return list_.empty(); }

private:
    std::vector<Error> list_;
    std::size_t left_out_ = 0;
};

}  // namespace bendy
