#include "touch.h"

#include "limits_pass.h"

#include "math/smooth.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace bendy {
namespace {

constexpr double kTouches = 0.02, kIsOff = 0.06;  // leg lengths between hand and body: 3 % of the height
constexpr double kIsIn = 0.1, kIsThrough = 0.3;   // leg lengths inside: of a hat's brim, not of the head
constexpr double kClear = 0.02;  // leg lengths: from there on a hand does not come nearer than the source's
constexpr double kTogether = 0.25, kApart = 0.5;   // arm lengths between the hands
constexpr double kSomewhat = 0.3, kClearly = 0.6;  // sines: straighter arms turn right round for little

/// A hand: its points in model space, in one frame.
class HandSkin {
public:
    HandSkin(SurfacePart& part, PoseState& pose) : points_(part.places(pose)), radii_(part.radii) {
        for (const glm::dvec3& point : points_) middle_ += point / static_cast<double>(points_.size());
    }

    [[nodiscard]] const glm::dvec3& middle() const { return middle_; }
    /// Returns how far the hand goes from its middle to a side. \param way  unit
    [[nodiscard]] double thickness(const glm::dvec3& way) const {
        double most = 0.0;
        for (std::size_t k = 0; k < points_.size(); ++k)
            most = std::max(most, glm::dot(points_[k] - middle_, way) + radii_[k]);
        return most;
    }

private:
    std::span<const glm::dvec3> points_;
    std::span<const double> radii_;
    glm::dvec3 middle_{0.0};
};

/// A part of a body in one frame, and a hand beside it.
class PlacedShell {
public:
    PlacedShell(const Shell& shell, PoseState& pose, const HandSkin& hand)
        : shell_(shell), matrix_(pose.fresh_matrix(shell.joint)), hand_(hand) {}

    /// Returns the way from the part's middle to a place in model space, in the body's axes.
    [[nodiscard]] glm::dvec3 way_to(const glm::dvec3& place) const {
        return glm::dvec3(shell_.to_body * (glm::inverse(matrix_) * glm::dvec4(place, 1.0))) - shell_.middle;
    }
    /// Returns how far the hand is from the part if its middle is there, metres; negative inside.
    [[nodiscard]] double gap(const glm::dvec3& way) const { return shell_.gap(way) - thickness(glm::normalize(way)); }
    /// Returns where the middle of the hand is if it is so far from the part, in model space.
    [[nodiscard]] glm::dvec3 place_at(double gap, const glm::dvec3& way) const {
        const glm::dvec3 side = glm::normalize(way);
        return {matrix_ * (shell_.from_body *
                           glm::dvec4(shell_.middle + side * shell_.radius(side, gap + thickness(side)), 1.0))};
    }

private:
    [[nodiscard]] double thickness(const glm::dvec3& side) const {
        const glm::dvec3 inwards = -glm::dmat3(matrix_) * (glm::dmat3(shell_.from_body) * side);
        return hand_.thickness(glm::normalize(inwards));
    }

    const Shell& shell_;
    glm::dmat4 matrix_;
    const HandSkin& hand_;
};

/// A hand beside the own body, and beside what the other hand holds.
class OwnBody {
public:
    OwnBody(SettledFrame& frame, std::size_t hand, std::size_t number)
        : frame_(frame),
          source_(frame.plan.source_surface.ends.at(number), frame.source),
          target_(frame.plan.surface.ends.at(number), frame.to) {
        const std::vector<Shell>& shells = frame.plan.surface.shells;
        for (std::size_t k = 0; k < shells.size(); ++k) {
            if (shells[k].held_by != hand) add(k);
        }
    }

    [[nodiscard]] const glm::dvec3& hand() const { return target_.middle(); }
    /// Returns how far the source's hand is from its body, leg lengths.
    [[nodiscard]] double source_gap() const {
        double least = std::numeric_limits<double>::infinity();
        for (const auto& part : parts_) {
            if (part) least = std::min(least, part->gap);
        }
        return least / frame_.plan.source_leg;
    }
    /// Returns where the target's hand is beside its body as the source's is beside its own: above all beside what is
    /// near.
    [[nodiscard]] glm::dvec3 as_source() const {
        glm::dvec3 sum(0.0);
        double weights = 0.0;
        for (const auto& part : parts_) {
            if (!part) continue;
            const double near = kTouches + std::max(part->gap, 0.0) / frame_.plan.source_leg;
            const glm::dvec3 place = part->shell.place_at(part->gap * frame_.plan.map.scale, part->way);
            sum += place / (near * near);
            weights += 1.0 / (near * near);
        }
        return weights > 0.0 ? sum / weights : hand();
    }
    /// Pushes a place outwards until the hand is no deeper in the body than the source's.
    [[nodiscard]] glm::dvec3 outside(glm::dvec3 place) const {
        for (const auto& part : parts_) {
            if (!part) continue;
            const double wanted = std::min(part->gap * frame_.plan.map.scale, kClear * frame_.plan.leg);
            const glm::dvec3 way = part->shell.way_to(place);
            if (glm::length(way) > 0.0 && part->shell.gap(way) < wanted) place = part->shell.place_at(wanted, way);
        }
        return place;
    }

private:
    struct Part {
        PlacedShell shell;    ///< of the target
        double gap = 0.0;     ///< metres of the source
        glm::dvec3 way{0.0};  ///< as the source's, in the target's proportions
    };

    void add(std::size_t number) {
        const Shell& from = frame_.plan.source_surface.shells.at(number);
        const Shell& to = frame_.plan.surface.shells.at(number);
        if (from.joint == kNone || to.joint == kNone) return;
        const PlacedShell placed(from, frame_.source, source_);
        const glm::dvec3 way = placed.way_to(source_.middle()), scaled = way * (to.half / from.half);
        if (glm::length(way) > 0.0 && std::isfinite(glm::length(scaled)))
            parts_.at(number).emplace(Part{PlacedShell(to, frame_.to, target_), placed.gap(way), scaled});
    }

    SettledFrame& frame_;
    HandSkin source_, target_;
    std::array<std::optional<Part>, kBodyShells + kMostProps> parts_;
};

/// Returns the sine of the angle by which a limb is bent; 1 beyond a right angle.
double bend_of(SettledFrame& frame, const LimbPlan& plan) {
    const glm::dvec3 middle = frame.place(plan.lower);
    const glm::dvec3 upper = middle - frame.place(plan.upper), lower = frame.place(plan.end) - middle;
    const double lengths = glm::length(upper) * glm::length(lower);
    if (!(lengths > 0.0)) return 0.0;
    return glm::dot(upper, lower) < 0.0 ? 1.0 : glm::length(glm::cross(upper, lower)) / lengths;
}

/// A hard limit would stop an arm on its way, and let it go with a jump.
bool may_move(const SettledFrame& frame, const LimbPlan& plan) {
    return plan.can_reach && !obeys_limits(frame, plan);
}

void touch_with(SettledFrame& frame, std::size_t hand, const GivenContacts& given) {
    const std::size_t number = frame.plan.feet.size() + hand;
    const LimbPlan& plan = frame.plan.limbs[number];
    if (!may_move(frame, plan) || frame.plan.source_surface.ends.at(number).shares.empty() ||
        frame.plan.surface.ends.at(number).shares.empty()) {
        return;
    }
    LimbFrame& limb = frame.limbs.at(number);
    const OwnBody body(frame, hand, number);
    const double gap = body.source_gap();
    const double near = smooth(gap, kIsOff, kTouches) * smooth(-gap, kIsThrough, kIsIn);
    const auto found = static_cast<float>(near * smooth(bend_of(frame, plan), kSomewhat, kClearly));
    const auto contact = static_cast<Contact>(static_cast<std::size_t>(Contact::left_hand_body) + hand);
    const double weight = weight_of(frame, contact, given, found);
    const glm::dvec3 planted = body.hand() + limb.wanted + limb.below - frame.place(plan.foot);
    const glm::dvec3 place = body.outside(weight > 0.0 ? glm::mix(planted, body.as_source(), weight) : planted);
    if (place == planted) return;
    limb.wanted += (1.0 - limb.planted) * (place - planted);
    limb.joined = 1.0;
}

}  // namespace

void touch_body(SettledFrame& frame, const GivenContacts& given) {
    for (std::size_t hand = 0; hand < frame.plan.hands.size(); ++hand) touch_with(frame, hand, given);
}

void join_hands(SettledFrame& frame, const GivenContacts& given) {
    const std::size_t left = frame.plan.feet.size(), right = left + 1;
    if (!may_move(frame, frame.plan.limbs[left]) || !may_move(frame, frame.plan.limbs[right])) return;
    const auto source_hand = [&](std::size_t k) {
        return glm::dvec3(frame.source.fresh_matrix(frame.plan.hands.at(k).heel.source)[3]);
    };
    const glm::dvec3 way = source_hand(1) - source_hand(0);
    const double bent = std::min(bend_of(frame, frame.plan.limbs[left]), bend_of(frame, frame.plan.limbs[right]));
    const double near = smooth(glm::length(way) / frame.plan.source_arm, kApart, kTogether);
    const auto found = static_cast<float>(near * smooth(bent, kSomewhat, kClearly));
    const double weight = weight_of(frame, Contact::hands, given, found);
    if (!(weight > 0.0)) return;
    LimbFrame &from = frame.limbs.at(left), &to = frame.limbs.at(right);
    const double scale = frame.plan.limbs[left].length / frame.plan.source_arm;
    const glm::dvec3 off = frame.plan.map.turn * (scale * way) - (to.wanted + to.below - from.wanted - from.below);
    for (const auto& [limb, share] : {std::pair(&from, -0.5), std::pair(&to, 0.5)}) {
        limb->wanted += share * weight * (1.0 - limb->planted) * off;
        limb->joined = std::max(limb->joined, weight);
    }
}

}  // namespace bendy
