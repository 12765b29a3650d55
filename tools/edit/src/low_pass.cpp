#include "low_pass.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace bendy::edit {

namespace {

constexpr double kSameWay = 0.1;  // of the ways in the first and the last window of a motion that repeats
constexpr double kNoWay = 0.001;  // metres

}  // namespace

LowPass::LowPass(std::vector<glm::dvec3> places, double length, double window, bool repeats)
    : places_(std::move(places)),
      length_(length),
      window_(window),
      step_(length / static_cast<double>(places_.size() - 1)) {
    const glm::dvec3 first = place_inside(window) - places_.front(),
                     last = places_.back() - place_inside(length - window);
    repeats_ = repeats && glm::length(first - last) <= kSameWay * (glm::length(first) + glm::length(last)) + kNoWay;
    sums_.emplace_back(0.0);
    for (std::size_t k = 1; k < places_.size(); ++k)
        sums_.push_back(sums_.back() + 0.5 * step_ * (places_[k - 1] + places_[k]));
}

glm::dvec3 LowPass::at(double seconds) const {
    return (integral(seconds + 0.5 * window_) - integral(seconds - 0.5 * window_)) / window_;
}

glm::dvec3 LowPass::slope(double seconds) const {
    return (place(seconds + 0.5 * window_) - place(seconds - 0.5 * window_)) / window_;
}

glm::dvec3 LowPass::place(double seconds) const {
    if (repeats_) {
        const double turns = std::floor(seconds / length_);
        return place_inside(seconds - turns * length_) + turns * (places_.back() - places_.front());
    }
    if (seconds < 0.0) return 2.0 * places_.front() - place_inside(-seconds);
    if (seconds > length_) return 2.0 * places_.back() - place_inside(2.0 * length_ - seconds);
    return place_inside(seconds);
}

glm::dvec3 LowPass::integral(double seconds) const {
    if (repeats_) {
        const double turns = std::floor(seconds / length_), rest = seconds - turns * length_;
        const glm::dvec3 way = places_.back() - places_.front();
        return turns * sums_.back() + 0.5 * turns * (turns - 1.0) * length_ * way + integral_inside(rest) +
               turns * rest * way;
    }
    if (seconds < 0.0) return integral_inside(-seconds) + 2.0 * seconds * places_.front();
    if (seconds > length_) {
        const double beyond = seconds - length_;
        return integral_inside(length_ - beyond) + 2.0 * beyond * places_.back();
    }
    return integral_inside(seconds);
}

glm::dvec3 LowPass::place_inside(double seconds) const {
    const double at = std::clamp(seconds / step_, 0.0, static_cast<double>(places_.size() - 1));
    const std::size_t k = std::min(static_cast<std::size_t>(at), places_.size() - 2);
    const double share = at - static_cast<double>(k);
    return (1.0 - share) * places_[k] + share * places_[k + 1];
}

glm::dvec3 LowPass::integral_inside(double seconds) const {
    const double at = std::clamp(seconds / step_, 0.0, static_cast<double>(places_.size() - 1));
    const std::size_t k = std::min(static_cast<std::size_t>(at), places_.size() - 2);
    const double share = at - static_cast<double>(k);
    return sums_[k] + step_ * share * (places_[k] + 0.5 * share * (places_[k + 1] - places_[k]));
}

}  // namespace bendy::edit
