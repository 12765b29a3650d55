#include "mesh_end.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>

namespace bendy::converter {
namespace {

/// Calls `visit` with each vertex that the joint moves, in the joint's space.
template <class Visit>
void visit_vertices(const Scene& scene, std::uint32_t joint, Visit visit) {
    constexpr float kMost = 0.5f;  // of a vertex's weights
    for (const Mesh& mesh : scene.meshes) {
        if (mesh.influences == 0) {
            if (mesh.joint != joint) continue;
            for (const glm::vec3& position : mesh.positions) visit(glm::dvec3(position));
            continue;
        }
        const auto& joints = mesh.palette.joints;
        const auto found = std::find(joints.begin(), joints.end(), joint);
        if (found == joints.end()) continue;
        const auto bone = static_cast<std::uint32_t>(found - joints.begin());
        const glm::dmat4 to_joint(mesh.palette.inverse_bind[bone]);
        for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
            for (std::size_t n = vertex * mesh.influences; n < (vertex + 1) * mesh.influences; ++n) {
                if (mesh.bones[n] != bone || mesh.weights[n] < kMost) continue;
                visit(glm::dvec3(to_joint * glm::dvec4(glm::dvec3(mesh.positions[vertex]), 1.0)));
                break;
            }
        }
    }
}

}  // namespace

std::optional<glm::dvec3> find_mesh_end(const Scene& scene, const RestFrames& rest, std::uint32_t joint) {
    const glm::dvec3 start = rest.position(joint);
    glm::dvec3 sum(0.0);
    visit_vertices(scene, joint, [&](const glm::dvec3& vertex) { sum += rest.place(joint, vertex) - start; });
    const std::optional<glm::dvec3> direction = unit(sum);
    if (!direction) return std::nullopt;
    double farthest = 0.0;
    visit_vertices(scene, joint, [&](const glm::dvec3& vertex) {
        farthest = std::max(farthest, glm::dot(rest.place(joint, vertex) - start, *direction));
    });
    if (!(farthest > 0.0)) return std::nullopt;
    return start + farthest * *direction;
}

}  // namespace bendy::converter
