#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace bendy {

/// The joints whose matrices may be out of date: all, or those of some subtrees.
class StaleJoints {
public:
    /// A joint and all below it: their numbers are consecutive.
    struct Subtree {
        std::uint32_t joint, end;
        [[nodiscard]] bool has(std::uint32_t other) const { return joint <= other && other < end; }
    };

    void mark_all() { are_all_ = true; }
    void mark(const Subtree& subtree) {
        if (has(subtree.joint)) return;
        if (count_ == subtrees_.size()) return mark_all();
        subtrees_[count_++] = subtree;
    }
    void clear() {
        are_all_ = false;
        count_ = 0;
    }

    [[nodiscard]] bool is_empty() const { return !are_all_ && count_ == 0; }
    [[nodiscard]] bool are_all() const { return are_all_; }
    [[nodiscard]] bool has(std::uint32_t joint) const {
        return are_all_ || std::any_of(subtrees_.begin(), subtrees_.begin() + count_,
                                       [joint](const Subtree& subtree) { return subtree.has(joint); });
    }
    /// If they are not all. A later one may contain an earlier one.
    [[nodiscard]] std::span<const Subtree> subtrees() const { return std::span(subtrees_).first(count_); }

private:
    std::array<Subtree, 8> subtrees_{};
    std::uint32_t count_ = 0;
    bool are_all_ = true;
};

}  // namespace bendy
