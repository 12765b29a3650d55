#include "compact/measure.h"

#include "evaluate.h"
#include "frame_shapes.h"
#include "near_poses.h"

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace bendy::converter {
namespace {

/// The farthest points of a set along 13 directions, both ways.
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

/// Calls `visit` with each vertex and, displaced by each target alone, its other places.
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
        constexpr double kFlat = 1e-6;  // a joint's scale below which its points do not move away from it
        const double reach = shell / std::max(std::cbrt(std::abs(glm::determinant(rest[j].linear))), kFlat);
        probes[j] = {{reach, 0.0, 0.0}, {0.0, reach, 0.0}, {0.0, 0.0, reach}};
        if (kind == Probes::skin_and_shell) found.extremes[j].put_into(probes[j]);
    }
    return probes;
}

namespace {

constexpr double kRate = 240.0;  // per second

std::vector<float> times_of(const Clip& clip) {
    std::vector<float> times;
    const ClipSpan span = span_of(clip);
    for (const Track& track : clip.tracks) {
        if (track.path == TrackPath::weights) continue;
        const std::size_t before = times.size();
        times.insert(times.end(), track.times.begin(), track.times.end());
        std::inplace_merge(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(before), times.end());
        times.erase(std::unique(times.begin(), times.end()), times.end());
    }
    const auto count = static_cast<std::size_t>(std::min((double{span.end} - span.start) * kRate, 1e8));
    const std::size_t before = times.size();
    for (std::size_t k = 1; k <= count; ++k)
        times.push_back(static_cast<float>(span.start + static_cast<double>(k) / kRate));
    std::inplace_merge(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(before), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

/// What PACK animates, at any moment; frames are decoded once while time goes on.
class PackedPlayer {
public:
    PackedPlayer(const Scene& scene, const PackedView& packed) : scene_(scene), packed_(packed) {}

    /// As the runtime's plain decoder has it.
    void set(float seconds, std::vector<Local>& pose) {
        const PackedMoment moment = go_to(seconds);
        for (const PackedGroup& group : groups_) {
            for (std::uint32_t t = 0; t < group.count; ++t) {
                Local& local = pose[group.joints[t]];
                if (group.kind.path == TrackPath::rotation) {
                    local.rotation = rotation_of(group, t, moment.fraction);
                } else {
                    set_vector(group, t, moment.fraction, local);
                }
            }
        }
    }

    /// The same, but rotations may be off by a small part of kRotationDoubt.
    void set_nearly(float seconds, std::vector<Local>& pose) {
        const PackedMoment moment = go_to(seconds);
        auto arc = arcs_.begin();
        for (const PackedGroup& group : groups_) {
            for (std::uint32_t t = 0; t < group.count; ++t) {
                Local& local = pose[group.joints[t]];
                if (group.kind.path == TrackPath::rotation) {
                    local.rotation = near_rotation_of(*arc++, group, t, moment.fraction);
                } else {
                    set_vector(group, t, moment.fraction, local);
                }
            }
        }
    }

private:
    PackedMoment go_to(float seconds) {
        const PackedMoment moment = packed_moment(packed_, seconds);
        if (frame_ == moment.frame) return moment;
        frame_ = moment.frame;
        groups_.clear();
        arcs_.clear();
        PackedGroupReader reader(packed_, frame_);
        for (PackedGroup group; reader.next(group);) {
            groups_.push_back(group);
            if (group.kind.path != TrackPath::rotation) continue;
            for (std::uint32_t t = 0; t < group.count; ++t) {
                const glm::dquat rest = local_of(scene_.joints[group.joints[t]].rest).rotation;
                arcs_.emplace_back(rest * turn_of(ends(group.left, t)), rest * turn_of(ends(group.right, t)));
            }
        }
        return moment;
    }

    static std::array<double, 3> ends(const std::array<std::array<float, kPackedGroup>, 3>& numbers, std::uint32_t t) {
        return {numbers[0][t], numbers[1][t], numbers[2][t]};
    }

    static glm::dquat turn_of(const std::array<double, 3>& vector) {
        const std::array<double, 4> q = packed_rotation(vector);
        return {q[3], q[0], q[1], q[2]};
    }

    [[nodiscard]] glm::dquat rotation_of(const PackedGroup& group, std::uint32_t t, double u) const {
        const glm::vec4& rest = scene_.joints[group.joints[t]].rest.rotation;
        const auto q =
            blend_packed_rotations({rest.x, rest.y, rest.z, rest.w}, ends(group.left, t), ends(group.right, t), u);
        return glm::normalize(glm::dquat(static_cast<float>(q[3]), static_cast<float>(q[0]), static_cast<float>(q[1]),
                                         static_cast<float>(q[2])));
    }

    [[nodiscard]] glm::dquat near_rotation_of(const Arc& arc, const PackedGroup& group, std::uint32_t t,
                                              double u) const {
        if (!arc.is_sure()) return rotation_of(group, t, u);
        glm::dquat q = arc.at(u);
        for (int c = 0; c < 4; ++c) {
            constexpr double kOff = 1e-13;   // at most, and enough to be rounded to another float
            constexpr double kSmall = 1e-6;  // floats below are so close that it does not matter
            const auto rounded = static_cast<float>(q[c] - kOff);
            if (rounded != static_cast<float>(q[c] + kOff) && std::abs(q[c]) > kSmall) return rotation_of(group, t, u);
            q[c] = static_cast<float>(q[c]);
        }
        return glm::normalize(q);
    }

    void set_vector(const PackedGroup& group, std::uint32_t t, double u, Local& local) const {
        const Transform& rest = scene_.joints[group.joints[t]].rest;
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
    std::uint32_t frame_ = kNone;  // that is decoded
    std::vector<PackedGroup> groups_;
    std::vector<Arc> arcs_;  // of the groups' rotations, one after another
};

/// A packed clip beside its source.
class PackedComparison {
public:
    PackedComparison(const Scene& scene, const Clip& source, const std::vector<bool>& is_replaced,
                     const PackedView& packed, const std::vector<std::vector<glm::dvec3>>& probes)
        : scene_(scene),
          source_(source),
          is_replaced_(is_replaced),
          probes_(probes),
          player_(scene, packed),
          near_source_(scene, source, NearPoses::Rotations::of_length_one),
          right_pose_(scene.joints.size()),
          found_pose_(scene.joints.size()),
          doubts_(scene.joints.size()) {
        for (const Joint& joint : scene.joints) rest_.push_back(local_of(joint.rest));
        for (const auto& points : probes) {
            double reach = 0.0;
            for (const glm::dvec3& point : points) reach = std::max(reach, glm::length(point));
            reaches_.push_back(reach);
        }
    }

    /// Raises `worst` to the worst probe at a time, if that is worse.
    void measure(float time, WorstError& worst) {
        if (may_be_worse(time, worst.metres)) measure_exactly(time, worst);
    }

private:
    /// False if no probe is off by more than `metres`: places that are nearly right leave no doubt.
    bool may_be_worse(float time, double metres) {
        near_source_.set(time);
        const auto right = near_source_.locals();
        found_ = rest_;
        for (std::size_t k = 0; k < source_.tracks.size(); ++k) {
            const Track& track = source_.tracks[k];
            if (track.path == TrackPath::weights || is_replaced_[k]) continue;
            take_property(track.path, right[track.target], found_[track.target]);
        }
        player_.set_nearly(time, found_);
        for (std::size_t j = 0; j < found_.size(); ++j) {
            const std::uint32_t parent = scene_.joints[j].parent;
            const bool is_root = parent == kNone;
            place_nearly(found_[j], scene_.joints[j].rest.shear, is_root ? nullptr : &found_pose_[parent],
                         is_root ? nullptr : &doubts_[parent], found_pose_[j], doubts_[j]);
            const Affine& place = near_source_.places()[j];
            const Doubt& doubt = near_source_.doubts()[j];
            const glm::dmat3 linear = place.linear - found_pose_[j].linear;
            const glm::dvec3 origin = place.origin - found_pose_[j].origin;
            const double left =
                metres - (doubt.linear + doubts_[j].linear) * reaches_[j] - doubt.origin - doubts_[j].origin;
            if (probes_[j].empty()) continue;
            if (!(left > 0.0)) return true;
            for (const glm::dvec3& probe : probes_[j]) {
                const glm::dvec3 off = linear * probe + origin;
                if (!(glm::dot(off, off) <= left * left)) return true;
            }
        }
        return false;
    }

    static void take_property(TrackPath path, const Local& from, Local& to) {
        if (path == TrackPath::translation) to.translation = from.translation;
        if (path == TrackPath::rotation) to.rotation = from.rotation;
        if (path == TrackPath::scale) to.scale = from.scale;
    }

    void measure_exactly(float time, WorstError& worst) {
        right_ = rest_;
        found_ = rest_;
        for (std::size_t k = 0; k < source_.tracks.size(); ++k) {
            const Track& track = source_.tracks[k];
            if (track.path == TrackPath::weights) continue;
            evaluate_track(track, time, value_);
            set_property(track.path, value_, right_[track.target]);
            if (!is_replaced_[k]) set_property(track.path, value_, found_[track.target]);
        }
        player_.set(time, found_);
        for (std::size_t j = 0; j < found_.size(); ++j) {
            const std::uint32_t parent = scene_.joints[j].parent;
            const glm::vec3& shear = scene_.joints[j].rest.shear;
            right_pose_[j] = to_affine(right_[j], shear);
            found_pose_[j] = to_affine(found_[j], shear);
            if (parent != kNone) {
                right_pose_[j] = right_pose_[parent] * right_pose_[j];
                found_pose_[j] = found_pose_[parent] * found_pose_[j];
            }
            const glm::dmat3 linear = right_pose_[j].linear - found_pose_[j].linear;
            const glm::dvec3 origin = right_pose_[j].origin - found_pose_[j].origin;
            for (const glm::dvec3& probe : probes_[j]) {
                const double error = glm::length(linear * probe + origin);
                if (error > worst.metres || std::isnan(error))
                    worst = {std::isnan(error) ? INFINITY : error, static_cast<std::uint32_t>(j), time};
            }
        }
    }

    const Scene& scene_;
    const Clip& source_;
    const std::vector<bool>& is_replaced_;
    const std::vector<std::vector<glm::dvec3>>& probes_;
    std::vector<double> reaches_;  // per joint: of its probes
    std::vector<Local> rest_;
    PackedPlayer player_;
    NearPoses near_source_;
    std::vector<Local> right_, found_;
    std::vector<Affine> right_pose_, found_pose_;
    std::vector<Doubt> doubts_;  // of what is found
    std::vector<double> value_;
};

}  // namespace

WorstError measure_packed(const Scene& scene, const Clip& source, const std::vector<bool>& is_replaced,
                          const PackedView& packed, const std::vector<std::vector<glm::dvec3>>& probes, double enough) {
    PackedComparison comparison(scene, source, is_replaced, packed, probes);
    WorstError worst;
    for (const float time : times_of(source)) {
        comparison.measure(time, worst);
        if (worst.metres > enough) break;
    }
    return worst;
}

}  // namespace bendy::converter
