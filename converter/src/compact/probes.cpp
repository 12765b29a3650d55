#include "compact/probes.h"

#include "evaluate.h"
#include "frame_shapes.h"
#include "size_at_rest.h"

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
    for (const Target& target : mesh.targets) {
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
    for (const Cycle& cycle : scene.cycles) {
        for (const Track& track : cycle.tracks) {
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

}  // namespace bendy::converter
