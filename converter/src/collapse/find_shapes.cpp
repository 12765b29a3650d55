#include "collapse/find_shapes.h"

#include "collapse/sample_pose.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

namespace bendy::converter {
namespace {

constexpr std::size_t kMostPoses = 4;
constexpr std::size_t kMostTargetGroups = 6;
constexpr std::size_t kMostShapeVertices = 6'000'000;  // shapes times vertices: what memory and time allow

bool is_finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Displaced by the targets' weights, then moved by the pose.
Shape pose_mesh(const Mesh& mesh, const ScenePose& pose, const std::vector<float>& weights) {
    std::vector<glm::dmat4> palette;
    for (std::size_t entry = 0; entry < mesh.palette.joints.size(); ++entry)
        palette.push_back(pose.model_space[mesh.palette.joints[entry]] * glm::dmat4(mesh.palette.inverse_bind[entry]));
    const glm::dmat4 rigid = mesh.joint == kNone ? glm::dmat4(1.0) : pose.model_space[mesh.joint];
    Shape shape;
    shape.reserve(mesh.positions.size());
    for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
        glm::dvec3 position(mesh.positions[vertex]);
        for (std::size_t target = 0; target < weights.size(); ++target) {
            if (weights[target] != 0.0f && !mesh.targets[target].positions.empty())
                position += double{weights[target]} * glm::dvec3(mesh.targets[target].positions[vertex]);
        }
        glm::dvec3 posed(0.0);
        if (mesh.influences == 0) posed = glm::dvec3(rigid * glm::dvec4(position, 1.0));
        for (std::uint32_t k = 0; k < mesh.influences; ++k) {
            const std::size_t at = vertex * mesh.influences + k;
            if (mesh.weights[at] == 0.0f) continue;
            posed += double{mesh.weights[at]} * glm::dvec3(palette[mesh.bones[at]] * glm::dvec4(position, 1.0));
        }
        const glm::vec3 rounded(posed);
        shape.push_back(is_finite(rounded) ? rounded : mesh.positions[vertex]);
    }
    return shape;
}

double distance(const ScenePose& a, const ScenePose& b) {
    double sum = 0.0;
    for (std::size_t joint = 0; joint < a.model_space.size(); ++joint) {
        const glm::dvec3 apart = glm::dvec3(a.model_space[joint][3] - b.model_space[joint][3]);
        if (is_finite(apart)) sum += glm::dot(apart, apart);
    }
    return sum;
}

/// The poses that are farthest from one another and from `rest`, the farthest first; each moves something.
std::vector<ScenePose> choose_poses(const ScenePose& rest, std::vector<ScenePose> candidates) {
    std::vector<ScenePose> chosen;
    std::vector<double> nearest;
    nearest.reserve(candidates.size());
    for (const ScenePose& candidate : candidates) nearest.push_back(distance(rest, candidate));
    while (chosen.size() < kMostPoses && !candidates.empty()) {
        const auto farthest = std::max_element(nearest.begin(), nearest.end());
        if (!(*farthest > 0.0)) break;
        chosen.push_back(candidates[static_cast<std::size_t>(farthest - nearest.begin())]);
        for (std::size_t i = 0; i < candidates.size(); ++i)
            nearest[i] = std::min(nearest[i], distance(chosen.back(), candidates[i]));
    }
    return chosen;
}

/// Weights by which the targets are shown in `groups` groups, every target in one.
std::vector<std::vector<float>> group_targets(const Mesh& mesh, std::size_t most) {
    const std::size_t groups = std::min(mesh.targets.size(), most);
    std::vector<std::vector<float>> weights(groups, std::vector<float>(mesh.targets.size(), 0.0f));
    for (std::size_t target = 0; target < mesh.targets.size() && groups != 0; ++target)
        weights[target % groups][target] = 1.0f;
    return weights;
}

}  // namespace

std::vector<std::vector<Shape>> find_shapes(const Scene& scene) {
    const ScenePose rest = rest_pose(scene);
    std::vector<ScenePose> poses = choose_poses(rest, sample_cycles(scene));
    if (poses.empty()) poses = made_up_poses(scene);
    std::vector<std::vector<Shape>> shapes;
    shapes.reserve(scene.meshes.size());
    for (std::size_t number = 0; number < scene.meshes.size(); ++number) {
        const Mesh& mesh = scene.meshes[number];
        const std::size_t most = kMostShapeVertices / std::max<std::size_t>(mesh.positions.size(), 1);
        std::vector<Shape>& list = shapes.emplace_back();
        list.push_back(pose_mesh(mesh, rest, rest.target_weights[number]));
        for (const std::vector<float>& weights : group_targets(mesh, kMostTargetGroups)) {
            if (list.size() < most) list.push_back(pose_mesh(mesh, rest, weights));
        }
        for (const ScenePose& pose : poses) {
            if (mesh.influences != 0 && list.size() < most)
                list.push_back(pose_mesh(mesh, pose, pose.target_weights[number]));
        }
    }
    return shapes;
}

}  // namespace bendy::converter
