#include "near_poses.h"

#include "evaluate.h"

#include <bendy/format/trig.h>

#include <algorithm>
#include <cmath>

namespace bendy::converter {
namespace {

double sum_of_sizes(const glm::dvec3& v) {
    return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

glm::dquat key_rotation(const Track& track, std::size_t key) {
    const float* const at = &track.values[4 * key];
    return {at[3], at[0], at[1], at[2]};
}

/// Whether what is rounded in it stays small.
bool is_nearly_unit(const glm::dquat& q) {
    constexpr double kMost = 1e-3;
    return std::abs(glm::length(q) - 1.0) <= kMost;
}

bool is_turned_linearly(const Track& track) {
    return track.path == TrackPath::rotation && track.interpolation == Interpolation::linear;
}

}  // namespace

double largest_stretch_of(const glm::dmat3& m) {
    const double xy = std::abs(glm::dot(m[0], m[1]));
    const double xz = std::abs(glm::dot(m[0], m[2]));
    const double yz = std::abs(glm::dot(m[1], m[2]));
    // The sums of rows of its transpose times itself, whose eigenvalues are squared stretches.
    return std::sqrt(
        std::max({glm::dot(m[0], m[0]) + xy + xz, glm::dot(m[1], m[1]) + xy + yz, glm::dot(m[2], m[2]) + xz + yz}));
}

Arc::Arc(const glm::dquat& a, const glm::dquat& b) : length_a_(glm::length(a)), length_b_(glm::length(b)) {
    a_ = a / length_a_;
    b_ = b / length_b_;
    double cosine = glm::dot(a_, b_);
    if (cosine < 0.0) {
        b_ = -b_;
        cosine = -cosine;
    }
    constexpr double kRounding = 1e-9;
    is_sure_ = cosine > kRounding;
    angle_ = trig::acos(cosine);
    constexpr double kShort = 1e-7;  // chord and arc differ by the square of this
    per_sine_ = angle_ > kShort ? 1.0 / trig::sin_cos(angle_).sin : 0.0;
}

glm::dquat Arc::at(double u) const {
    double of_a = 1.0 - u;
    double of_b = u;
    const double length = of_a * length_a_ + of_b * length_b_;
    if (per_sine_ != 0.0) {
        of_a = trig::sin_cos(angle_ * (1.0 - u)).sin * per_sine_;
        of_b = trig::sin_cos(angle_ * u).sin * per_sine_;
    }
    of_a *= length;
    of_b *= length;
    return {of_a * a_.w + of_b * b_.w, of_a * a_.x + of_b * b_.x, of_a * a_.y + of_b * b_.y, of_a * a_.z + of_b * b_.z};
}

void place_nearly(const Local& local, const glm::vec3& shear, const Affine* parent, const Doubt* parent_doubt,
                  Affine& place, Doubt& doubt) {
    const Affine own = to_affine(local, shear);
    const double stretched = largest_stretch_of(own.linear);
    if (parent == nullptr) {
        place = own;
        doubt = {kRotationDoubt * stretched, kRotationDoubt * sum_of_sizes(own.origin)};
        return;
    }
    place = *parent * own;
    const double above = parent_doubt->linear + kRotationDoubt * largest_stretch_of(parent->linear);
    doubt.linear = above * stretched;
    doubt.origin =
        parent_doubt->origin + above * sum_of_sizes(own.origin) + kRotationDoubt * sum_of_sizes(place.origin);
}

NearPoses::NearPoses(const Scene& scene, const Clip& clip, Rotations rotations)
    : scene_(scene), rotations_(rotations), places_(scene.joints.size()), doubts_(scene.joints.size()) {
    rest_.reserve(scene.joints.size());
    for (const Joint& joint : scene.joints) {
        Local& local = rest_.emplace_back(local_of(joint.rest));
        const glm::vec4& q = joint.rest.rotation;
        const glm::dquat as_it_is(q.w, q.x, q.y, q.z);
        if (rotations == Rotations::as_they_are) local.rotation = as_it_is;
        is_sure_ = is_sure_ && is_nearly_unit(as_it_is);
    }
    for (const Track& track : clip.tracks) {
        if (track.path == TrackPath::weights) continue;
        cursors_.push_back({&track});
        if (!is_turned_linearly(track)) continue;
        for (std::size_t key = 0; key < track.times.size(); ++key)
            is_sure_ = is_sure_ && is_nearly_unit(key_rotation(track, key));
    }
}

glm::dquat NearPoses::rotation_at(Cursor& cursor, double seconds, bool& is_sure) const {
    const Track& track = *cursor.track;
    const std::vector<float>& times = track.times;
    if (seconds < times.front()) return key_rotation(track, 0);
    if (!(seconds < times.back())) return key_rotation(track, times.size() - 1);
    const auto is_between = [&](std::size_t key) { return times[key] <= seconds && seconds < times[key + 1]; };
    if (!cursor.has_arc || !is_between(cursor.key)) {
        const auto after = std::upper_bound(times.begin(), times.end(), seconds);
        cursor.key = static_cast<std::size_t>(after - times.begin()) - 1;
        cursor.arc = Arc(key_rotation(track, cursor.key), key_rotation(track, cursor.key + 1));
        cursor.has_arc = true;
    }
    is_sure = is_sure && cursor.arc.is_sure();
    const double length = double{times[cursor.key + 1]} - times[cursor.key];
    return cursor.arc.at((seconds - times[cursor.key]) / length);
}

void NearPoses::set(double seconds) {
    locals_ = rest_;
    bool is_sure = is_sure_;
    for (Cursor& cursor : cursors_) {
        const Track& track = *cursor.track;
        Local& local = locals_[track.target];
        if (is_turned_linearly(track)) {
            local.rotation = rotation_at(cursor, seconds, is_sure);
            if (rotations_ == Rotations::of_length_one) local.rotation = glm::normalize(local.rotation);
            continue;
        }
        evaluate_track(track, seconds, value_);
        if (track.path == TrackPath::rotation && rotations_ == Rotations::as_they_are) {
            local.rotation = glm::dquat(value_[3], value_[0], value_[1], value_[2]);
        } else {
            set_property(track.path, value_, local);
        }
    }
    for (std::size_t j = 0; j < locals_.size(); ++j) {
        const Joint& joint = scene_.joints[j];
        const bool is_root = joint.parent == kNone;
        place_nearly(locals_[j], joint.rest.shear, is_root ? nullptr : &places_[joint.parent],
                     is_root ? nullptr : &doubts_[joint.parent], places_[j], doubts_[j]);
        if (!is_sure) doubts_[j] = {INFINITY, INFINITY};
    }
}

}  // namespace bendy::converter
