#include "optimise/compact/clip_frames.h"

#include "scene/evaluate.h"

#include <bendy/format/trig.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdint>

namespace bendy::converter {

glm::dvec3 log_near(const glm::dquat& q, const glm::dvec3& near) {
    constexpr double kTwoPi = 2.0 * trig::kPi;
    const double sign = q.w < 0.0 ? -1.0 : 1.0;
    const glm::dvec3 part(sign * q.x, sign * q.y, sign * q.z);
    const double sine = glm::length(part);
    const double angle = 2.0 * trig::atan2(sine, sign * q.w);
    if (sine < 1e-9) {
        const double length = glm::length(near);
        return length > trig::kPi ? near * (kTwoPi / length) : 2.0 * part;
    }
    const glm::dvec3 axis = part / sine;
    const glm::dvec3 other = axis * (angle - kTwoPi);
    const glm::dvec3 v = axis * angle;
    const glm::dvec3 a = v - near;
    const glm::dvec3 b = other - near;
    return glm::dot(a, a) <= glm::dot(b, b) ? v : other;
}

ClipFrames::ClipFrames(const Scene& scene, const Clip& clip, const Grid& grid) : scene_(scene), frames_(grid.frames) {
    const std::size_t joints = scene.joints.size();
    rest_.reserve(joints);
    for (const Joint& joint : scene.joints) rest_.push_back(local_of(joint.rest));
    locals_.resize(joints * frames_);
    vectors_.resize(joints * frames_);
    for (std::size_t f = 0; f < frames_; ++f)
        std::copy(rest_.begin(), rest_.end(), locals_.begin() + static_cast<std::ptrdiff_t>(f * joints));
    const double snap = grid.snap();
    std::vector<double> value;
    for (const Track& track : clip.tracks) {
        if (track.path == TrackPath::weights) continue;
        for (std::uint32_t f = 0; f < grid.frames; ++f) {
            evaluate_track(track, snapped(track, grid.time_of(f), snap), value);
            set_property(track.path, value, locals_[f * joints + track.target]);
        }
    }
    for (std::size_t j = 0; j < joints; ++j) {
        glm::dvec3 before(0.0);
        for (std::size_t f = 0; f < frames_; ++f) {
            const glm::dquat q = glm::conjugate(rest_[j].rotation) * locals_[f * joints + j].rotation;
            before = vectors_[f * joints + j] = log_near(q, before);
        }
    }
}

glm::dvec3 ClipFrames::relative(std::size_t frame, std::size_t joint, TrackPath path) const {
    switch (path) {
        case TrackPath::translation:
            return local(frame, joint).translation - rest_[joint].translation;
        case TrackPath::rotation:
            return vectors_[frame * rest_.size() + joint];
        default:
            return local(frame, joint).scale - rest_[joint].scale;
    }
}

void ClipFrames::place(std::size_t frame, std::span<Affine> out) const {
    place_joints(scene_.joints, std::span(locals_).subspan(frame * rest_.size(), rest_.size()), out);
}

}  // namespace bendy::converter
