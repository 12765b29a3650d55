#include "ik_problem.h"
#include "math/nearest_rotation.h"
#include "math/rotation.h"

#include <bendy/format/trig.h>

#include <cmath>

// The swivel of two bones: their start rotates about the line to the target, until it is inside its limits.
namespace bendy {
namespace {

/// Rotations of an aimed start about the line to the target.
class Swivel {
public:
    /// See best_swivel.
    Swivel(const Constraint& constraint, const glm::dquat& rest_frame, const glm::dquat& start, const glm::dvec3& axis)
        : constraint_(constraint) {
        const glm::dquat in = glm::conjugate(rest_frame);
        const glm::dquat out = start * constraint.frame;
        at_zero_ = in * out;
        at_half_ = in * (glm::dquat(0.0, axis) * out);
    }

    /// Returns the angle that takes the start least outside its constraint; of the legal ones the smallest, to either
    /// side, so that a mirrored chain turns the other way.
    [[nodiscard]] double best_angle() const {
        constexpr int kTurns = 24;
        constexpr double kStep = 2.0 * trig::kPi / kTurns;
        double best = 0.0;
        double least = excess(0.0);
        const auto consider = [&](double angle, double here) {
            if (here >= least) return;
            least = here;
            best = angle;
        };
        double before_there = least, before_back = least;
        for (int i = 1; i <= kTurns / 2 && least > kLegal; ++i) {
            const double there = excess(kStep * i);
            const double back = excess(-kStep * i);
            if (there <= kLegal || back <= kLegal) {
                constexpr double kMore = 4.0;  // more than half a turn
                const double one = there <= kLegal ? edge({kStep * (i - 1), before_there}, kStep * i) : kMore;
                const double other = back <= kLegal ? edge({-kStep * (i - 1), before_back}, -kStep * i) : -kMore;
                return one <= -other ? one : other;
            }
            if (there <= back) {
                consider(kStep * i, there);
            } else {
                consider(-kStep * i, back);
            }
            before_there = there;
            before_back = back;
        }
        for (double step = 0.5 * kStep; step > 1e-7 && least > kLegal; step *= 0.5) {
            const double middle = best;
            consider(middle - step, excess(middle - step));
            consider(middle + step, excess(middle + step));
        }
        return best;
    }

private:
    static constexpr double kLegal = 1e-9;  // radians
    struct Sample {
        double angle, excess;
    };

    /// Returns how far a rotation takes the start outside its constraint, in radians.
    [[nodiscard]] double excess(double angle) const {
        const trig::SinCos half = trig::sin_cos(0.5 * angle);
        const glm::dquat R = at_zero_ * half.cos + at_half_ * half.sin;
        return angle_between(quick_legal_rotation(constraint_, constraint_.shape, R), R);
    }

    /// Returns the first legal angle between an illegal and a legal one, to kNear. Close to it, the excess is nearly
    /// linear: a secant through two illegal samples finds it in a few steps, and its other side in one more.
    [[nodiscard]] double edge(Sample illegal, double legal) const {
        constexpr double kNear = 1e-6;
        Sample before = illegal;
        bool was_legal = false;
        for (int step = 1; std::abs(legal - illegal.angle) > kNear; ++step) {
            double next = 0.5 * (legal + illegal.angle);
            if (before.excess > illegal.excess && step % 3 != 0) {
                const double slope = (illegal.angle - before.angle) / (before.excess - illegal.excess);
                const double margin =
                    std::copysign(0.4 * kNear, was_legal ? illegal.angle - legal : legal - illegal.angle);
                const double aimed = illegal.angle + slope * illegal.excess + margin;
                if (std::abs(aimed - legal) + std::abs(aimed - illegal.angle) <= std::abs(legal - illegal.angle))
                    next = aimed;
            }
            const double here = excess(next);
            was_legal = here <= kLegal;
            if (was_legal) {
                legal = next;
            } else {
                before = illegal;
                illegal = {next, here};
            }
        }
        return legal;
    }

    const Constraint& constraint_;
    glm::dquat at_zero_, at_half_;  ///< the start in its constraint's frame, without a turn and after half a revolution
};

}  // namespace

double best_swivel(const Constraint& constraint, const glm::dquat& rest_frame, const glm::dquat& start,
                   const glm::dvec3& axis) {
    return Swivel(constraint, rest_frame, start, axis).best_angle();
}

}  // namespace bendy
