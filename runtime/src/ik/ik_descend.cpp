#include "ik_problem.h"
#include "math/rotation.h"

#include <bendy/format/trig.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

// Within limits more than one pose may be such that no step brings the tip nearer. If a descent from the pose that came
// in does not reach, others begin where one is likely to: with the closed form, with its most promising swivel, and in
// the middle of what the limits allow or the pose that they prefer.
namespace bendy {
namespace {

class Descents {
public:
    explicit Descents(IkProblem& problem) : problem_(problem) {
        keep(&IkLink::legal, &IkLink::local);
        for (IkLink& link : problem.links) link.chart.begin(link);
    }

    /// Descends from where the links are, to what they were saved as where that is undetermined. Returns true if this
    /// reaches.
    bool descend() {
        iterations_ += problem_.links.size() > kMostNewtonLinks ? solve_least_squares(problem_, most())
                                                                : solve_newton(problem_, most(), !best_);
        consider();
        return problem_.is_reached();
    }

    /// The same from the closed form.
    bool descend_from_closed_form() {
        keep(&IkLink::local, &IkLink::legal);
        problem_.place();
        iterations_ += solve_two_bone(problem_);
        keep(&IkLink::closed, &IkLink::local);
        if (problem_.is_reached() || problem_.is_stretched_out()) {
            consider();
            return true;
        }
        problem_.save();
        return descend();
    }

    /// The same from the best of its other swivels from which no step to the side is better, one after another, as long
    /// as there may be others.
    bool descend_from_swivels(std::uint32_t& others) {
        constexpr std::size_t kTurns = 10;
        const glm::dvec3 way = problem_.target - problem_.origin;
        const double distance = glm::length(way);
        IkLink& start = problem_.links[0];
        if (start.is_fixed || problem_.position_weight == 0.0 || !(distance > 1e-9)) return false;
        const auto swivel = [&](std::size_t turn) {
            keep(&IkLink::local, &IkLink::closed);
            const double angle = 2.0 * trig::kPi * static_cast<double>(turn) / kTurns;
            const glm::dquat turned = from_vector(way * (angle / distance)) * start.closed;
            start.local = start.chart.read(start, turned);
            problem_.place();
        };
        std::array<double, kTurns> costs{};
        for (std::size_t turn = 0; turn < kTurns; ++turn) {
            swivel(turn);
            costs.at(turn) = problem_.cost();
        }
        constexpr int kStarts = 2;
        std::array<bool, kTurns> is_taken{};
        for (int i = 0; i < kStarts && others > 0; ++i, --others) {
            std::size_t least = 0;
            for (std::size_t turn = 1; turn < kTurns; ++turn) {
                const bool is_minimum =
                    costs.at(turn) <= costs.at(turn - 1) && costs.at(turn) <= costs.at((turn + 1) % kTurns);
                if (is_minimum && !is_taken.at(turn) && (least == 0 || costs.at(turn) < costs.at(least))) least = turn;
            }
            if (least == 0) return false;
            is_taken.at(least) = true;
            swivel(least);
            problem_.save();
            if (descend()) return true;
        }
        return false;
    }

    /// The same from the pose that the limits prefer, or from their middle.
    bool descend_from_middle() {
        for (IkLink& link : problem_.links) {
            if (link.constraint != nullptr && !link.is_fixed) link.local = middle_local(link);
        }
        problem_.place();
        problem_.save();
        return descend();
    }

    /// Leaves the problem in the best pose; returns the iterations of all descents.
    std::uint32_t finish() {
        keep(&IkLink::local, &IkLink::best);
        problem_.place();
        return iterations_;
    }

private:
    /// Returns how many iterations a descent may take; all of them no more than 20 for each link.
    [[nodiscard]] std::uint32_t most() const {
        constexpr std::uint32_t kOfLink = 20, kFirst = 40, kLater = 20;
        const std::uint32_t all = kOfLink * static_cast<std::uint32_t>(problem_.links.size());
        const std::uint32_t most =
            best_ ? std::min(kLater, all > iterations_ ? all - iterations_ : 0) : std::min(kFirst, all / 2);
        return problem_.iterations != 0 ? std::min(problem_.iterations, most) : most;
    }

    void keep(glm::dquat IkLink::*to, glm::dquat IkLink::*from) {
        for (IkLink& link : problem_.links) link.*to = link.*from;
    }

    void consider() {
        // If two are nearly equal, the first counts: rounding must not choose between them.
        constexpr double kNearer = 0.99;
        if (best_ && !problem_.is_reached() && problem_.cost() >= kNearer * *best_) return;
        best_ = problem_.cost();
        keep(&IkLink::best, &IkLink::local);
    }

    IkProblem& problem_;
    std::uint32_t iterations_ = 0;
    std::optional<double> best_;  ///< its cost
};

}  // namespace

std::uint32_t solve_from(IkProblem& problem, bool is_closed) {
    Descents descents(problem);
    const bool is_done = is_closed ? descents.descend_from_closed_form() : descents.descend();
    std::uint32_t others = problem.options->restarts;
    if (is_done || others == 0) return descents.finish();
    if (!is_closed && (descents.descend_from_closed_form() || --others == 0)) return descents.finish();
    if (descents.descend_from_swivels(others) || others == 0) return descents.finish();
    (void)descents.descend_from_middle();
    return descents.finish();
}

std::uint32_t solve_again(IkProblem& problem) {
    problem.stays_close = true;
    Descents descents(problem);
    (void)descents.descend();
    return descents.finish();
}

}  // namespace bendy
