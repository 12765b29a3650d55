#pragma once

#include "failure.h"

#include <cstdint>

namespace bendy::converter {

/// Bounds the work of matching: a small hostile file can set any number of globs against any number of joints.
class Effort {
public:
    static constexpr std::uint64_t kMost = 400'000'000;  ///< steps: a character compared is one

    /// Counts `steps`, or fails with an empty place.
    void take(std::uint64_t steps) {
        if (steps > left_) fail({}, "its keys, chains and weights take too long to match with so many joints");
        left_ -= steps;
    }

private:
    std::uint64_t left_ = kMost;
};

}  // namespace bendy::converter
