#include "compact/measure.h"

#include "cycle_span.h"
#include "evaluate.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace bendy::converter {
namespace {

constexpr double kRate = 240.0;  // per second

std::vector<float> times_of(const Cycle& cycle) {
    std::vector<float> times;
    const CycleSpan span = span_of(cycle);
    for (const Track& track : cycle.tracks) {
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
        PackedWalk walk(packed_, frame);
        for (PackedGroup group; walk.next(group);) groups_.push_back(group);
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
    std::uint32_t frame_ = kNone;  // that is decoded
    std::vector<PackedGroup> groups_;
};

}  // namespace

WorstError measure_packed(const Scene& scene, const Cycle& source, const std::vector<bool>& is_replaced,
                          const PackedView& packed, const std::vector<std::vector<glm::dvec3>>& probes, double enough) {
    const std::size_t joints = scene.joints.size();
    std::vector<Local> rest;
    for (const Joint& joint : scene.joints) rest.push_back(local_of(joint.rest));
    std::vector<Local> right(joints);
    std::vector<Local> found(joints);
    std::vector<Affine> right_pose(joints);
    std::vector<Affine> found_pose(joints);
    PackedPlayer player(scene, packed);
    WorstError worst;
    std::vector<double> value;
    for (const float time : times_of(source)) {
        right = rest;
        found = rest;
        for (std::size_t k = 0; k < source.tracks.size(); ++k) {
            const Track& track = source.tracks[k];
            if (track.path == TrackPath::weights) continue;
            evaluate_track(track, time, value);
            set_property(track.path, value, right[track.target]);
            if (!is_replaced[k]) set_property(track.path, value, found[track.target]);
        }
        player.set(time, found);
        for (std::size_t j = 0; j < joints; ++j) {
            const std::uint32_t parent = scene.joints[j].parent;
            const glm::vec3& shear = scene.joints[j].rest.shear;
            right_pose[j] = to_affine(right[j], shear);
            found_pose[j] = to_affine(found[j], shear);
            if (parent != kNone) {
                right_pose[j] = right_pose[parent] * right_pose[j];
                found_pose[j] = found_pose[parent] * found_pose[j];
            }
            const glm::dmat3 linear = right_pose[j].linear - found_pose[j].linear;
            const glm::dvec3 origin = right_pose[j].origin - found_pose[j].origin;
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
