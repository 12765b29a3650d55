#include "compact/measure_skin.h"

#include "compact/sample_poses.h"

#include <glm/ext/matrix_double4x4.hpp>
#include <glm/ext/vector_double3.hpp>

#include <cmath>

namespace bendy::converter {
namespace {

glm::dvec3 position_of(const Mesh& mesh, std::size_t vertex, bool has_targets) {
    glm::dvec3 position = mesh.positions[vertex];
    if (!has_targets) return position;
    for (const Target& target : mesh.targets) {
        if (!target.positions.empty()) position += double{target.rest_weight} * glm::dvec3(target.positions[vertex]);
    }
    return position;
}

glm::dvec3 posed(const Mesh& mesh, std::size_t vertex, const std::vector<glm::dmat4>& pose, bool has_targets) {
    const glm::dvec4 position(position_of(mesh, vertex, has_targets), 1.0);
    if (mesh.influences == 0)
        return mesh.joint == kNone ? glm::dvec3(position) : glm::dvec3(pose[mesh.joint] * position);
    glm::dvec3 sum(0.0);
    for (std::size_t k = 0; k < mesh.influences; ++k) {
        const std::size_t at = vertex * mesh.influences + k;
        if (mesh.weights[at] == 0.0f) continue;
        const std::uint32_t bone = mesh.bones[at];
        const glm::dvec4 bound = glm::dmat4(mesh.palette.inverse_bind[bone]) * position;
        sum += double{mesh.weights[at]} * glm::dvec3(pose[mesh.palette.joints[bone]] * bound);
    }
    return sum;
}

}  // namespace

SkinError measure_skin(const Scene& exact, const Scene& compact, const CompactGeometry& geometry) {
    SkinError worst;
    const auto exact_poses = sample_poses(exact);
    const auto compact_poses = sample_poses(compact);
    for (std::size_t number = 0; number < exact.meshes.size(); ++number) {
        const Mesh& source = exact.meshes[number];
        const Mesh& mesh = compact.meshes[number];
        const auto& vertex_of = geometry.meshes[number].vertex_of;
        for (std::size_t pose = 0; pose < exact_poses.size(); ++pose) {
            for (std::size_t vertex = 0; vertex < source.positions.size(); ++vertex) {
                const glm::dvec3 away = posed(source, vertex, exact_poses[pose], pose == 0) -
                                        posed(mesh, vertex_of[vertex], compact_poses[pose], pose == 0);
                const double distance = std::sqrt(away.x * away.x + away.y * away.y + away.z * away.z);
                if (!(distance > worst.metres)) continue;
                worst.metres = distance;
                worst.place = "mesh " + std::to_string(number) + (source.name.empty() ? "" : " " + source.name) +
                              ", vertex " + std::to_string(vertex) +
                              (pose == 0 ? ", at rest" : ", in pose " + std::to_string(pose));
            }
        }
    }
    return worst;
}

}  // namespace bendy::converter
