#pragma once

#include <bendy/format/records.h>

#include <string>

namespace bendy::edit {

/// The difference between two rest transforms.
struct RestDifference {
    double metres = 0.0;
    double degrees = 0.0;
    double scale = 0.0;  ///< the largest factor by which a scale differs, minus 1

    /// True if it is more than rounding.
    [[nodiscard]] bool is_noticeable() const;
    /// For finding the largest: a degree, a centimetre and a hundredth of scale count the same.
    [[nodiscard]] double weight() const { return metres * 100.0 + degrees + scale * 100.0; }
};

RestDifference rest_difference(const RestRecord& a, const RestRecord& b);
/// Returns "moved by 12 mm, turned by 3.1 degrees".
std::string describe(const RestDifference& difference);

}  // namespace bendy::edit
