#include "fit_to_clips.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace bendy::converter {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kMostGrowth = 30.0 * kDegree;
constexpr double kMostWobble = 5.0 * kDegree;  // of a hinge, about axes that are not its own

glm::dquat to_quaternion(const float* xyzw) {
    return glm::normalize(glm::dquat(xyzw[3], xyzw[0], xyzw[1], xyzw[2]));
}

/// R = swing * twist, as spec/constraints.md has it: twist in radians in (-pi, pi], the swing vector's length the sine
/// of half its angle.
struct SwingTwist {
    double twist = 0.0;
    glm::dvec2 swing{0.0};
};

SwingTwist decompose(const LimitRecord& limit, const Joint& joint, const float* key) {
    const glm::dquat frame = to_quaternion(limit.frame.data());
    const glm::dquat rest = to_quaternion(&joint.rest.rotation[0]);
    glm::dquat r = glm::conjugate(frame) * glm::conjugate(rest) * to_quaternion(key) * frame;
    if (r.w < 0.0) r = -r;
    SwingTwist result;
    const double length = std::hypot(r.w, r.x);
    if (length < 1e-12) {
        result.swing = {r.y, r.z};
        return result;
    }
    const double cosine = r.w / length;
    const double sine = r.x / length;
    result.twist = 2.0 * std::atan2(sine, cosine);
    result.swing = {cosine * r.y - sine * r.z, sine * r.y + cosine * r.z};
    return result;
}

double angle_of(double half_sine) {
    return 2.0 * std::asin(std::min(half_sine, 1.0));
}

double half_sine_of(double angle) {
    return std::sin(0.5 * std::min(angle, std::numbers::pi));
}

/// Of what the keys of one joint need.
class Fit {
public:
    explicit Fit(const LimitRecord& limit) : limit_(limit) {
        for (std::size_t axis = 0; axis < 2; ++axis) {
            sides_[axis][0] = half_sine_of(-static_cast<double>(limit.rotation_min[axis + 1]));
            sides_[axis][1] = half_sine_of(static_cast<double>(limit.rotation_max[axis + 1]));
        }
    }

    [[nodiscard]] bool is_hinge() const { return limit_.model == static_cast<std::uint8_t>(LimitModel::hinge); }

    /// First for all keys: each side reaches as far as they do.
    void reach(const SwingTwist& key) {
        low_ = std::min(low_, key.twist);
        high_ = std::max(high_, key.twist);
        wobble_ = std::max(wobble_, angle_of(std::hypot(key.swing.x, key.swing.y)));
        if (is_hinge()) return;
        for (int axis = 0; axis < 2; ++axis) {
            double& side = sides_[static_cast<std::size_t>(axis)][key.swing[axis] > 0.0 ? 1 : 0];
            side = std::max(side, std::abs(key.swing[axis]));
        }
    }

    /// Then for all keys again: the ellipse holds them.
    void embrace(const SwingTwist& key) {
        double sum = 0.0;
        for (int axis = 0; axis < 2; ++axis) {
            if (std::abs(key.swing[axis]) < 1e-9) continue;
            const double part = key.swing[axis] / sides_[static_cast<std::size_t>(axis)][key.swing[axis] > 0.0 ? 1 : 0];
            sum += part * part;
        }
        if (!(sum > 1.0)) return;
        for (int axis = 0; axis < 2; ++axis) {
            double& factor = factors_[static_cast<std::size_t>(axis)][key.swing[axis] > 0.0 ? 1 : 0];
            factor = std::max(factor, std::sqrt(sum));
        }
    }

    [[nodiscard]] double wobble() const { return wobble_; }

    /// The limit with whole degrees where it grew, and how far it grew, in radians.
    [[nodiscard]] std::pair<LimitRecord, double> widened() const {
        LimitRecord limit = limit_;
        double growth = grow(limit.rotation_min[0], -low_, -1.0);
        growth = std::max(growth, grow(limit.rotation_max[0], high_, 1.0));
        for (std::size_t axis = 0; axis < 2 && !is_hinge(); ++axis) {
            const double low = angle_of(sides_[axis][0] * factors_[axis][0]);
            const double high = angle_of(sides_[axis][1] * factors_[axis][1]);
            growth = std::max(growth, grow(limit.rotation_min[axis + 1], low, -1.0));
            growth = std::max(growth, grow(limit.rotation_max[axis + 1], high, 1.0));
        }
        return {limit, growth};
    }

private:
    /// Moves an end of a range out to `reach`, both counted in the direction of `sign`; by how much.
    static double grow(float& end, double reach, double sign) {
        const double before = sign * static_cast<double>(end);
        if (!(reach > before + 1e-4)) return 0.0;
        end = static_cast<float>(sign * std::ceil(reach / kDegree) * kDegree);
        return reach - before;
    }

    LimitRecord limit_;
    double low_ = 0.0;
    double high_ = 0.0;
    double wobble_ = 0.0;
    std::array<std::array<double, 2>, 2> sides_{};  ///< Y and Z, below and above 0: half axes of the ellipse
    std::array<std::array<double, 2>, 2> factors_{{{1.0, 1.0}, {1.0, 1.0}}};
};

/// The cycles' rotation tracks by joint.
std::vector<std::vector<const Track*>> sort_tracks(const Scene& scene) {
    std::vector<std::vector<const Track*>> by_joint(scene.joints.size());
    for (const Cycle& cycle : scene.cycles) {
        for (const Track& track : cycle.tracks) {
            if (track.path == TrackPath::rotation) by_joint[track.target].push_back(&track);
        }
    }
    return by_joint;
}

Fit fit(const LimitRecord& limit, const Joint& joint, const std::vector<const Track*>& tracks) {
    Fit result(limit);
    const auto visit = [&](auto&& use) {
        for (const Track* track : tracks) {
            const bool is_cubic = track->interpolation == Interpolation::cubic;
            const std::size_t step = is_cubic ? 12 : 4;
            for (std::size_t at = is_cubic ? 4 : 0; at + 4 <= track->values.size(); at += step)
                use(decompose(limit, joint, &track->values[at]));
        }
    };
    visit([&](const SwingTwist& key) { result.reach(key); });
    if (!result.is_hinge()) visit([&](const SwingTwist& key) { result.embrace(key); });
    return result;
}

}  // namespace

void fit_to_clips(const Scene& scene, std::vector<ProposedLimit>& limits, Report& report) {
    const std::vector<std::vector<const Track*>> tracks = sort_tracks(scene);
    std::vector<ProposedLimit> kept;
    for (ProposedLimit& proposed : limits) {
        const Joint& joint = scene.joints[proposed.joint];
        Fit fitted = fit(proposed.limit, joint, tracks[proposed.joint]);
        const bool wobbles = fitted.is_hinge() && fitted.wobble() > kMostWobble;
        if (wobbles && proposed.looser) fitted = fit(*proposed.looser, joint, tracks[proposed.joint]);
        const auto [limit, growth] = fitted.widened();
        if (growth > kMostGrowth || (wobbles && !proposed.looser)) {
            report.warn(
                "auto-rig: the character's own clips go far beyond a human's limits, none proposed for this joint",
                joint.name);
            continue;
        }
        kept.push_back({proposed.joint, limit, std::nullopt, growth > 0.0});
    }
    limits = std::move(kept);
}

}  // namespace bendy::converter
