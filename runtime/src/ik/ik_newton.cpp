#include "ik_problem.h"
#include "limit_chart.h"
#include "math/rotation.h"

#include <bendy/format/trig.h>

#include <algorithm>
#include <array>
#include <cmath>

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

constexpr std::size_t kMostLinks = 10;
constexpr std::size_t kMostNumbers = 3 * kMostLinks;
constexpr std::uint32_t kMostSteps = 40;
using HessianRow = std::array<double, kMostNumbers>;

class Newton {
public:
    explicit Newton(IkProblem& problem) : problem_(problem) {}

    /// Returns false if the method does not apply.
    bool begin() {
        if (problem_.links.size() > kMostLinks) return false;
        for (std::size_t i = 0; i < problem_.links.size(); ++i) {
            if (!charts_[i].begin(problem_.links[i])) return false;
        }
        return true;
    }

    std::uint32_t run(std::uint32_t most) {
        std::uint32_t iteration = 0;
        read();
        if (problem_.is_reached() && !problem_.stays_close) return 0;
        constexpr double kFirst = 3.0, kClose = 1e-3, kLast = 1e-6;
        constexpr std::uint32_t kFew = 16;
        const double factor = most < kFew ? 0.03 : 0.3;
        constexpr double kSettled = 1e-3;  // radians
        const double off = problem_.cost();
        spring_ = std::clamp(kFirst * off * std::sqrt(off), kLast, kFirst);  // less, the nearer the target is
        if (problem_.stays_close) spring_ = kClose;
        double value = objective();
        while (iteration < most) {
            ++iteration;
            linearise();
            const double largest = descend(value);
            if (spring_ > kLast) {
                spring_ = std::max(kLast, spring_ * factor);
                value = objective();
            } else if (largest < kSmall || (problem_.is_reached() && largest < kSettled)) {
                break;
            }
        }
        return iteration;
    }

private:
    static constexpr double kSmall = 1e-7;  ///< radians

    /// Returns a rotation vector in the space of the link's parent as what it costs: the less a joint is free about an
    /// axis, the more.
    [[nodiscard]] static glm::dvec3 strain(const IkLink& link, const glm::dvec3& turn) {
        const glm::dvec3& f = link.freedom;
        if (f == glm::dvec3(1.0)) return turn;
        constexpr double kLeast = 1e-3;
        return glm::conjugate(link.saved * link.frame) * turn / glm::max(f, glm::dvec3(kLeast));
    }
    [[nodiscard]] static glm::dvec3 strain(const IkLink& link) {
        return strain(link, to_vector(link.local * glm::conjugate(link.saved)));
    }
    /// Half the cost and half the square of the turns from the start, weighted.
    [[nodiscard]] double objective() const {
        double turns = 0.0;
        for (const IkLink& link : problem_.links) {
            const glm::dvec3 turn = strain(link);
            turns += glm::dot(turn, turn);
        }
        return 0.5 * (problem_.cost() + spring_ * turns);
    }

    /// Takes a step that improves the objective, damped as much as that needs; returns its largest turn in radians.
    double descend(double& value) {
        constexpr double kFirst = 1e-3, kLargest = 1e3;
        bool is_whole = true;
        for (;;) {
            if (is_whole && !find_step(true)) is_whole = false;
            if (!is_whole) (void)find_step(false);
            const double largest = take_step();
            const double now = objective();
            if (now < value) {
                value = now;
                damping_ = damping_ <= kFirst ? 0.0 : 0.1 * damping_;
                return largest;
            }
            take_back();
            if (largest < kSmall || damping_ > kLargest) return 0.0;
            damping_ = std::max(kFirst, 10.0 * damping_);
        }
    }

    void read() {
        for (std::size_t i = 0; i < problem_.links.size(); ++i) charts_[i].read(problem_.links[i]);
    }

    /// Half the square of a link's turn from where it started.
    struct Spring {
        Spring() = default;
        explicit Spring(const glm::dvec3& by) : turn(by) {
            const double angle = glm::length(by);
            if (angle < 1e-6) return;
            const trig::SinCos half = trig::sin_cos(0.5 * angle);
            about = by / angle;
            across = std::max(0.0, 0.5 * angle * half.cos / half.sin);
        }
        /// Returns its second derivative along two turns.
        [[nodiscard]] double bend(const glm::dvec3& a, const glm::dvec3& b) const {
            return across * glm::dot(a, b) + (1.0 - across) * (glm::dot(a, about) * glm::dot(b, about));
        }

        glm::dvec3 turn{0.0}, about{0.0};
        double across = 1.0;
    };

    /// A direction in which a link can move: one of its numbers, or two along the edge of an ellipse.
    struct Direction {
        std::size_t link = 0;
        std::array<double, 3> numbers{};  ///< their change
        glm::dvec3 turn{0.0};             ///< angular velocity, in the space of the link's parent
        glm::dvec3 strain{0.0};           ///< what it costs
        glm::dvec3 axis{0.0};             ///< angular velocity in base space
        glm::dvec3 slope{0.0};            ///< velocity of the tip
        glm::dvec3 bending{0.0};          ///< its part of the second derivative: see fill
        double gradient = 0.0, size = 0.0, bend = 0.0;
    };

    void linearise() {
        const double wp = problem_.position_weight;
        const double wr = problem_.has_rotation ? problem_.rotation_weight : 0.0;
        const glm::dvec3 off = wp * (problem_.tip - problem_.target);
        const glm::dvec3 turn =
            wr > 0.0 ? wr * to_vector(problem_.tip_global * glm::conjugate(problem_.target_rotation)) : glm::dvec3(0.0);
        count_ = 0;
        for (std::size_t i = 0; i < problem_.links.size(); ++i) {
            LimitChart& chart = charts_[i];
            if (chart.size() == 0) continue;
            const IkLink& link = problem_.links[i];
            const glm::dvec3 arm = problem_.tip - link.position;
            if (glm::dot(arm, arm) < 1e-18 && wr == 0.0) continue;
            chart.rebase(link);
            const glm::dquat parent = problem_.parent_global(i);
            springs_[i] = Spring(strain(link));
            const glm::dvec3 back = spring_ * springs_[i].turn;
            const auto axes = chart.axes();
            std::array<Direction, 3> found;
            for (std::size_t n = 0; n < chart.size(); ++n) {
                Direction& d = found[n];
                d.link = i;
                d.numbers[n] = 1.0;
                d.turn = axes[n];
                d.strain = strain(link, axes[n]);
                d.axis = parent * axes[n];
            }
            std::size_t from = 0;
            const auto finish = [&](Direction& d) {
                d.slope = problem_.is_uneven ? link.space * glm::cross(d.turn, link.arm) : glm::cross(d.axis, arm);
                d.gradient = glm::dot(d.slope, off) + glm::dot(d.axis, turn) + glm::dot(d.strain, back);
            };
            for (std::size_t n = 0; n < chart.size(); ++n) finish(found[n]);
            const LimitChart::Edge edge = chart.edge();
            const double outward = edge.y * found[0].gradient + edge.z * found[1].gradient;
            if (edge.is_there && outward < 0.0) {
                Direction& d = found[1];
                d.numbers = {-edge.z, edge.y, 0.0};
                d.axis = edge.y * d.axis - edge.z * found[0].axis;
                d.turn = edge.y * d.turn - edge.z * found[0].turn;
                d.strain = edge.y * d.strain - edge.z * found[0].strain;
                finish(d);
                d.bend = -outward * edge.curvature;
                from = 1;
            }
            for (std::size_t n = from; n < chart.size(); ++n) {
                Direction& d = found[n];
                const bool is_single = !(from == 1 && n == 1);
                const double value = chart.values()[n];
                constexpr double kAt = 1e-12;
                if (is_single && ((value <= chart.low()[n] + kAt && d.gradient > 0.0) ||
                                  (value >= chart.high()[n] - kAt && d.gradient < 0.0))) {
                    continue;
                }
                d.size = glm::dot(d.strain, d.strain);
                directions_[count_++] = d;
            }
        }
        fill(off, wp, wr);
    }

    /// Fills the Hessian: of the distance without the bend of the tip's path, and that bend, off . (outer x slope).
    void fill(const glm::dvec3& off, double wp, double wr) {
        for (std::size_t i = 0; i < count_; ++i) directions_[i].bending = glm::cross(off, directions_[i].axis);
        for (std::size_t j = 0; j < count_; ++j) {
            const Direction& inner = directions_[j];
            for (std::size_t i = 0; i <= j; ++i) {
                const Direction& outer = directions_[i];
                double h = wp * glm::dot(outer.slope, inner.slope);
                bends_[j][i] = glm::dot(outer.bending, inner.slope);
                if (wr > 0.0) h += wr * glm::dot(outer.axis, inner.axis);
                if (outer.link == inner.link) h += spring_ * springs_[inner.link].bend(outer.strain, inner.strain);
                hessian_[j][i] = h;
            }
            bends_[j][j] += inner.bend;
        }
    }

    /// Solves for the step by Cholesky decomposition; returns false if the Hessian is not positive definite. Without
    /// the bends it always is.
    bool find_step(bool is_whole) {
        for (std::size_t j = 0; j < count_; ++j) {
            for (std::size_t i = 0; i <= j; ++i) {
                double sum = hessian_[j][i];
                if (is_whole) sum += bends_[j][i];
                if (i == j) sum += damping_ * directions_[j].size;
                for (std::size_t k = 0; k < i; ++k) sum -= root_[j][k] * root_[i][k];
                if (i == j) {
                    if (!(sum > 1e-3 * spring_ * directions_[j].size)) {
                        if (is_whole) return false;
                        sum = spring_ * directions_[j].size;
                    }
                    root_[j][j] = std::sqrt(sum);
                } else {
                    root_[j][i] = sum / root_[i][i];
                }
            }
        }
        for (std::size_t i = 0; i < count_; ++i) {
            double sum = -directions_[i].gradient;
            for (std::size_t k = 0; k < i; ++k) sum -= root_[i][k] * step_[k];
            step_[i] = sum / root_[i][i];
        }
        for (std::size_t i = count_; i-- > 0;) {
            double sum = step_[i];
            for (std::size_t k = i + 1; k < count_; ++k) sum -= root_[k][i] * step_[k];
            step_[i] = sum / root_[i][i];
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
        for (std::size_t i = 0; i < problem_.links.size(); ++i) {
            if (d == count_ || directions_[d].link != i) continue;
            first = std::min(first, i);
            LimitChart::Numbers step{};
            for (; d < count_ && directions_[d].link == i; ++d) {
                for (std::size_t n = 0; n < 3; ++n) step[n] += part * step_[d] * directions_[d].numbers[n];
            }
            IkLink& link = problem_.links[i];
            link.trial = link.local;
            before_[i] = charts_[i].values();
            link.local = charts_[i].move(step);
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
            problem_.links[i].local = problem_.links[i].trial;
            charts_[i].set(before_[i]);
        }
        if (first_ < problem_.links.size()) problem_.place(first_);
    }

    IkProblem& problem_;
    std::array<LimitChart, kMostLinks> charts_;
    std::array<LimitChart::Numbers, kMostLinks> before_;
    std::array<Spring, kMostLinks> springs_;
    std::array<Direction, kMostNumbers> directions_;
    std::array<HessianRow, kMostNumbers> hessian_, bends_, root_;
    HessianRow step_{};
    std::size_t count_ = 0, first_ = 0;
    double spring_ = 0.0, damping_ = 0.0;
};

}  // namespace

std::optional<std::uint32_t> solve_newton(IkProblem& problem) {
    Newton newton(problem);
    if (!newton.begin()) return std::nullopt;
    return newton.run(problem.iterations != 0 ? std::min(problem.iterations, kMostSteps) : kMostSteps);
}

}  // namespace bendy
