#include "optimise/collapse/find_shapes.h"

#include "scene/evaluate.h"
#include "scene/frame_shapes.h"
#include "scene/space.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace bendy::converter {
namespace {

constexpr std::size_t kMostPoses = 8;
constexpr std::size_t kMostCandidates = 120;  // poses to choose from
constexpr std::size_t kSamplesOfClip = 12;
constexpr int kMadeUpPoses = 3;
constexpr std::size_t kMostTargetGroups = 6;
constexpr std::size_t kMostShapeVertices = 6'000'000;  // shapes times vertices: bounds memory and time

/// Converts to floats; a vertex that is not finite keeps its stored position.
Shape pose_mesh(const Mesh& mesh, const std::vector<double>& morph_weights, const EvaluatedPose& pose) {
    const std::vector<glm::dvec3> vertices = evaluate_vertices(mesh, morph_weights, pose.joints);
    Shape shape;
    shape.reserve(vertices.size());
    for (std::size_t vertex = 0; vertex < vertices.size(); ++vertex) {
        const glm::vec3 rounded(vertices[vertex]);
        shape.push_back(is_finite(rounded) ? rounded : mesh.positions[vertex]);
    }
    return shape;
}

/// Poses for a scene without clips: every joint rotated by some tens of degrees, the same in each run.
std::vector<EvaluatedPose> make_up_poses(const Scene& scene, const EvaluatedPose& rest) {
    constexpr float kTurn = 0.35f;  // of a quaternion whose w is 1: up to some 60 degrees
    std::vector<EvaluatedPose> poses;
    std::uint32_t state = 1;
    const auto random = [&state] {
        state = state * 1664525u + 1013904223u;  // Numerical Recipes' generator
        return static_cast<float>(state >> 8) / 8388608.0f - 1.0f;
    };
    for (int number = 0; number < kMadeUpPoses && !scene.joints.empty(); ++number) {
        Scene turned;
        turned.joints = scene.joints;
        for (Joint& joint : turned.joints) {
            const glm::vec4& q = joint.rest.rotation;
            const float x = kTurn * random();
            const float y = kTurn * random();
            const float z = kTurn * random();
            const glm::quat r = glm::normalize(glm::quat(q.w, q.x, q.y, q.z) * glm::quat(1.0f, x, y, z));
            joint.rest.rotation = {r.x, r.y, r.z, r.w};
        }
        evaluate_rest(turned, poses.emplace_back());
        poses.back().morph_weights = rest.morph_weights;
    }
    return poses;
}

double distance(const EvaluatedPose& a, const EvaluatedPose& b) {
    double sum = 0.0;
    for (std::size_t joint = 0; joint < a.joints.size(); ++joint) {
        const glm::dvec3 apart = glm::dvec3(a.joints[joint][3] - b.joints[joint][3]);
        if (is_finite(apart)) sum += glm::dot(apart, apart);
    }
    return sum;
}

/// Chooses the poses that are farthest from one another and from `rest`, farthest first; each moves something.
std::vector<EvaluatedPose> choose_poses(const EvaluatedPose& rest, std::vector<EvaluatedPose> candidates) {
    std::vector<EvaluatedPose> chosen;
    std::vector<double> nearest;
    nearest.reserve(candidates.size());
    for (const EvaluatedPose& candidate : candidates) nearest.push_back(distance(rest, candidate));
    while (chosen.size() < kMostPoses && !candidates.empty()) {
        const auto farthest = std::max_element(nearest.begin(), nearest.end());
        if (!(*farthest > 0.0)) break;
        chosen.push_back(candidates[static_cast<std::size_t>(farthest - nearest.begin())]);
        for (std::size_t i = 0; i < candidates.size(); ++i)
            nearest[i] = std::min(nearest[i], distance(chosen.back(), candidates[i]));
    }
    return chosen;
}

/// Weights that show the targets in `groups` groups, every target in one; of frames, which are complete shapes, some
/// that are far apart.
std::vector<std::vector<double>> group_targets(const Mesh& mesh, std::size_t most) {
    const std::size_t groups = std::min(mesh.targets.size(), most);
    std::vector<std::vector<double>> weights(groups, std::vector<double>(mesh.targets.size(), 0.0));
    for (std::size_t target = 0; target < mesh.targets.size() && groups != 0; ++target)
        weights[target % groups][target] = 1.0;
    if (!has_frames(mesh)) return weights;
    const std::size_t first = first_frame(mesh);
    for (std::size_t group = 0; group < groups; ++group) {
        std::fill(weights[group].begin() + static_cast<std::ptrdiff_t>(first), weights[group].end(), 0.0);
        weights[group][first + group * (mesh.targets.size() - first) / groups] = 1.0;
    }
    return weights;
}

}  // namespace

std::vector<std::vector<Shape>> find_shapes(const Scene& scene) {
    std::vector<EvaluatedPose> candidates = sample_poses(scene, kMostCandidates, kSamplesOfClip);
    const EvaluatedPose rest = candidates.front();
    std::vector<EvaluatedPose> poses = choose_poses(rest, std::move(candidates));
    if (poses.empty()) poses = make_up_poses(scene, rest);
    std::vector<std::vector<Shape>> shapes;
    shapes.reserve(scene.meshes.size());
    for (std::size_t number = 0; number < scene.meshes.size(); ++number) {
        const Mesh& mesh = scene.meshes[number];
        const std::size_t most = kMostShapeVertices / std::max<std::size_t>(mesh.positions.size(), 1);
        std::vector<Shape>& list = shapes.emplace_back();
        list.push_back(pose_mesh(mesh, rest.morph_weights[number], rest));
        for (const std::vector<double>& weights : group_targets(mesh, kMostTargetGroups)) {
            if (list.size() < most) list.push_back(pose_mesh(mesh, weights, rest));
        }
        for (const EvaluatedPose& pose : poses) {
            if (mesh.influences != 0 && list.size() < most)
                list.push_back(pose_mesh(mesh, pose.morph_weights[number], pose));
        }
    }
    return shapes;
}

}  // namespace bendy::converter
