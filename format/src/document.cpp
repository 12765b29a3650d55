#include <bendy/format/document.h>

#include <bendy/format/bind_palette.h>
#include <bendy/format/chunk_reader.h>
#include <bendy/format/codec.h>
#include <bendy/format/read_record.h>
#include <bendy/format/text.h>

#include <algorithm>
#include <array>
#include <span>
#include <tuple>
#include <utility>

namespace bendy {
namespace {

std::optional<VersionRecord> read_version(const ChunkTree& tree, Faults& faults) {
    const auto version = read_child_record<VersionRecord>(tree, 0, FourCC("VERS"), faults);
    if (!version) return version;
    const std::uint64_t offset = offset_of(tree, 0, FourCC("VERS"));
    if (version->signature != kSignature) faults.add({ErrorCode::kSignature, offset});
    if (version->major != kVersionMajor)
        faults.add({ErrorCode::kUnsupportedVersion, offset, version->major, kVersionMajor});
    check_reserved(std::array{version->reserved}, offset, faults);
    const auto& generator = version->generator;
    const auto end = std::find(generator.begin(), generator.end(), 0);
    if (!is_utf8(as_text(std::as_bytes(std::span(generator.begin(), end))))) faults.add({ErrorCode::kNotUtf8, offset});
    check_reserved(std::span(end, generator.end()), offset, faults);
    return version;
}

std::size_t count_children(const ChunkTree& tree, std::uint32_t container, FourCC id) {
    std::size_t count = 0;
    for (const std::uint32_t number : tree.children(container)) count += tree[number].id == id ? 1 : 0;
    return count;
}

/// Computes the palettes whose matrices are derived from the rest pose. All of them together, including those of other
/// objects, may take no more memory than encoded leaves may; `entries` counts them through the file.
void derive_palettes(const ChunkTree& tree, ObjectView& object, std::uint64_t& entries, Faults& faults) {
    std::vector<glm::dmat4> rests;
    const std::uint64_t most = tree.bytes().size() * kMaxCodecRatio / sizeof(glm::mat4);
    for (MeshView& mesh : object.meshes) {
        PaletteView& palette = mesh.palette;
        if (!palette.is_derived) continue;
        if (entries > most) return;  // reported once
        entries += palette.joints.size();
        if (entries > most) {
            faults.add({ErrorCode::kCodecRatio, tree[palette.chunk].offset, entries, most});
            return;
        }
        if (rests.empty()) {
            std::vector<RestRecord> records;
            std::vector<std::uint32_t> parents;
            for (const JointView& joint : object.skeleton.joints) {
                records.push_back(joint.rest);
                parents.push_back(joint.parent);
            }
            rests = rest_matrices(records, parents);
        }
        palette.derived.reserve(palette.joints.size());
        for (const std::uint32_t joint : palette.joints)
            palette.derived.push_back(derive_inverse_bind(rests[joint], palette.stored.front()));
    }
}

/// Checks the submeshes of the joints against meshes and materials, and converts local material numbers to the
/// document's. `first_local` is the index of this object's first local material in the document.
void resolve_submeshes(const ChunkTree& tree, ObjectView& object, std::uint32_t global_materials,
                       std::uint32_t first_local, Faults& faults) {
    SkeletonView& skeleton = object.skeleton;
    for (SubmeshView& submesh : skeleton.submeshes) {
        const std::uint64_t offset = tree[submesh.chunk].offset;
        if (submesh.mesh >= object.meshes.size()) {
            faults.add({ErrorCode::kMeshRange, offset, submesh.mesh, object.meshes.size()});
            continue;
        }
        const MeshView& mesh = object.meshes[submesh.mesh];
        const std::uint32_t available = mesh.indices ? mesh.indices->elements : 0;
        const bool is_readable = mesh.indices || (mesh.has_info && tree.find(mesh.chunk, FourCC("INDX")) == kNone);
        if (!is_readable) continue;
        if (submesh.first > available || submesh.count > available - submesh.first) {
            faults.add({ErrorCode::kIndexRange, offset, std::uint64_t{submesh.first} + submesh.count, available});
        }
        if (submesh.material == kNone) continue;
        if ((submesh.material & kLocalMaterial) == 0) {
            if (submesh.material >= global_materials)
                faults.add({ErrorCode::kMaterialRange, offset, submesh.material, global_materials});
            continue;
        }
        const std::uint32_t local = submesh.material & ~kLocalMaterial;
        const std::uint32_t first = skeleton.first_local_material[submesh.joint];
        const std::size_t next = std::size_t{submesh.joint} + 1;
        const std::size_t end =
            next < skeleton.joints.size() ? skeleton.first_local_material[next] : skeleton.local_materials.size();
        if (local >= end - first) {
            faults.add({ErrorCode::kMaterialRange, offset, local, end - first});
            continue;
        }
        submesh.material = first_local + first + local;
    }
}

void check_rigid_sharing(const ChunkTree& tree, const MeshView& mesh, std::span<const SubmeshView* const> ranges,
                         Faults& faults) {
    std::vector<std::uint32_t> mover(mesh.vertices, kNone);
    for (const SubmeshView* range : ranges) {
        for (std::uint32_t k = 0; k < range->count; ++k) {
            const std::uint32_t vertex = mesh.indices->index(range->first + k, 0);
            if (mover[vertex] == kNone) mover[vertex] = range->joint;
            if (mover[vertex] == range->joint) continue;
            faults.add({ErrorCode::kRigidShared, tree[range->chunk].offset, vertex});
            return;
        }
    }
}

/// Checks that the ranges of a mesh do not overlap, so that iterating over all of them is linear in the mesh. In a
/// rigid mesh a vertex is moved by the joint whose submesh uses it, so it must not be used by two.
void check_ranges(const ChunkTree& tree, const ObjectView& object, Faults& faults) {
    std::vector<const SubmeshView*> ranges;
    for (const SubmeshView& submesh : object.skeleton.submeshes) {
        if (submesh.count != 0) ranges.push_back(&submesh);
    }
    std::stable_sort(ranges.begin(), ranges.end(), [](const SubmeshView* a, const SubmeshView* b) {
        return std::tie(a->mesh, a->first) < std::tie(b->mesh, b->first);
    });
    for (std::size_t i = 1; i < ranges.size(); ++i) {
        const SubmeshView& before = *ranges[i - 1];
        if (before.mesh == ranges[i]->mesh && ranges[i]->first - before.first < before.count) {
            faults.add({ErrorCode::kSubmeshOverlap, tree[ranges[i]->chunk].offset});
            return;
        }
    }
    for (auto begin = ranges.begin(); begin != ranges.end();) {
        const MeshView& mesh = object.meshes[(*begin)->mesh];
        const auto end =
            std::find_if(begin, ranges.end(), [&](const SubmeshView* range) { return range->mesh != (*begin)->mesh; });
        const bool one_joint =
            std::all_of(begin, end, [&](const SubmeshView* range) { return range->joint == (*begin)->joint; });
        const std::span same_mesh(&*begin, static_cast<std::size_t>(end - begin));
        if (mesh.is_rigid() && !one_joint) check_rigid_sharing(tree, mesh, same_mesh, faults);
        begin = end;
    }
}

void check_count(std::uint64_t stated, std::uint64_t found, std::uint64_t offset, Faults& faults) {
    if (stated != found) faults.add({ErrorCode::kCountMismatch, offset, stated, found});
}

}  // namespace

Document read_document(const ChunkTree& tree, Faults& faults) {
    Document document;
    const std::size_t faults_before = faults.count();
    check_grammar(tree, faults);
    document.version = read_version(tree, faults);
    document.bound = read_child_record<BoundRecord>(tree, 0, FourCC("BNDS"), faults);
    document.extras = read_text(tree, 0, FourCC("EXTR"), faults);
    document.extensions = read_text(tree, 0, FourCC("EXTN"), faults);
    document.more = read_text(tree, 0, FourCC("MORE"), faults);

    for (const std::uint32_t number : tree.children(0)) {
        if (tree[number].id == FourCC("TEXT") && tree[number].is_container())
            document.textures.push_back(read_texture(tree, number, faults));
    }
    check_texture_references(tree, document.textures, faults);
    const auto textures = static_cast<std::uint32_t>(document.textures.size());
    for (const std::uint32_t number : tree.children(0)) {
        if (tree[number].id == FourCC("MATE") && tree[number].is_container()) {
            document.materials.push_back(read_material(tree, number, textures, faults));
        }
    }
    document.global_materials = static_cast<std::uint32_t>(document.materials.size());

    std::uint64_t derived_entries = 0;
    for (const std::uint32_t number : tree.children(0)) {
        if (!(tree[number].id == FourCC("OBJE")) || !tree[number].is_container()) continue;
        ObjectView object;
        object.chunk = number;
        object.name = read_text(tree, number, FourCC("NAME"), faults);
        object.extras = read_text(tree, number, FourCC("EXTR"), faults);
        object.more = read_text(tree, number, FourCC("MORE"), faults);
        object.skeleton = read_skeleton(tree, number, faults);
        const auto joints = static_cast<std::uint32_t>(object.skeleton.joints.size());
        object.roles = read_roles(tree, number, joints, faults);
        object.standing_pose = read_standing_pose(tree, number, joints, faults);
        object.chains = read_chains(tree, number, object.skeleton, faults);
        object.meshes.reserve(count_children(tree, number, FourCC("VECT")));
        object.clips.reserve(count_children(tree, number, FourCC("CYCL")));
        for (const std::uint32_t child : tree.children(number)) {
            if (tree[child].id == FourCC("VECT") && tree[child].is_container())
                object.meshes.push_back(read_mesh(tree, child, joints, faults));
        }
        derive_palettes(tree, object, derived_entries, faults);
        for (const std::uint32_t child : tree.children(number)) {
            if (tree[child].id == FourCC("CYCL") && tree[child].is_container()) {
                const TargetCounts counts{joints, document.global_materials,
                                          static_cast<std::uint32_t>(object.meshes.size()), textures};
                object.clips.push_back(read_clip(tree, child, counts, object.meshes, faults));
            }
        }
        object.collapse = read_collapse(tree, number, object.meshes, faults);
        const auto first_local = static_cast<std::uint32_t>(document.materials.size());
        for (const std::uint32_t local : object.skeleton.local_materials) {
            document.materials.push_back(read_material(tree, local, textures, faults));
        }
        resolve_submeshes(tree, object, document.global_materials, first_local, faults);
        if (faults.count() == faults_before) check_ranges(tree, object, faults);
        document.objects.push_back(std::move(object));
    }
    return document;
}

void check_values(const ChunkTree& tree, const Document& document, Faults& faults) {
    std::uint64_t joints = 0;
    std::uint64_t meshes = 0;
    std::uint64_t vertices = 0;
    std::uint64_t clips = 0;
    if (document.bound) {
        const BoundRecord& bound = *document.bound;
        check_finite(std::array{bound.max_error, bound.measured_error, bound.height},
                     offset_of(tree, 0, FourCC("BNDS")), faults);
    }
    for (const TextureView& texture : document.textures) check_texture_values(tree, texture, faults);
    for (const MaterialView& material : document.materials) check_material_values(tree, material, faults);
    for (const ObjectView& object : document.objects) {
        check_skeleton_values(tree, object.skeleton, faults);
        for (const ChainView& chain : object.chains) check_chain_values(tree, chain, faults);
        for (const MeshView& mesh : object.meshes) {
            check_mesh_values(tree, mesh, faults);
            vertices += mesh.vertices;
        }
        for (const ClipView& clip : object.clips) check_clip_values(tree, clip, faults);
        joints += object.skeleton.joints.size();
        meshes += object.meshes.size();
        clips += object.clips.size();
    }
    if (!document.version) return;
    const std::uint64_t offset = offset_of(tree, 0, FourCC("VERS"));
    const VersionRecord& version = *document.version;
    check_count(version.objects, document.objects.size(), offset, faults);
    check_count(version.joints, joints, offset, faults);
    check_count(version.meshes, meshes, offset, faults);
    check_count(version.vertices, vertices, offset, faults);
    check_count(version.clips, clips, offset, faults);
    check_count(version.materials, document.materials.size(), offset, faults);
    check_count(version.textures, document.textures.size(), offset, faults);
}

Faults validate(Bytes bytes) {
    Faults faults;
    Result<ChunkTree> tree = read_chunk_tree(bytes);
    if (!tree) {
        faults.add(tree.error());
        return faults;
    }
    check_sums(*tree, faults);
    decode_leaves(*tree);
    const Document document = read_document(*tree, faults);
    check_values(*tree, document, faults);
    return faults;
}

}  // namespace bendy
