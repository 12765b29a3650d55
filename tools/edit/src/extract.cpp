#include <bendy/edit/edit.h>

#include "keep_only.h"

#include <algorithm>
#include <span>
#include <string>
#include <utility>

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

/// Marks in `kept` the vertices of each mesh that the submeshes of these joints use, and those that they collapse to; a
/// mesh without such submeshes is removed. A rigid mesh whose vertices collapse to vertices that are no longer used
/// loses its levels of detail.
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

/// Marks the joints that influence a kept vertex.
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

struct Found {
    std::size_t object = 0;
    std::uint32_t joint = 0;
};

Result<Found, Problem> find_joint(const Document& document, std::string_view wanted) {
    if (document.objects.empty()) return Problem{"there is no object, so no joint"};
    std::vector<std::string_view> names;
    for (const ObjectView& object : document.objects) {
        for (const JointView& joint : object.skeleton.joints) names.push_back(joint.name);
    }
    const auto found = find_named(names, wanted, "joint");
    if (!found) return found.error();
    if (found->size() > 1) {
        return Problem{std::to_string(found->size()) + " joints are called \"" + std::string(wanted) + "\": " +
                       list_names(names, *found) + "; a number says which: #" + std::to_string(found->front())};
    }
    std::size_t joint = found->front();
    std::size_t object = 0;
    while (joint >= document.objects[object].skeleton.joints.size())
        joint -= document.objects[object++].skeleton.joints.size();
    return Found{object, static_cast<std::uint32_t>(joint)};
}

/// Returns the first joint after all descendants of this one.
std::uint32_t end_of(const SkeletonView& skeleton, std::uint32_t joint) {
    std::vector<bool> is_below(skeleton.joints.size());
    is_below[joint] = true;
    std::uint32_t end = joint + 1;
    for (; end < is_below.size(); ++end) {
        const std::uint32_t parent = skeleton.joints[end].parent;
        if (parent == kNone || !is_below[parent]) break;
        is_below[end] = true;
    }
    return end;
}

void keep_parents(const SkeletonView& skeleton, std::vector<bool>& stays) {
    for (std::size_t joint = stays.size(); joint-- > 0;) {
        const std::uint32_t parent = skeleton.joints[joint].parent;
        if (stays[joint] && parent != kNone) stays[parent] = true;
    }
}

/// Marks the materials of the polygons that stay, and the textures that those materials, or the joints' own, use.
void keep_used_surfaces(const Source& source, std::size_t object_number, Kept& kept) {
    const ObjectView& object = source.document.objects[object_number];
    const Kept::Object& here = kept.objects[object_number];
    std::vector<bool> used(source.document.materials.size());
    std::size_t local = source.document.global_materials;
    for (std::size_t k = 0; k < object_number; ++k) local += source.document.objects[k].skeleton.local_materials.size();
    for (std::size_t j = 0; j < here.joints.size(); ++j) {
        const auto& firsts = object.skeleton.first_local_material;
        const std::size_t next = j + 1 < firsts.size() ? firsts[j + 1] : object.skeleton.local_materials.size();
        for (std::size_t k = firsts[j]; k < next; ++k) used[local + k] = here.polygons[j];
    }
    for (const SubmeshView& submesh : object.skeleton.submeshes) {
        if (here.polygons[submesh.joint] && submesh.material != kNone) used[submesh.material] = true;
    }
    std::copy_n(used.begin(), kept.materials.size(), kept.materials.begin());
    kept.textures.assign(kept.textures.size(), false);
    for (std::size_t m = 0; m < used.size(); ++m) {
        if (!used[m]) continue;
        const MaterialView& material = source.document.materials[m];
        const SurfaceRecord& surface = material.surface;
        for (const TextureUseRecord& use :
             {surface.base_colour_texture, surface.metallic_roughness_texture, surface.normal_texture,
              surface.occlusion_texture, surface.emissive_texture}) {
            if (use.texture != kNone) kept.textures[use.texture] = true;
        }
        for (const std::uint32_t number : texture_numbers(material.extensions)) {
            if (number < kept.textures.size()) kept.textures[number] = true;
        }
    }
}

std::string counted(std::size_t stays, std::size_t of, const char* one, const char* many) {
    return std::to_string(stays) + " of " + std::to_string(of) + ' ' + (of == 1 ? one : many);
}

std::size_t count(const std::vector<bool>& stays) {
    return static_cast<std::size_t>(std::count(stays.begin(), stays.end(), true));
}

std::vector<std::size_t> those_without(const std::vector<bool>& stays) {
    std::vector<std::size_t> numbers;
    for (std::size_t k = 0; k < stays.size(); ++k) {
        if (!stays[k]) numbers.push_back(k);
    }
    return numbers;
}

void tell(const Source& source, const Found& found, const Kept& kept, Log& log) {
    const ObjectView& object = source.document.objects[found.object];
    const Kept::Object& here = kept.objects[found.object];
    const auto names = names_of(object.skeleton.joints);
    std::uint64_t vertices = 0;
    std::uint64_t of = 0;
    std::vector<bool> meshes;
    for (std::size_t p = 0; p < object.meshes.size(); ++p) {
        meshes.push_back(here.meshes[p].stays);
        of += object.meshes[p].vertices;
        if (!here.meshes[p].stays) continue;
        vertices += here.meshes[p].vertices.empty() ? object.meshes[p].vertices : count(here.meshes[p].vertices);
        if (!here.meshes[p].keeps_levels)
            log.warnings.push_back("mesh \"" + std::string(object.meshes[p].name) + "\" keeps no levels of detail");
    }
    log.done.push_back("extracted " + counted(count(here.polygons), names.size(), "joint", "joints") + ", " +
                       counted(vertices, of, "vertex", "vertices"));
    std::vector<std::size_t> bare;
    for (std::size_t j = 0; j < here.joints.size(); ++j) {
        if (here.joints[j] && !here.polygons[j]) bare.push_back(j);
    }
    if (!bare.empty()) log.done.push_back("joints that stay without polygons: " + list_names(names, bare));
    const auto tell_gone = [&](const std::vector<bool>& stays, std::span<const std::string_view> all,
                               const char* what) {
        if (const auto gone = those_without(stays); !gone.empty())
            log.done.push_back(std::string(what) + " left out: " + list_names(all, gone));
    };
    tell_gone(meshes, names_of(object.meshes), "meshes");
    tell_gone(here.chains, names_of(object.chains), "chains");
    if (kept.objects.size() > 1)
        log.warnings.push_back("other objects left out: " + std::to_string(kept.objects.size() - 1));
    if (vertices == 0) log.warnings.emplace_back("no polygon belongs to these joints: the file has no vertices");
}

}  // namespace

Edited extract(Bytes file, std::string_view joint, Log& log) {
    const auto source = open_source(file);
    if (!source) return source.error();
    const auto found = find_joint(source->document, joint);
    if (!found) return found.error();
    const ObjectView& object = source->document.objects[found->object];
    const std::uint32_t end = end_of(object.skeleton, found->joint);
    const auto is_inside = [&](std::uint32_t number) { return number >= found->joint && number < end; };

    Kept kept = everything(source->document);
    for (std::size_t k = 0; k < kept.objects.size(); ++k) kept.objects[k].stays = k == found->object;
    Kept::Object& here = kept.objects[found->object];
    for (std::uint32_t j = 0; j < here.joints.size(); ++j) here.joints[j] = here.polygons[j] = is_inside(j);
    keep_used_vertices(object, here);
    keep_joints_of_vertices(object, here);
    keep_parents(object.skeleton, here.joints);
    for (std::size_t k = 0; k < object.chains.size(); ++k)  // the links lie between start and effector
        here.chains[k] = is_inside(object.chains[k].record.start);
    keep_used_surfaces(*source, found->object, kept);

    Rewrite rewrite(source->tree);
    if (const auto updated = keep_only(*source, kept, rewrite, log); !updated) return updated.error();
    tell(*source, *found, kept, log);
    return finish(rewrite);
}

}  // namespace bendy::edit
