#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace bendy::motion {

/// Samples of one property: `components` numbers at each time. Rotations are unit quaternions x y z w.
struct Samples {
    std::size_t components = 3;
    bool is_rotation = false;
    std::vector<float> values;

    [[nodiscard]] std::size_t count() const { return values.size() / components; }
    [[nodiscard]] std::span<const float> at(std::size_t k) const {
        return std::span(values).subspan(k * components, components);
    }
};

/// Returns which samples must be keys so that all others are within `bound` of what lies between the keys around them:
/// slerp for rotations, whose bound is an angle in radians; otherwise a straight line, and a bound for each number. One
/// key if all samples are within the bound of the first.
/// \param times  ascending, as many as there are samples, one or more
std::vector<std::size_t> linear_keys(const Samples& samples, std::span<const float> times, double bound);

}  // namespace bendy::motion
