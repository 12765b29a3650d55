#include "ik_problem.h"
#include "limit_chart.h"
#include "math/rotation.h"

#include <bendy/format/trig.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
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

constexpr std::size_t kMostLinks = LimitChart::kMostLinks;
constexpr std::size_t kMostNumbers = 3 * kMostLinks;
using HessianRow = std::array<double, kMostNumbers>;

class Newton {
public:
    Newton(IkProblem& problem, std::span<LimitChart> charts)
        : problem_(problem), charts_(charts), links_(charts.size()) {
        while (!problem.has_rotation && links_ > 0 && problem.links[links_ - 1].bone_length == 0.0) --links_;
    }

    /// See solve_newton.
    std::uint32_t run(std::uint32_t most, const std::optional<double>& best) {
        for (std::size_t i = 0; i < links_; ++i) charts_[i].read(problem_.links[i]);
        if (problem_.is_reached() && !problem_.stays_close) return 0;
        constexpr double kStiff = 3.0, kClose = 1e-3;
        constexpr std::uint32_t kFew = 16;
        const double looser = best ? 0.1 : most < kFew ? 0.03 : 0.3;
        constexpr double kSettled = 1e-3;  // radians
        const double off = problem_.cost();
        // Weaker, the nearer the target is.
        spring_ = std::max(last_spring(), std::min(kStiff, (best ? 0.3 : 3.0) * off * std::sqrt(off)));
        if (problem_.stays_close) spring_ = kClose;
        double value = objective();
        while (tried_ < most) {
            linearise();
            const double largest = descend(value);
            if (best && is_hopeless(*best)) break;
            const double last = last_spring();
            if (spring_ > last) {
                spring_ = std::max(last, spring_ * looser);
                value = objective();
            } else if (largest < kSmall || (problem_.is_reached() && largest < kSettled)) {
                break;
            }
        }
        return tried_;
    }

private:
    static constexpr double kSmall = 1e-4;  ///< radians

    /// Returns the weakest springs: the farther the target remains, the more the tip may miss it by for them.
    [[nodiscard]] double last_spring() const { return std::clamp(0.03 * problem_.cost(), 1e-6, 1e-2); }

    /// Returns true if a better end than one of this cost is no longer likely.
    [[nodiscard]] bool is_hopeless(double best) const {
        constexpr std::uint32_t kTries = 5;
        constexpr double kNear = 1e-3;
        return tried_ >= kTries && problem_.cost() > 2.0 * best + kNear;
    }

    /// Returns a rotation vector in the space of the link's parent as what it costs: the less a joint is free about an
    /// axis, the more.
    [[nodiscard]] static glm::dvec3 strain(const IkLink& link, const glm::dvec3& turn) {
        const glm::dvec3& f = link.freedom;
        if (f == glm::dvec3(1.0)) return turn;
        constexpr double kLeast = 1e-3;
        return glm::conjugate(link.saved * link.frame) * turn / glm::max(f, glm::dvec3(kLeast));
    }

    /// A link's turn from where it started: the chord of its angle, which needs no trigonometry and grows up to half
    /// a turn.
    struct Spring {
        explicit Spring(const IkLink& link) {
            const glm::dquat by = upper_half(link.local * glm::conjugate(link.saved));
            turn = strain(link, 2.0 * glm::dvec3(by.x, by.y, by.z));
            bend = by.w;
        }
        [[nodiscard]] double square() const { return 2.0 * glm::dot(turn, turn) / (1.0 + bend); }

        glm::dvec3 turn;  ///< half the derivative of the square
        double bend;      ///< half the second one
    };

    /// Half the cost and half the square of the turns from the start, weighted.
    [[nodiscard]] double objective() const {
        double turns = 0.0;
        for (std::size_t i = 0; i < links_; ++i) turns += Spring(problem_.links[i]).square();
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
            ++tried_;
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
        for (std::size_t i = 0; i < links_; ++i) (void)charts_[i].read(problem_.links[i], problem_.links[i].local);
    }

    /// A direction in which a link can move: one of its numbers, or two along the edge of an ellipse.
    struct Direction {
        std::size_t link;
        std::array<double, 3> numbers;  ///< their change
        glm::dvec3 turn;                ///< angular velocity, in the space of the link's parent
        glm::dvec3 strain;              ///< what it costs
        glm::dvec3 axis;                ///< angular velocity in base space
        glm::dvec3 slope;               ///< velocity of the tip
        glm::dvec3 bending;             ///< its part of the second derivative: see fill
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
            LimitChart& chart = charts_[i];
            const IkLink& link = problem_.links[i];
            const glm::dvec3 arm = problem_.tip - link.position;
            if (chart.size() == 0 || (glm::dot(arm, arm) < 1e-18 && wr == 0.0)) continue;
            chart.rebase(link);
            const glm::dquat parent = problem_.parent_global(i);
            const Spring spring(link);
            const glm::dvec3 back = spring_ * spring.turn;
            bends_of_springs_[i] = spring_ * spring.bend;
            const auto axes = chart.axes();
            const auto add = [&](const LimitChart::Numbers& numbers) -> Direction& {
                Direction& d = directions_[count_];
                d.link = i;
                d.numbers = numbers;
                d.turn = numbers[0] * axes[0] + numbers[1] * axes[1] + numbers[2] * axes[2];
                d.strain = strain(link, d.turn);
                d.axis = parent * d.turn;
                d.slope = problem_.is_uneven ? link.space * glm::cross(d.turn, link.arm) : glm::cross(d.axis, arm);
                d.gradient = glm::dot(d.slope, off) + glm::dot(d.axis, turn) + glm::dot(d.strain, back);
                d.size = glm::dot(d.strain, d.strain);
                d.bend = 0.0;
                return d;
            };
            const LimitChart::Edge edge = chart.edge();
            std::size_t from = 0;
            if (edge.is_there) {
                const double outward = add({edge.y, edge.z, 0.0}).gradient;
                if (outward < 0.0) {
                    add({-edge.z, edge.y, 0.0}).bend = -outward * edge.curvature;
                    ++count_;
                    from = 2;
                }
            }
            for (std::size_t n = from; n < chart.size(); ++n) {
                LimitChart::Numbers numbers{};
                numbers[n] = 1.0;
                const double gradient = add(numbers).gradient;
                const double value = chart.values()[n];
                constexpr double kAt = 1e-12;
                const bool is_stopped = (value <= chart.low()[n] + kAt && gradient > 0.0) ||
                                        (value >= chart.high()[n] - kAt && gradient < 0.0);
                if (!is_stopped) ++count_;
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
                if (outer.link == inner.link) h += bends_of_springs_[inner.link] * glm::dot(outer.strain, inner.strain);
                hessian_[j][i] = h;
            }
            bends_[j][j] += inner.bend;
        }
    }

    /// Solves for the step by Cholesky decomposition; returns false if the Hessian is not positive definite. Without
    /// the bends it always is.
    bool find_step(bool is_whole) {
        for (std::size_t j = 0; j < count_; ++j) {
            HessianRow& row = root_[j];
            for (std::size_t i = 0; i < j; ++i) {
                double sum = hessian_[j][i] + (is_whole ? bends_[j][i] : 0.0);
                for (std::size_t k = 0; k < i; ++k) sum -= row[k] * root_[i][k];
                row[i] = sum;
            }
            double sum = hessian_[j][j] + (is_whole ? bends_[j][j] : 0.0) + damping_ * directions_[j].size;
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
    std::span<LimitChart> charts_;
    std::array<LimitChart::Numbers, kMostLinks> before_;
    std::array<double, kMostLinks> bends_of_springs_;
    std::array<Direction, kMostNumbers> directions_;
    std::array<HessianRow, kMostNumbers> hessian_, bends_, root_;
    HessianRow step_{}, inverse_{};  ///< of the diagonal
    std::size_t links_;              ///< those that move the tip or turn it as wanted
    std::size_t count_ = 0, first_ = 0;
    double spring_ = 0.0, damping_ = 0.0;
    std::uint32_t tried_ = 0;
};

}  // namespace

std::uint32_t solve_newton(IkProblem& problem, std::span<LimitChart> charts, std::uint32_t most,
                           const std::optional<double>& best) {
    if (problem.iterations != 0) most = std::min(problem.iterations, most);
    return Newton(problem, charts).run(most, best);
}

}  // namespace bendy
