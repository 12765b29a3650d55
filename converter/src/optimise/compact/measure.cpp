#include "optimise/compact/measure.h"

#include "optimise/sample_limits.h"
#include "scene/evaluate.h"
#include "scene/frame_shapes.h"

#include <bendy/format/trig.h>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace bendy::converter {
namespace {

/// The farthest points of a set along 13 directions, in both senses.
class Extremes {
public:
    void add(const glm::dvec3& point) {
        if (points_.empty()) {
            points_.resize(2 * kDirections.size(), point);
            return;
        }
        for (std::size_t d = 0; d < kDirections.size(); ++d) {
            const double along = glm::dot(kDirections[d], point);
            if (along > glm::dot(kDirections[d], points_[2 * d])) points_[2 * d] = point;
            if (along < glm::dot(kDirections[d], points_[2 * d + 1])) points_[2 * d + 1] = point;
        }
    }
    void put_into(std::vector<glm::dvec3>& out) const {
        for (const glm::dvec3& point : points_) {
            if (std::find(out.begin(), out.end(), point) == out.end()) out.push_back(point);
        }
    }

private:
    static constexpr std::array<glm::dvec3, 13> kDirections{{{1, 0, 0},
                                                             {0, 1, 0},
                                                             {0, 0, 1},
                                                             {1, 1, 0},
                                                             {1, -1, 0},
                                                             {1, 0, 1},
                                                             {1, 0, -1},
                                                             {0, 1, 1},
                                                             {0, 1, -1},
                                                             {1, 1, 1},
                                                             {1, 1, -1},
                                                             {1, -1, 1},
                                                             {-1, 1, 1}}};
    std::vector<glm::dvec3> points_;
};

std::vector<Affine> rest_pose(const Scene& scene) {
    EvaluatedPose rest;
    evaluate_rest(scene, rest);
    return {rest.joints.begin(), rest.joints.end()};
}

/// Calls `visit` with each vertex at rest, and displaced by each target alone.
template <class Visit>
void for_each_place(const Mesh& mesh, std::size_t vertex, Visit visit) {
    const glm::dvec3 at(mesh.positions[vertex]);
    visit(at);
    for (const MorphTarget& target : mesh.targets) {
        if (target.positions.empty()) continue;
        const glm::dvec3 shift = shift_of(target, target.positions, mesh.positions, vertex);
        if (shift != glm::dvec3(0.0)) visit(at + shift);
    }
}

struct Found {
    std::vector<Extremes> extremes;  // per joint
    std::vector<bool> has_shell;     // per joint
    double skin_low = std::numeric_limits<double>::infinity();
    double skin_high = -std::numeric_limits<double>::infinity();
};

void add_mesh(const Scene& scene, const Mesh& mesh, const std::vector<Affine>& rest, Found& found) {
    const auto add = [&](std::uint32_t joint, const glm::dvec3& point) {
        found.has_shell[joint] = true;
        found.extremes[joint].add(point);
        const double height = rest[joint](point).y;
        found.skin_low = std::min(found.skin_low, height);
        found.skin_high = std::max(found.skin_high, height);
    };
    for (const std::uint32_t joint : mesh.palette.joints) found.has_shell[joint] = true;
    if (mesh.influences == 0 && mesh.joint >= scene.joints.size()) return;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        for_each_place(mesh, v, [&](const glm::dvec3& at) {
            if (mesh.influences == 0) add(mesh.joint, at);
            for (std::size_t i = 0; i < mesh.influences; ++i) {
                if (!(mesh.weights[v * mesh.influences + i] > 0.0f)) continue;
                const std::uint32_t bone = mesh.bones[v * mesh.influences + i];
                const glm::dvec4 point = glm::dmat4(mesh.palette.inverse_bind[bone]) * glm::dvec4(at, 1.0);
                add(mesh.palette.joints[bone], glm::dvec3(point));
            }
        });
    }
}

}  // namespace

std::vector<std::vector<glm::dvec3>> find_probes(const Scene& scene, Probes kind) {
    const std::vector<Affine> rest = rest_pose(scene);
    Found found{std::vector<Extremes>(rest.size()), std::vector<bool>(rest.size())};
    for (const Mesh& mesh : scene.meshes) add_mesh(scene, mesh, rest, found);
    for (const Clip& clip : scene.clips) {
        for (const Track& track : clip.tracks) {
            if (track.path != TrackPath::weights) found.has_shell[track.target] = true;
        }
    }
    for (std::size_t j = 0; j < rest.size(); ++j) {  // an object may be attached to a joint that moves with another one
        const std::uint32_t parent = scene.joints[j].parent;
        if (parent != kNone && found.has_shell[parent]) found.has_shell[j] = true;
    }
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (std::size_t j = 0; j < rest.size(); ++j) {
        if (!found.has_shell[j]) continue;
        low = std::min(low, rest[j].origin.y);
        high = std::max(high, rest[j].origin.y);
    }
    const double shell = kJointReach * std::max({high - low, found.skin_high - found.skin_low, height_at_rest(scene)});
    std::vector<std::vector<glm::dvec3>> probes(rest.size());
    for (std::size_t j = 0; j < rest.size(); ++j) {
        if (!found.has_shell[j]) continue;
        constexpr double kFlat = 1e-6;  // scale of a joint below which its points stay at its origin
        const double reach = shell / std::max(trig::cube_root(std::abs(glm::determinant(rest[j].linear))), kFlat);
        probes[j] = {{reach, 0.0, 0.0}, {0.0, reach, 0.0}, {0.0, 0.0, reach}};
        if (kind == Probes::skin_and_shell) found.extremes[j].put_into(probes[j]);
    }
    return probes;
}

namespace {

std::vector<float> times_of(const Clip& clip, std::size_t most_samples) {
    std::vector<float> times;
    const ClipSpan span = span_of(clip);
    const std::vector<float>* before = nullptr;
    for (const Track& track : clip.tracks) {
        if (track.path == TrackPath::weights || (before != nullptr && *before == track.times)) continue;
        times.insert(times.end(), track.times.begin(), track.times.end());
        before = &track.times;
    }
    const double length = double{span.end} - span.start;
    const double wanted = length * kSamplesPerSecond;
    const double count = std::min(wanted, static_cast<double>(most_samples));
    const double rate = count < wanted ? count / length : kSamplesPerSecond;
    for (std::size_t k = 1; k <= static_cast<std::size_t>(count); ++k)
        times.push_back(static_cast<float>(span.start + static_cast<double>(k) / rate));
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

/// Evaluates a PACK payload at any time; frames are decoded once if times ascend.
class PackedPlayer {
public:
    PackedPlayer(const Scene& scene, const PackedView& packed) : scene_(scene), packed_(packed) {}

    void set(float seconds, std::vector<Local>& pose) {
        const PackedMoment moment = packed_moment(packed_, seconds);
        if (frame_ != moment.frame) decode(moment.frame);
        for (const PackedGroup& group : groups_) {
            for (std::uint32_t t = 0; t < group.count; ++t) set_joint(group, t, moment.fraction, pose[group.joints[t]]);
        }
    }

private:
    void decode(std::uint32_t frame) {
        frame_ = frame;
        groups_.clear();
        PackedGroupReader reader(packed_, frame);
        for (PackedGroup group; reader.next(group);) groups_.push_back(group);
    }

    void set_joint(const PackedGroup& group, std::uint32_t t, double u, Local& local) const {
        const Transform& rest = scene_.joints[group.joints[t]].rest;
        const auto ends = [&](const auto& numbers) {
            return std::array<double, 3>{numbers[0][t], numbers[1][t], numbers[2][t]};
        };
        if (group.kind.path == TrackPath::rotation) {
            const std::array<float, 4> at_rest{rest.rotation.x, rest.rotation.y, rest.rotation.z, rest.rotation.w};
            const auto q = blend_packed_rotations(at_rest, ends(group.left), ends(group.right), u);
            local.rotation = glm::normalize(glm::dquat(static_cast<float>(q[3]), static_cast<float>(q[0]),
                                                       static_cast<float>(q[1]), static_cast<float>(q[2])));
            return;
        }
        const bool moves = group.kind.path == TrackPath::translation;
        for (int c = 0; c < 3; ++c) {
            const auto at = static_cast<std::size_t>(c);
            const double by = (1.0 - u) * group.left[at][t] + u * group.right[at][t];
            (moves ? local.translation : local.scale)[c] =
                static_cast<float>((moves ? rest.translation : rest.scale)[c] + by);
        }
    }

    const Scene& scene_;
    const PackedView& packed_;
    std::uint32_t frame_ = kNone;  // the decoded frame
    std::vector<PackedGroup> groups_;
};

}  // namespace

SourceMotion::SourceMotion(const Scene& scene, const Clip& clip, std::size_t most_samples, std::size_t most_bytes)
    : scene_(scene), clip_(clip), times_(times_of(clip, most_samples)) {
    for (const Joint& joint : scene.joints) rest_.push_back(local_of(joint.rest));
    const std::size_t joints = scene.joints.size();
    has_all_ = times_.size() <= most_bytes / (sizeof(Affine) * std::max<std::size_t>(joints, 1));
    poses_.resize(joints * (has_all_ ? times_.size() : 1));
    if (!has_all_) return;
    for (std::size_t k = 0; k < times_.size(); ++k)
        evaluate_at(times_[k], std::span(poses_).subspan(k * joints, joints));
}

std::span<const Affine> SourceMotion::pose(std::size_t k) {
    const std::size_t joints = rest_.size();
    if (has_all_) return std::span(poses_).subspan(k * joints, joints);
    evaluate_at(times_[k], poses_);
    return poses_;
}

void SourceMotion::evaluate_at(float seconds, std::span<Affine> out) {
    locals_ = rest_;
    for (const Track& track : clip_.tracks) {
        if (track.path == TrackPath::weights) continue;
        evaluate_track(track, seconds, value_);
        set_property(track.path, value_, locals_[track.target]);
    }
    place_joints(scene_.joints, locals_, out);
}

WorstError measure_packed(SourceMotion& source, const std::vector<bool>& is_replaced, const PackedView& packed,
                          const std::vector<std::vector<glm::dvec3>>& probes, double enough) {
    const Scene& scene = source.scene();
    const std::size_t joints = scene.joints.size();
    std::vector<Local> found(joints);
    std::vector<Affine> pose(joints);
    PackedPlayer player(scene, packed);
    WorstError worst;
    std::vector<double> value;
    for (std::size_t k = 0; k < source.times().size(); ++k) {
        const float time = source.times()[k];
        const std::span<const Affine> right = source.pose(k);
        found = source.rest();
        for (std::size_t t = 0; t < is_replaced.size(); ++t) {
            const Track& track = source.clip().tracks[t];
            if (is_replaced[t] || track.path == TrackPath::weights) continue;
            evaluate_track(track, time, value);
            set_property(track.path, value, found[track.target]);
        }
        player.set(time, found);
        place_joints(scene.joints, found, pose);
        for (std::size_t j = 0; j < joints; ++j) {
            const glm::dmat3 linear = right[j].linear - pose[j].linear;
            const glm::dvec3 origin = right[j].origin - pose[j].origin;
            for (const glm::dvec3& probe : probes[j]) {
                const double error = glm::length(linear * probe + origin);
                if (error > worst.metres || std::isnan(error))
                    worst = {std::isnan(error) ? INFINITY : error, static_cast<std::uint32_t>(j), time};
            }
        }
        if (worst.metres > enough) break;
    }
    return worst;
}

}  // namespace bendy::converter
