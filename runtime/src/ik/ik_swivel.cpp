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

    /// See best_swivel.
    [[nodiscard]] double best_angle() const {
        const double at_zero = excess(0.0);
        if (at_zero <= kLegal) return 0.0;
        constexpr int kTurns = 24;
        constexpr double kStep = 2.0 * trig::kPi / kTurns;
        Way there{kStep, {0.0, at_zero}}, back{-kStep, {0.0, at_zero}};
        for (int i = 1; i <= kTurns / 2; ++i) {
            const bool is_there = step(there), is_back = step(back);
            if (!is_there && !is_back) continue;
            constexpr double kMore = 4.0;  // more than half a turn
            const double one = is_there ? edge(there.illegal, there.legal) : kMore;
            const double other = is_back ? edge(back.illegal, back.legal) : -kMore;
            return one <= -other ? one : other;
        }
        return 0.0;
    }

private:
    static constexpr double kLegal = 1e-9;  // radians
    struct Sample {
        double angle, excess;
    };
    /// A search to one side.
    struct Way {
        double step;
        Sample last;
        Sample before = last;
        Sample illegal = last;  ///< with `legal`, once that is found: the angles that the edge is between
        double legal = 0.0;
    };

    /// Takes a step; returns true if it has found a legal angle, also between the last two steps.
    [[nodiscard]] bool step(Way& way) const {
        const double angle = way.last.angle + way.step;
        const Sample now{angle, excess(angle)};
        if (now.excess <= kLegal) {
            way.illegal = way.last;
            way.legal = angle;
            return true;
        }
        // Near the edge the excess changes about as fast as the angle at most.
        const bool is_least = way.last.excess < now.excess && way.last.excess <= way.before.excess;
        const bool is_found = is_least && way.last.excess < std::abs(way.step) && find_between(way, now);
        way.before = way.last;
        way.last = now;
        return is_found;
    }

    /// Looks for a legal angle about a least sample, by golden section.
    [[nodiscard]] bool find_between(Way& way, const Sample& after) const {
        constexpr double kGolden = 0.381966011250105;
        double low = way.before.angle, middle = way.last.angle, high = after.angle;
        double least = way.last.excess;
        for (int i = 0; i < 16; ++i) {
            const bool is_high = std::abs(high - middle) > std::abs(middle - low);
            const double next = middle + kGolden * ((is_high ? high : low) - middle);
            const double here = excess(next);
            if (here <= kLegal) {
                way.illegal = way.before;
                way.legal = next;
                return true;
            }
            if (here < least) {
                (is_high ? low : high) = middle;
                middle = next;
                least = here;
            } else {
                (is_high ? high : low) = next;
            }
            if (least > std::abs(high - low)) return false;
        }
        return false;
    }

    /// Returns how far a rotation takes the start outside its constraint, in radians.
    [[nodiscard]] double excess(double angle) const {
        const trig::SinCos half = trig::sin_cos(0.5 * angle);
        const glm::dquat R = at_zero_ * half.cos + at_half_ * half.sin;
        return bendy::excess(constraint_, constraint_.shape, R);
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
