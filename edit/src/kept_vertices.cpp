#include "kept_vertices.h"

#include <algorithm>

namespace bendy::edit {
namespace {

/// Adds the vertices that kept vertices collapse to; returns true if that adds any.
bool add_collapse_targets(const MeshCollapseView& collapse, std::vector<bool>& stays) {
    bool adds = false;
    for (std::uint32_t v = collapse.vertices; v-- > collapse.base;) {  // targets have smaller numbers: one pass is
                                                                       // enough
        if (!stays[v] || stays[collapse.target(v)]) continue;
        stays[collapse.target(v)] = true;
        adds = true;
    }
    return adds;
}

}  // namespace

void keep_used_vertices(const ObjectView& object, Kept::Object& kept) {
    for (Kept::Mesh& mesh : kept.meshes) mesh.stays = false;
    for (const SubmeshView& submesh : object.skeleton.submeshes) {
        if (submesh.count == 0 || !kept.polygons[submesh.joint]) continue;
        const MeshView& mesh = object.meshes[submesh.mesh];
        Kept::Mesh& here = kept.meshes[submesh.mesh];
        here.stays = true;
        here.vertices.resize(mesh.vertices, false);
        for (std::uint32_t k = 0; k < submesh.count; ++k)
            here.vertices[mesh.indices->index(submesh.first + k, 0)] = true;
    }
    if (object.collapse) {
        for (const MeshCollapseView& collapse : object.collapse->meshes) {
            Kept::Mesh& here = kept.meshes[collapse.mesh];
            if (!here.stays) continue;
            const std::vector<bool> used = here.vertices;
            if (!add_collapse_targets(collapse, here.vertices) || !object.meshes[collapse.mesh].is_rigid()) continue;
            here.vertices = used;
            here.keeps_levels = false;
        }
    }
}

void keep_joints_of_vertices(const ObjectView& object, Kept::Object& kept) {
    for (std::size_t p = 0; p < object.meshes.size(); ++p) {
        const MeshView& mesh = object.meshes[p];
        if (!kept.meshes[p].stays || mesh.is_rigid()) continue;
        const std::vector<bool>& vertices = kept.meshes[p].vertices;
        for (std::uint32_t v = 0; v < vertices.size(); ++v) {
            if (!vertices[v]) continue;
            for (std::uint32_t k = 0; k < mesh.bones->components; ++k) {
                if (mesh.weights->number(v, k) != 0.0f)
                    kept.joints[mesh.palette.joints[mesh.bones->index(v, k)]] = true;
            }
        }
    }
}

}  // namespace bendy::edit
