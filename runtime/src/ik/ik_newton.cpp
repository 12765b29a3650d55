#include "damped_step.h"
#include "ik_problem.h"
#include "math/rotation.h"

#include <bendy/format/trig.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

// Newton's method in the coordinates in which limits are intervals: a projected Newton method with an active set
// (Bertsekas, "Projected Newton methods for optimization problems with simple constraints", 1982), damped as Levenberg
// and Marquardt do. A number that is at its limit and would leave it is fixed for a step; a swing at the edge of its
// ellipse moves along it. The Hessian holds the bend of the tip's path, so that it converges as quickly towards a
// target out of reach, which it only comes near.
//
// A target does not determine everything. Springs keep the rest close to the incoming pose: they pull each joint back
// to where it was, harder if it has less freedom, and are loosened from step to step. The result is then a continuous
// function of the pose and the target, except where two poses are equally near.
namespace bendy {
namespace {

constexpr std::size_t kMostNumbers = 3 * kMostNewtonLinks;
using HessianRow = std::array<double, kMostNumbers>;

class Newton {
public:
    Newton(IkProblem& problem, std::uint32_t most) : problem_(problem), most_(most), links_(problem.links.size()) {
        while (!problem.has_rotation && links_ > 0 && problem.links[links_ - 1].bone_length == 0.0) --links_;
    }

    /// See solve_newton.
    std::uint32_t run(bool is_first) {
        for (IkLink& link : problem_.links.first(links_)) link.chart.read(link, link.local);
        if (problem_.is_reached() && !problem_.stays_close) return 0;
        constexpr double kStiff = 3.0, kClose = 1e-3;
        constexpr std::uint32_t kFew = 16;
        const double looser = !is_first ? 0.1 : most_ < kFew ? 0.03 : 0.5;
        constexpr double kSettled = 1e-3;  // radians
        at_ = measure();
        const double off = at_.cost;
        // Weaker, the nearer the target is.
        spring_ = std::max(at_.last_spring(), std::min(kStiff, (is_first ? 3.0 : 0.3) * off * std::sqrt(off)));
        if (problem_.stays_close) spring_ = kClose;
        while (tried_ < most_) {
            linearise();
            const double largest = descend();
            const double last = at_.last_spring();
            if (spring_ > last) {
                spring_ = std::max(last, spring_ * looser);
            } else if (largest < kSmall || (problem_.is_reached() && largest < kSettled)) {
                break;
            }
        }
        return tried_;
    }

private:
    static constexpr double kSmall = 1e-5;  ///< radians

    [[nodiscard]] Measured measure() const { return measured(problem_.links.first(links_), problem_.cost()); }

    /// Takes a step that improves the objective, damped as much as that needs; returns its largest turn in radians.
    double descend() {
        constexpr double kFirst = 1e-3, kLargest = 1e3;
        bool is_whole = true;
        fill(true);
        for (;;) {
            if (!find_step(is_whole)) {
                is_whole = false;
                fill(false);
                (void)find_step(false);
            }
            const double largest = take_step();
            const Measured now = measure();
            ++tried_;
            if (now.objective(spring_) < at_.objective(spring_)) {
                at_ = now;
                damping_ = damping_ <= kFirst ? 0.0 : 0.1 * damping_;
                return largest;
            }
            take_back();
            if (largest < kSmall || damping_ > kLargest || tried_ >= most_) return 0.0;
            damping_ = std::max(kFirst, 10.0 * damping_);
        }
    }

    /// A direction in which a link can move: one of its numbers, or two along the edge of an ellipse.
    struct Direction {
        std::size_t link;
        std::array<double, 3> numbers;  ///< their change
        glm::dvec3 strain;              ///< what it costs
        glm::dvec3 axis;                ///< angular velocity in base space
        glm::dvec3 slope;               ///< velocity of the tip
        glm::dvec3 pull;                ///< its part of the second derivative: see fill
        double gradient, size, bend;
    };

    void linearise() {
        const double wp = problem_.position_weight;
        const double wr = problem_.has_rotation ? problem_.rotation_weight : 0.0;
        const glm::dvec3 off = wp * (problem_.tip - problem_.target);
        const glm::dvec3 turn =
            wr > 0.0 ? wr * to_vector(problem_.tip_global * glm::conjugate(problem_.target_rotation)) : glm::dvec3(0.0);
        count_ = 0;
        for (std::size_t i = 0; i < links_; ++i) {
            IkLink& link = problem_.links[i];
            LimitChart& chart = link.chart;
            const glm::dvec3 arm = problem_.tip - link.position;
            if (chart.size() == 0 || (glm::dot(arm, arm) < 1e-18 && wr == 0.0)) continue;
            chart.rebase(link.local);
            const glm::dmat3 space = glm::mat3_cast(problem_.parent_global(i) * chart.basis());
            const Spring spring(link);
            const bool is_free = link.freedom == glm::dvec3(1.0);
            const glm::dvec3 back = spring_ * (is_free ? glm::conjugate(chart.basis()) * spring.turn : spring.turn);
            bends_of_springs_[i] = spring_ * spring.bend;
            const auto axes = chart.axes();
            const auto ways = chart.ways();
            double outward = 0.0;
            for (std::size_t n = 0; n < chart.size(); ++n) {
                Direction& d = directions_[count_];
                d.link = i;
                d.numbers = ways[n].numbers;
                const glm::dvec3 by = d.numbers[0] * axes[0] + d.numbers[1] * axes[1] + d.numbers[2] * axes[2];
                d.strain = is_free ? by : strain_of(link, chart.basis() * by);
                d.axis = space * by;
                d.slope = problem_.is_uneven ? link.space * glm::cross(chart.basis() * by, link.arm)
                                             : glm::cross(d.axis, arm);
                d.gradient = glm::dot(d.slope, off) + glm::dot(d.axis, turn) + glm::dot(d.strain, back);
                d.size = glm::dot(d.strain, d.strain);
                d.bend = -outward * ways[n].curvature;
                const bool is_stopped = ways[n].is_stopped(d.gradient);
                if (n == 0 && is_stopped) outward = d.gradient;
                if (!is_stopped) ++count_;
            }
        }
    }

    /// Fills the Hessian: of the distance without the bend of the tip's path, and that bend, off . (outer x slope), if
    /// it is to be whole.
    void fill(bool is_whole) {
        const double wp = problem_.position_weight;
        const double wr = problem_.has_rotation ? problem_.rotation_weight : 0.0;
        const glm::dvec3 off = wp * (problem_.tip - problem_.target);
        for (std::size_t j = 0; j < count_; ++j) {
            Direction& inner = directions_[j];
            inner.pull = wp * inner.slope;
            if (is_whole) inner.pull += glm::cross(off, inner.axis);
            for (std::size_t i = 0; i <= j; ++i) {
                const Direction& outer = directions_[i];
                double h = glm::dot(outer.pull, inner.slope);
                if (wr > 0.0) h += wr * glm::dot(outer.axis, inner.axis);
                if (outer.link == inner.link) h += bends_of_springs_[inner.link] * glm::dot(outer.strain, inner.strain);
                hessian_[j][i] = h;
            }
            if (is_whole) hessian_[j][j] += inner.bend;
        }
    }

    /// Solves for the step by Cholesky decomposition; returns false if the Hessian is not positive definite. Without
    /// the bends it always is.
    bool find_step(bool is_whole) {
        for (std::size_t j = 0; j < count_; ++j) {
            HessianRow& row = root_[j];
            for (std::size_t i = 0; i < j; ++i) {
                double sum = hessian_[j][i];
                for (std::size_t k = 0; k < i; ++k) sum -= row[k] * root_[i][k];
                row[i] = sum;
            }
            double sum = hessian_[j][j] + damping_ * directions_[j].size;
            for (std::size_t i = 0; i < j; ++i) {
                const double part = row[i] * inverse_[i];
                sum -= part * row[i];
                row[i] = part;
            }
            const double least = spring_ * directions_[j].size;
            if (!(sum > 1e-3 * least)) {
                if (is_whole) return false;
                sum = least;
            }
            inverse_[j] = 1.0 / sum;
        }
        for (std::size_t i = 0; i < count_; ++i) {
            double sum = -directions_[i].gradient;
            for (std::size_t k = 0; k < i; ++k) sum -= root_[i][k] * step_[k];
            step_[i] = sum;
        }
        for (std::size_t i = count_; i-- > 0;) {
            double sum = step_[i] * inverse_[i];
            for (std::size_t k = i + 1; k < count_; ++k) sum -= root_[k][i] * step_[k];
            step_[i] = sum;
        }
        return true;
    }

    /// Returns the largest turn in radians.
    double take_step() {
        double most = 0.0;
        for (std::size_t i = 0; i < count_; ++i)
            most = std::max(most, std::abs(step_[i]) * std::sqrt(glm::dot(directions_[i].axis, directions_[i].axis)));
        constexpr double kLongest = 1.0;
        const double part = most > kLongest ? kLongest / most : 1.0;
        std::size_t d = 0;
        std::size_t first = problem_.links.size();
        for (std::size_t i = 0; i < links_; ++i) {
            if (d == count_ || directions_[d].link != i) continue;
            first = std::min(first, i);
            LimitChart::Numbers step{};
            for (; d < count_ && directions_[d].link == i; ++d) {
                for (std::size_t n = 0; n < 3; ++n) step[n] += part * step_[d] * directions_[d].numbers[n];
            }
            bendy::take_step(problem_.links[i], step);
        }
        first_ = first;
        if (first < problem_.links.size()) problem_.place(first);
        return most * part;
    }

    void take_back() {
        std::size_t last = problem_.links.size();
        for (std::size_t d = 0; d < count_; ++d) {
            const std::size_t i = directions_[d].link;
            if (i == last) continue;
            last = i;
            take_back_step(problem_.links[i]);
        }
        if (first_ < problem_.links.size()) problem_.place(first_);
    }

    IkProblem& problem_;
    std::uint32_t most_;  ///< steps, those that are taken back among them
    std::array<double, kMostNewtonLinks> bends_of_springs_;
    std::array<Direction, kMostNumbers> directions_;
    std::array<HessianRow, kMostNumbers> hessian_, root_;
    HessianRow step_{}, inverse_{};  ///< of the diagonal
    std::size_t links_;              ///< those that move the tip or turn it as wanted
    std::size_t count_ = 0, first_ = 0;
    Measured at_;
    double spring_ = 0.0, damping_ = 0.0;
    std::uint32_t tried_ = 0;
};

}  // namespace

std::uint32_t solve_newton(IkProblem& problem, std::uint32_t most, bool is_first) {
    return Newton(problem, most).run(is_first);
}

}  // namespace bendy
