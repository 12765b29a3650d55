#include "clip_rotations.h"

#include "scene/evaluate.h"
#include "scene/frame_shapes.h"
#include "scene/rest_frames.h"

#include <bendy/format/trig.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace bendy::converter {
namespace {

std::optional<glm::dquat> to_unit(const double* xyzw) {
    const glm::dquat q(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
    const double length = glm::length(q);
    if (!std::isfinite(length) || !(length > 1e-6)) return std::nullopt;
    return q / length;
}

/// The smaller angle between two rotations, in radians.
double angle_between(const glm::dquat& a, const glm::dquat& b) {
    const glm::dquat d = glm::conjugate(a) * b;
    return 2.0 * trig::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::abs(d.w));
}

glm::dquat rest_rotation(const Joint& joint) {
    const glm::vec4& r = joint.rest.rotation;
    return glm::normalize(glm::dquat(r.w, r.x, r.y, r.z));
}

/// The track's rotation at a time; nothing if it is not a rotation.
std::optional<glm::dquat> rotation_at(const Track& track, double seconds, std::vector<double>& numbers) {
    evaluate_track(track, seconds, numbers);
    return to_unit(numbers.data());
}

/// The unit eigenvector of a symmetric matrix for its largest eigenvalue; on a tie, the one of the first axis. Uses
/// Jacobi rotations and no function but the square root: the same on every machine. For a zero matrix: X.
glm::dvec3 principal_axis(const glm::dmat3& symmetric) {
    glm::dmat3 m = symmetric;
    glm::dmat3 axes(1.0);
    constexpr int kSweeps = 12;  // it converges quadratically: five are enough for 1e-15
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (const auto& [p, q] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) {
            if (m[p][q] == 0.0) continue;
            const double theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
            const double t = (theta < 0.0 ? -1.0 : 1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
            const double c = 1.0 / std::sqrt(t * t + 1.0);
            const double s = t * c;
            glm::dmat3 turn(1.0);
            turn[p][p] = turn[q][q] = c;
            turn[q][p] = s;
            turn[p][q] = -s;
            m = glm::transpose(turn) * m * turn;
            m[p][q] = m[q][p] = 0.0;
            axes = axes * turn;
        }
    }
    int largest = 0;
    for (const int axis : {1, 2}) {
        if (m[axis][axis] > m[largest][largest]) largest = axis;
    }
    const glm::dvec3& axis = axes[largest];
    const double length = std::sqrt(axis.x * axis.x + axis.y * axis.y + axis.z * axis.z);
    return std::isfinite(length) && length > 0.5 ? axis / length : glm::dvec3(1.0, 0.0, 0.0);
}

}  // namespace

ClipRotations::ClipRotations(const Scene& scene) : scene_(scene), tracks_(scene.joints.size()) {
    for (std::size_t clip = 0; clip < scene.clips.size(); ++clip) {
        for (const Track& track : scene.clips[clip].tracks) {
            if (track.path == TrackPath::rotation) tracks_[track.target].push_back({clip, &track});
        }
    }
}

ClipRotations::OfJoint ClipRotations::of(std::uint32_t joint) const {
    constexpr double kApart = 5.0 * trig::kDegree;
    OfJoint result;
    const glm::dquat from_rest = glm::conjugate(rest_rotation(scene_.joints[joint]));
    std::vector<double> numbers;
    const auto add = [&](const glm::dquat& q) {
        const glm::dquat away = from_rest * q;
        result.rotations.push_back(away.w < 0.0 ? -away : away);
    };
    for (const auto& [clip, track] : tracks_[joint]) {
        ++result.clips;
        std::optional<glm::dquat> last;
        double last_time = 0.0;
        for (const float time : track->times) {
            const std::optional<glm::dquat> q = rotation_at(*track, time, numbers);
            if (!q) continue;
            if (last && track->interpolation != Interpolation::step) {
                // A spline may leave the arc between its keys.
                const int least = track->interpolation == Interpolation::cubic ? 4 : 1;
                const int parts = std::max(least, static_cast<int>(std::ceil(angle_between(*last, *q) / kApart)));
                for (int part = 1; part < parts; ++part) {
                    const double between = last_time + (time - last_time) * part / parts;
                    if (const auto there = rotation_at(*track, between, numbers)) add(*there);
                }
            }
            add(*q);
            last = q;
            last_time = time;
        }
    }
    return result;
}

std::optional<std::size_t> ClipRotations::farthest_clip(const std::vector<std::uint32_t>& joints) const {
    std::optional<std::size_t> farthest;
    double most = 0.0;
    std::vector<double> numbers;
    for (const std::uint32_t joint : joints) {
        const glm::dquat rest = rest_rotation(scene_.joints[joint]);
        for (const auto& [clip, track] : tracks_[joint]) {
            for (const float time : track->times) {
                const std::optional<glm::dquat> q = rotation_at(*track, time, numbers);
                if (!q || !(angle_between(rest, *q) > most)) continue;
                most = angle_between(rest, *q);
                farthest = clip;
            }
        }
    }
    return farthest;
}

std::optional<ClipRotations::Bend> ClipRotations::bend_of(const Limb& limb) const {
    constexpr std::size_t kMostTimes = 4096;  // for all clips together
    std::vector<std::uint32_t> path;          // from the end up to the start
    for (std::uint32_t joint = limb.end; joint != kNone && joint >= limb.start; joint = scene_.joints[joint].parent)
        path.push_back(joint);
    if (path.empty() || path.back() != limb.start) return std::nullopt;
    std::reverse(path.begin(), path.end());

    std::vector<std::vector<const Track*>> by_clip(scene_.clips.size());  // one entry per joint of the path, or none
    std::size_t moving = 0;
    for (std::size_t link = 0; link < path.size(); ++link) {
        for (const auto& [clip, track] : tracks_[path[link]]) {
            if (by_clip[clip].empty()) {
                by_clip[clip].resize(path.size());
                ++moving;
            }
            by_clip[clip][link] = track;
        }
    }
    if (moving == 0) return std::nullopt;
    const std::size_t times = std::clamp<std::size_t>(kMostTimes / moving, 4, 48);

    Bend result;
    glm::dvec3 sum(0.0);
    double weight = 0.0;
    double most = 0.0;
    std::vector<double> numbers;
    for (std::size_t clip = 0; clip < by_clip.size(); ++clip) {
        if (by_clip[clip].empty()) continue;
        ++result.clips;
        const ClipSpan span = span_of(scene_.clips[clip]);
        for (std::size_t time = 0; time < times; ++time) {
            const double seconds = span.at(static_cast<double>(time) / static_cast<double>(times - 1));
            glm::dquat turn(1.0, 0.0, 0.0, 0.0);
            glm::dvec3 place(0.0);
            glm::dvec3 middle(0.0);
            for (std::size_t link = 0; link < path.size(); ++link) {
                const Joint& joint = scene_.joints[path[link]];
                if (link > 0) place += turn * glm::dvec3(joint.rest.translation);
                if (path[link] == limb.middle) middle = place;
                const Track* track = by_clip[clip][link];
                const std::optional<glm::dquat> q =
                    track != nullptr ? rotation_at(*track, seconds, numbers) : std::optional(rest_rotation(joint));
                if (q) turn = turn * *q;
            }
            const glm::dvec3 tip = place + turn * limb.tip;
            const auto upper = unit(middle);
            const auto lower = unit(tip - middle);
            const auto along = unit(tip);
            if (!upper || !lower || !along) continue;
            const double sine = glm::length(glm::cross(*upper, *lower));
            most = std::max(most, trig::atan2(sine, glm::dot(*upper, *lower)));
            if (const auto aside = unit_across(*upper, *along)) sum += sine * *aside;
            weight += sine;
        }
    }
    const auto direction = unit(sum);
    if (!direction || most < 10.0 * trig::kDegree) return std::nullopt;
    result.direction = *direction;
    result.agreement = glm::length(sum) / weight;
    return result;
}

SwingTwist decompose(const glm::dquat& r) {
    const double length = std::sqrt(r.w * r.w + r.x * r.x);
    if (length < 1e-12) return {0.0, {r.y, r.z}, 0.0};
    const double cosine = r.w / length;
    const double sine = r.x / length;
    double twist = 2.0 * trig::atan2(sine, cosine) / trig::kDegree;
    if (twist > 180.0) twist -= 360.0;
    if (twist < -180.0) twist += 360.0;
    return {twist, {cosine * r.y - sine * r.z, sine * r.y + cosine * r.z}, length};
}

double half_sine_of(double degrees) {
    return trig::sin_cos(0.5 * std::clamp(degrees, 0.0, 180.0) * trig::kDegree).sin;
}

double degrees_of(double half_sine) {
    const double sine = std::min(half_sine, 1.0);
    return 2.0 * trig::atan2(sine, std::sqrt((1.0 - sine) * (1.0 + sine))) / trig::kDegree;
}

double angle_about(const glm::dquat& r, const glm::dvec3& axis) {
    return 2.0 * trig::atan2(glm::dot({r.x, r.y, r.z}, axis), r.w) / trig::kDegree;
}

double largest_angle(const Rotations& rotations) {
    double most = 0.0;
    for (const glm::dquat& r : rotations) most = std::max(most, degrees_of(glm::length(glm::dvec3(r.x, r.y, r.z))));
    return most;
}

double wobble_about(const Rotations& rotations, const glm::dvec3& axis) {
    double most = 0.0;
    for (const glm::dquat& r : rotations) {
        const double along = glm::dot({r.x, r.y, r.z}, axis);
        const double turn = std::sqrt(r.w * r.w + along * along);
        most = std::max(most, degrees_of(std::sqrt(std::max(0.0, (1.0 - turn) * (1.0 + turn)))));
    }
    return most;
}

glm::dvec3 fit_axis(const Rotations& rotations) {
    glm::dmat3 sum(0.0);
    for (const glm::dquat& r : rotations) {
        const glm::dvec3 v(r.x, r.y, r.z);
        sum += glm::outerProduct(v, v);
    }
    return principal_axis(sum);
}

glm::dvec3 fit_swing_axis(const Rotations& rotations) {
    glm::dmat3 sum(0.0);
    for (const glm::dquat& r : rotations) {
        const SwingTwist parts = decompose(r);
        const glm::dvec3 v(0.0, parts.swing.x, parts.swing.y);
        sum += glm::outerProduct(v, v);
    }
    const glm::dvec3 axis = principal_axis(sum);
    return std::abs(axis.x) < 0.5 ? axis : glm::dvec3(0.0, 0.0, 1.0);
}

}  // namespace bendy::converter
