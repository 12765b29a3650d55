#pragma once

#include <glm/ext/vector_double3.hpp>

#include <cstddef>
#include <vector>

namespace bendy::edit {

/// A moving average of a motion: the mean over a window centred on each time, which removes what oscillates within it.
/// Beyond its ends the motion goes on: if it repeats, from where it ends; otherwise, and if it does not go the same way
/// at both ends, turned about its end.
class LowPass {
public:
    /// \param places   at least two, evenly spread over the length
    /// \param length   seconds
    /// \param window   seconds, not longer
    /// \param repeats  the motion begins again where it ends
    LowPass(std::vector<glm::dvec3> places, double length, double window, bool repeats);

    /// \param seconds  from the start, 0 to the length
    [[nodiscard]] glm::dvec3 at(double seconds) const;
    /// Returns its change per second.
    [[nodiscard]] glm::dvec3 slope(double seconds) const;

private:
    [[nodiscard]] glm::dvec3 place(double seconds) const;
    [[nodiscard]] glm::dvec3 integral(double seconds) const;
    [[nodiscard]] glm::dvec3 place_inside(double seconds) const;
    [[nodiscard]] glm::dvec3 integral_inside(double seconds) const;

    std::vector<glm::dvec3> places_, sums_;  ///< sums: integrals from the start
    double length_, window_, step_;
    bool repeats_ = false;
};

}  // namespace bendy::edit
