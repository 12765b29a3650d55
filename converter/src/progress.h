#pragma once

#include <functional>

namespace bendy::converter {

/// Is told the part of a work that is done, 0 to 1, and may end it by an exception. May be empty.
using Progress = std::function<void(double)>;

/// Part of a longer work.
inline Progress part_of(const Progress& progress, double from, double to) {
    if (!progress) return {};
    return [=](double done) { progress(from + done * (to - from)); };
}

}  // namespace bendy::converter
