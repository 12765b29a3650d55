#include "scene/evaluate.h"

#include "scene/frame_shapes.h"
#include "scene/space.h"

#include <bendy/format/trig.h>

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace bendy::converter {
namespace {

using Quaternion = std::array<double, 4>;  // x y z w

double length_of(const double* numbers, std::size_t count) {
    double square = 0.0;
    for (std::size_t c = 0; c < count; ++c) square += numbers[c] * numbers[c];
    return std::sqrt(square);
}

void scale_to(double length, double* numbers, std::size_t count) {
    const double present = length_of(numbers, count);
    if (!(present > 0.0)) return;
    for (std::size_t c = 0; c < count; ++c) numbers[c] *= length / present;
}

constexpr double kShort = 1e-8;  // below this the chord replaces the arc

/// glTF's cubic spline between two keys `seconds` apart; a key is in-tangent, value, out-tangent.
double hermite(double value, double out_tangent, double in_tangent, double next, double u, double seconds) {
    const double rest = 1.0 - u;
    return rest * rest * (1.0 + 2.0 * u) * value + u * rest * rest * seconds * out_tangent +
           u * u * (3.0 - 2.0 * u) * next - u * u * rest * seconds * in_tangent;
}

/// T * R * U, see Transform.
glm::dmat4 to_matrix(const glm::dvec3& translation, const Quaternion& rotation, const glm::dvec3& scale,
                     const glm::dvec3& shear) {
    const auto [x, y, z, w] = rotation;
    const glm::dvec3 r0(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y));
    const glm::dvec3 r1(2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x));
    const glm::dvec3 r2(2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y));
    return {glm::dvec4(scale.x * r0, 0.0), glm::dvec4(shear.x * r0 + scale.y * r1, 0.0),
            glm::dvec4(shear.y * r0 + shear.z * r1 + scale.z * r2, 0.0), glm::dvec4(translation, 1.0)};
}

glm::dmat4 rest_matrix(const Transform& rest) {
    const glm::vec4& r = rest.rotation;
    return to_matrix(glm::dvec3(rest.translation), {r.x, r.y, r.z, r.w}, glm::dvec3(rest.scale),
                     glm::dvec3(rest.shear));
}

void rest_weights(const Scene& scene, EvaluatedPose& pose) {
    pose.morph_weights.resize(scene.meshes.size());
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        std::vector<double>& weights = pose.morph_weights[mesh];
        weights.clear();
        for (const MorphTarget& target : scene.meshes[mesh].targets) weights.push_back(target.rest_weight);
    }
}

/// The product of two matrices whose last rows are 0, 0, 0, 1.
glm::dmat4 product(const glm::dmat4& a, const glm::dmat4& b) {
    const glm::dvec3 x(a[0]);
    const glm::dvec3 y(a[1]);
    const glm::dvec3 z(a[2]);
    const auto turned = [&](const glm::dvec4& v) { return x * v.x + y * v.y + z * v.z; };
    return {glm::dvec4(turned(b[0]), 0.0), glm::dvec4(turned(b[1]), 0.0), glm::dvec4(turned(b[2]), 0.0),
            glm::dvec4(turned(b[3]) + glm::dvec3(a[3]), 1.0)};
}

/// \param locals  per joint
void to_model_space(const Scene& scene, const std::vector<glm::dmat4>& locals, EvaluatedPose& pose) {
    pose.joints.resize(locals.size());
    for (std::size_t joint = 0; joint < locals.size(); ++joint) {
        const std::uint32_t parent = scene.joints[joint].parent;
        pose.joints[joint] = parent == kNone ? locals[joint] : product(pose.joints[parent], locals[joint]);
    }
}

/// Whether the track has the same value at all times.
bool is_constant(const Track& track) {
    const std::size_t n = track.components;
    if (track.path == TrackPath::weights || track.interpolation == Interpolation::cubic) return false;
    return std::equal(track.values.begin() + static_cast<std::ptrdiff_t>(n), track.values.end(), track.values.begin());
}

/// The number of the first key after a time. \param near  the key before it or the one before that, if known
std::size_t first_after(std::span<const float> times, double seconds, std::size_t near) {
    for (std::size_t key = near; key < times.size() && key <= near + 1; ++key) {
        if (!(times[key] <= seconds)) break;
        if (key + 1 == times.size() || seconds < times[key + 1]) return key + 1;
    }
    return static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), seconds) - times.begin());
}

/// The key before a time, and the share of the interval after it.
struct Moment {
    std::size_t left = 0;
    double u = 0.0;
    double length = 0.0;    // of the interval, seconds
    bool is_at_key = true;  // on the left key, outside all keys, or stepped: the left key's value
};

Moment moment_of(const Track& track, double seconds, std::size_t near_key) {
    Moment moment;
    const std::size_t after = first_after(track.times, seconds, near_key);
    const std::size_t left = moment.left = after == 0 ? 0 : after - 1;
    moment.is_at_key = after == 0 || after == track.times.size() || track.times[left] == seconds ||
                       track.interpolation == Interpolation::step;
    if (moment.is_at_key) return moment;
    moment.length = double{track.times[left + 1]} - track.times[left];
    moment.u = (seconds - track.times[left]) / moment.length;
    return moment;
}

bool is_turning(const Track& track) {
    return track.path == TrackPath::rotation && track.interpolation == Interpolation::linear;
}

/// The arc from a key of a linear rotation to the next.
Arc arc_of(const Track& track, std::size_t key) {
    const auto rotation = [&](std::size_t k) {
        const float* const at = track.values.data() + k * 4;
        return Quaternion{at[0], at[1], at[2], at[3]};
    };
    return {rotation(key), rotation(key + 1)};
}

}  // namespace

Arc::Arc(const Quaternion& from, const Quaternion& to) : from_(from), to_(to), is_point_(from == to) {
    if (is_point_) return;
    from_length_ = length_of(from_.data(), 4);
    to_length_ = length_of(to_.data(), 4);
    double dot = 0.0;
    for (std::size_t c = 0; c < 4; ++c) dot += from_[c] * to_[c];
    if (dot < 0.0) {
        for (double& number : to_) number = -number;
    }
    scale_to(1.0, from_.data(), 4);
    scale_to(1.0, to_.data(), 4);
    Quaternion sum{};
    Quaternion difference{};
    for (std::size_t c = 0; c < 4; ++c) {
        sum[c] = from_[c] + to_[c];
        difference[c] = to_[c] - from_[c];
    }
    cosine_ = length_of(sum.data(), 4);
    sine_ = length_of(difference.data(), 4);
    if (sine_ > kShort) half_angle_ = trig::atan2(sine_, cosine_);
}

Quaternion Arc::at(double u) const {
    if (is_point_) return from_;
    double of_from = 1.0 - u;
    double of_to = u;
    if (sine_ > kShort) {
        const trig::SinCos part = trig::sin_cos(u * 2.0 * half_angle_);
        of_to = part.sin / (0.5 * sine_ * cosine_);
        of_from = part.cos - 0.25 * (cosine_ * cosine_ - sine_ * sine_) * of_to;
    }
    Quaternion result{};
    for (std::size_t c = 0; c < 4; ++c) result[c] = of_from * from_[c] + of_to * to_[c];
    scale_to((1.0 - u) * from_length_ + u * to_length_, result.data(), 4);
    return result;
}

void evaluate_track(const Track& track, double seconds, std::vector<double>& value) {
    std::size_t near_key = 0;
    evaluate_track(track, seconds, value, near_key);
}

void evaluate_track(const Track& track, double seconds, std::vector<double>& value, std::size_t& near_key) {
    const std::size_t n = track.components;
    const bool cubic = track.interpolation == Interpolation::cubic;
    const std::size_t per_key = cubic ? 3 * n : n;
    const auto at = [&](std::size_t key, std::size_t part, std::size_t c) {
        return double{track.values[key * per_key + part * n + c]};
    };
    const std::size_t middle = cubic ? 1 : 0;  // offset of the value within a key
    value.resize(n);

    const Moment moment = moment_of(track, seconds, near_key);
    const std::size_t left = near_key = moment.left;
    const double u = moment.u;
    if (moment.is_at_key) {
        for (std::size_t c = 0; c < n; ++c) value[c] = at(left, middle, c);
        if (cubic && track.path == TrackPath::rotation) scale_to(1.0, value.data(), n);
        return;
    }
    if (cubic) {
        for (std::size_t c = 0; c < n; ++c) {
            value[c] =
                hermite(at(left, 1, c), at(left, 2, c), at(left + 1, 0, c), at(left + 1, 1, c), u, moment.length);
        }
        if (track.path == TrackPath::rotation) scale_to(1.0, value.data(), n);
        return;
    }
    if (is_turning(track)) {
        const Quaternion result = arc_of(track, left).at(u);
        std::copy(result.begin(), result.end(), value.begin());
        return;
    }
    for (std::size_t c = 0; c < n; ++c) value[c] = (1.0 - u) * at(left, 0, c) + u * at(left + 1, 0, c);
}

void evaluate_rest(const Scene& scene, EvaluatedPose& pose) {
    rest_weights(scene, pose);
    std::vector<glm::dmat4> locals;
    locals.reserve(scene.joints.size());
    for (const Joint& joint : scene.joints) locals.push_back(rest_matrix(joint.rest));
    to_model_space(scene, locals, pose);
}

ClipEvaluator::ClipEvaluator(const Scene& scene, const Clip& clip) : scene_(scene), clip_(clip) {
    placements_.reserve(scene.joints.size());
    for (const Joint& joint : scene.joints) {
        const glm::vec4& r = joint.rest.rotation;
        placements_.push_back({glm::dvec3(joint.rest.translation), {r.x, r.y, r.z, r.w}, glm::dvec3(joint.rest.scale)});
    }
    EvaluatedPose unused;
    for (std::uint32_t number = 0; number < clip.tracks.size(); ++number) {
        const Track& track = clip.tracks[number];
        if (is_constant(track)) {
            evaluate_track(track, 0.0, value_);
            set(track, unused);
            continue;
        }
        moving_.push_back({number});
        if (track.path != TrackPath::weights) moved_.push_back(track.target);
    }
    std::sort(moved_.begin(), moved_.end());
    moved_.erase(std::unique(moved_.begin(), moved_.end()), moved_.end());
    locals_.resize(placements_.size());
    for (std::size_t joint = 0; joint < placements_.size(); ++joint) {
        const Placement& at = placements_[joint];
        locals_[joint] = to_matrix(at.translation, at.rotation, at.scale, glm::dvec3(scene.joints[joint].rest.shear));
    }
}

/// Takes over `value_`.
void ClipEvaluator::set(const Track& track, EvaluatedPose& pose) {
    switch (track.path) {
        case TrackPath::translation:
            placements_[track.target].translation = {value_[0], value_[1], value_[2]};
            break;
        case TrackPath::rotation:
            placements_[track.target].rotation = {value_[0], value_[1], value_[2], value_[3]};
            break;
        case TrackPath::scale:
            placements_[track.target].scale = {value_[0], value_[1], value_[2]};
            break;
        case TrackPath::weights:
            pose.morph_weights[track.target] = value_;
            break;
    }
}

void ClipEvaluator::at(double seconds, EvaluatedPose& pose) {
    rest_weights(scene_, pose);
    for (Moving& moving : moving_) {
        const Track& track = clip_.tracks[moving.track];
        if (is_turning(track)) {
            const Moment moment = moment_of(track, seconds, moving.near_key);
            if (!moment.is_at_key) {
                if (moving.arc_key != moment.left) moving.arc = arc_of(track, moment.left);
                moving.arc_key = moving.near_key = moment.left;
                placements_[track.target].rotation = moving.arc.at(moment.u);
                continue;
            }
        }
        evaluate_track(track, seconds, value_, moving.near_key);
        set(track, pose);
    }
    for (const Play& play : clip_.plays) {
        const FramePair pair = frames_at(clip_, play, seconds);
        std::vector<double>& weights = pose.morph_weights[play.mesh];
        const auto add = [&](std::uint32_t frame, double weight) {
            if (frame != 0) weights[first_frame(scene_.meshes[play.mesh]) + frame - 1] += weight;
        };
        add(pair.left, 1.0 - pair.fraction);
        add(pair.right, pair.fraction);
    }
    for (const std::uint32_t joint : moved_) {
        const Placement& at = placements_[joint];
        locals_[joint] = to_matrix(at.translation, at.rotation, at.scale, glm::dvec3(scene_.joints[joint].rest.shear));
    }
    if (!follows_) return to_model_space(scene_, locals_, pose);
    for (const Step& step : steps_) {
        glm::dmat4& place = pose.joints[step.joint];
        place = locals_[step.joint];
        if (step.skips_parent) place = product(to_carriers_[scene_.joints[step.joint].parent], place);
        if (step.above != kNone) place = product(pose.joints[step.above], place);
    }
}

void ClipEvaluator::follow(std::span<const std::uint32_t> moved, const std::vector<bool>& needed, EvaluatedPose& pose) {
    follows_ = true;
    const std::size_t joints = locals_.size();
    carriers_.assign(joints, kNone);
    for (const std::uint32_t joint : moved) carriers_[joint] = joint;
    to_carriers_.assign(joints, glm::dmat4(1.0));
    pose.joints.resize(joints);
    steps_.clear();
    std::vector<bool> is_known(joints);  // the pose has its place
    for (std::uint32_t joint = 0; joint < joints; ++joint) {
        const std::uint32_t parent = scene_.joints[joint].parent;
        if (carriers_[joint] == kNone) {
            if (parent != kNone) carriers_[joint] = carriers_[parent];
            to_carriers_[joint] = parent == kNone ? locals_[joint] : product(to_carriers_[parent], locals_[joint]);
        }
        is_known[joint] = carriers_[joint] == kNone || carriers_[joint] == joint || needed[joint];
        if (carriers_[joint] == kNone) {
            pose.joints[joint] = to_carriers_[joint];
        } else if (is_known[joint]) {
            const bool skips = parent != kNone && !is_known[parent];
            steps_.push_back({joint, skips ? carriers_[parent] : parent, skips});
        }
    }
}

void evaluate(const Scene& scene, const Clip& clip, double seconds, EvaluatedPose& pose) {
    ClipEvaluator(scene, clip).at(seconds, pose);
}

std::vector<glm::dvec3> evaluate_vertices(const Mesh& mesh, const std::vector<double>& morph_weights,
                                          const std::vector<glm::dmat4>& joints) {
    std::vector<glm::dvec3> vertices(mesh.positions.begin(), mesh.positions.end());
    for (std::size_t number = 0; number < morph_weights.size(); ++number) {
        if (morph_weights[number] == 0.0) continue;
        const MorphTarget& target = mesh.targets[number];
        for (std::size_t vertex = 0; vertex < target.positions.size(); ++vertex)
            vertices[vertex] += morph_weights[number] * shift_of(target, target.positions, mesh.positions, vertex);
    }
    std::vector<glm::dmat4> palette;
    for (std::size_t entry = 0; entry < mesh.palette.joints.size(); ++entry)
        palette.push_back(joints[mesh.palette.joints[entry]] * glm::dmat4(mesh.palette.inverse_bind[entry]));
    for (std::size_t vertex = 0; vertex < vertices.size(); ++vertex) {
        const glm::dvec4 point(vertices[vertex], 1.0);
        if (mesh.influences == 0) {
            if (mesh.joint != kNone) vertices[vertex] = glm::dvec3(joints[mesh.joint] * point);
            continue;
        }
        glm::dvec4 sum(0.0);
        for (std::size_t place = vertex * mesh.influences; place < (vertex + 1) * mesh.influences; ++place) {
            if (mesh.weights[place] == 0.0f) continue;
            sum += double{mesh.weights[place]} * (palette[mesh.bones[place]] * point);
        }
        vertices[vertex] = glm::dvec3(sum);
    }
    return vertices;
}

std::vector<EvaluatedPose> sample_poses(const Scene& scene, std::size_t most, std::size_t most_of_clip) {
    constexpr std::size_t kMostMatrices = std::size_t{1} << 18U;
    std::vector<EvaluatedPose> poses(1);
    evaluate_rest(scene, poses.front());
    most = std::min(most, kMostMatrices / std::max<std::size_t>(scene.joints.size(), 1));
    const std::size_t clips = std::min(scene.clips.size(), most);
    for (std::size_t c = 0; c < clips; ++c) {
        const ClipSpan span = span_of(scene.clips[c]);
        const std::size_t count = std::clamp<std::size_t>(most / clips, 1, most_of_clip);
        for (std::size_t k = 0; k < count; ++k) {
            const double share = count == 1 ? 0.5 : static_cast<double>(k) / static_cast<double>(count - 1);
            evaluate(scene, scene.clips[c], span.at(share), poses.emplace_back());
        }
    }
    return poses;
}

namespace {

/// The box's height, or its largest side if it is flat; 0 if empty.
double height_of(const Box<glm::dvec3>& box) {
    if (box.is_empty()) return 0.0;
    constexpr double kFlat = 1e-3;  // of the largest side
    const glm::dvec3 size = box.high - box.low;
    const double largest = std::max({size.x, size.y, size.z});
    return size.y > kFlat * largest ? size.y : largest;
}

void add_origins(const EvaluatedPose& pose, Box<glm::dvec3>& box) {
    for (const glm::dmat4& joint : pose.joints) box.add(glm::dvec3(joint[3]));
}

double height_of_joints(const Scene& scene, EvaluatedPose& pose) {
    if (scene.joints.empty()) return 0.0;
    Box<glm::dvec3> box;
    add_origins(pose, box);
    if (height_of(box) > 0.0) return height_of(box);
    constexpr int kSamples = 32;  // of a clip
    for (const Clip& clip : scene.clips) {
        const ClipSpan span = span_of(clip);
        for (int k = 0; k <= kSamples; ++k) {
            evaluate(scene, clip, span.at(static_cast<double>(k) / kSamples), pose);
            add_origins(pose, box);
        }
    }
    return height_of(box) > 0.0 ? height_of(box) : 1.0;
}

}  // namespace

double height_at_rest(const Scene& scene) {
    EvaluatedPose rest;
    evaluate_rest(scene, rest);
    Box<glm::dvec3> box;
    for (const Mesh& mesh : scene.meshes) {
        for (const glm::dvec3& posed : evaluate_vertices(mesh, {}, rest.joints)) box.add(posed);
    }
    return box.is_empty() ? height_of_joints(scene, rest) : height_of(box);
}

}  // namespace bendy::converter
