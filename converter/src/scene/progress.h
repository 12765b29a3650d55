#pragma once

#include <functional>

namespace bendy::converter {

/// Called with the fraction of a task that is done, 0 to 1; may abort it by throwing. May be empty.
using Progress = std::function<void(double)>;

/// The progress of a part of a larger task.
inline Progress part_of(const Progress& progress, double from, double to) {
    if (!progress) return {};
    return [=](double done) { progress(from + done * (to - from)); };
}

}  // namespace bendy::converter
