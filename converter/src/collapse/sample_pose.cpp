#include "collapse/sample_pose.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace bendy::converter {
namespace {

constexpr std::size_t kMostSamples = 120;
constexpr std::size_t kSamplesOfCycle = 12;
constexpr int kMadeUpPoses = 3;

glm::dmat4 local_matrix(const Transform& transform) {
    const glm::vec4& q = transform.rotation;
    const glm::dmat3 rotation = glm::mat3_cast(glm::normalize(glm::dquat(q.w, q.x, q.y, q.z)));
    const glm::dvec3 scale(transform.scale);
    const glm::dvec3 shear(transform.shear);
    const glm::dmat3 stretch(scale.x, 0.0, 0.0, shear.x, scale.y, 0.0, shear.y, shear.z, scale.z);
    glm::dmat4 matrix(rotation * stretch);
    matrix[3] = glm::dvec4(glm::dvec3(transform.translation), 1.0);
    return matrix;
}

std::vector<Transform> rest_transforms(const Scene& scene) {
    std::vector<Transform> transforms;
    transforms.reserve(scene.joints.size());
    for (const Joint& joint : scene.joints) transforms.push_back(joint.rest);
    return transforms;
}

ScenePose make_pose(const Scene& scene, std::span<const Transform> transforms) {
    ScenePose pose;
    pose.model_space.reserve(transforms.size());
    for (std::size_t joint = 0; joint < transforms.size(); ++joint) {
        const std::uint32_t parent = scene.joints[joint].parent;
        const glm::dmat4 local = local_matrix(transforms[joint]);
        pose.model_space.push_back(parent == kNone ? local : pose.model_space[parent] * local);
    }
    for (const Mesh& mesh : scene.meshes) {
        std::vector<float>& weights = pose.target_weights.emplace_back();
        for (const Target& target : mesh.targets) weights.push_back(target.rest_weight);
    }
    return pose;
}

/// The track's value at a time, held at its ends; `components` numbers.
std::vector<float> sample_track(const Track& track, float time) {
    const bool is_cubic = track.interpolation == Interpolation::cubic;
    const std::size_t stride = std::size_t{track.components} * (is_cubic ? 3 : 1);
    const std::size_t skip = is_cubic ? track.components : 0;
    const auto later = std::upper_bound(track.times.begin(), track.times.end(), time);
    const auto after = static_cast<std::size_t>(later - track.times.begin());
    const std::size_t from = after == 0 ? 0 : after - 1;
    const std::size_t to = std::min(after, track.times.size() - 1);
    float share = 0.0f;
    if (from != to && track.interpolation != Interpolation::step)
        share = (time - track.times[from]) / (track.times[to] - track.times[from]);
    const float* a = track.values.data() + from * stride + skip;
    const float* b = track.values.data() + to * stride + skip;
    float sign = 1.0f;
    if (track.path == TrackPath::rotation && a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] < 0.0f) sign = -1.0f;
    std::vector<float> value;
    for (std::uint32_t k = 0; k < track.components; ++k) value.push_back((1.0f - share) * a[k] + sign * share * b[k]);
    return value;
}

ScenePose sample_cycle(const Scene& scene, const Cycle& cycle, float time) {
    std::vector<Transform> transforms = rest_transforms(scene);
    for (const Track& track : cycle.tracks) {
        if (track.path == TrackPath::weights || track.target >= transforms.size()) continue;
        const std::vector<float> value = sample_track(track, time);
        Transform& transform = transforms[track.target];
        if (track.path == TrackPath::rotation) transform.rotation = {value[0], value[1], value[2], value[3]};
        if (track.path == TrackPath::translation) transform.translation = {value[0], value[1], value[2]};
        if (track.path == TrackPath::scale) transform.scale = {value[0], value[1], value[2]};
    }
    ScenePose pose = make_pose(scene, transforms);
    for (const Track& track : cycle.tracks) {
        if (track.path == TrackPath::weights && track.target < pose.target_weights.size())
            pose.target_weights[track.target] = sample_track(track, time);
    }
    return pose;
}

}  // namespace

ScenePose rest_pose(const Scene& scene) {
    return make_pose(scene, rest_transforms(scene));
}

std::vector<ScenePose> sample_cycles(const Scene& scene) {
    std::vector<ScenePose> poses;
    if (scene.cycles.empty()) return poses;
    const std::size_t samples = std::clamp<std::size_t>(kMostSamples / scene.cycles.size(), 1, kSamplesOfCycle);
    for (const Cycle& cycle : scene.cycles) {
        if (poses.size() >= kMostSamples || cycle.tracks.empty()) continue;
        float start = cycle.tracks.front().times.front();
        float end = cycle.tracks.front().times.back();
        for (const Track& track : cycle.tracks) {
            start = std::min(start, track.times.front());
            end = std::max(end, track.times.back());
        }
        for (std::size_t k = 0; k < samples; ++k) {
            const float share = (static_cast<float>(k) + 0.5f) / static_cast<float>(samples);
            poses.push_back(sample_cycle(scene, cycle, start + share * (end - start)));
        }
    }
    return poses;
}

std::vector<ScenePose> made_up_poses(const Scene& scene) {
    constexpr float kTurn = 0.35f;  // of a quaternion whose w is 1: up to some 60 degrees
    std::vector<ScenePose> poses;
    std::uint32_t state = 1;
    const auto random = [&state] {
        state = state * 1664525u + 1013904223u;  // Numerical Recipes' generator
        return static_cast<float>(state >> 8) / 8388608.0f - 1.0f;
    };
    for (int number = 0; number < kMadeUpPoses && !scene.joints.empty(); ++number) {
        std::vector<Transform> transforms = rest_transforms(scene);
        for (Transform& transform : transforms) {
            const glm::vec4& q = transform.rotation;
            const float x = kTurn * random();
            const float y = kTurn * random();
            const float z = kTurn * random();
            const glm::quat turned = glm::normalize(glm::quat(q.w, q.x, q.y, q.z) * glm::quat(1.0f, x, y, z));
            transform.rotation = {turned.x, turned.y, turned.z, turned.w};
        }
        poses.push_back(make_pose(scene, transforms));
    }
    return poses;
}

}  // namespace bendy::converter
