#include "formats/bendy_file/mesh.h"

#include "optimise/passes/mesh_order.h"

#include <bendy/format/diagnostics.h>

#include <algorithm>
#include <span>
#include <string>
#include <utility>

namespace bendy::converter {
namespace {

/// Larger integers lose their last digits in a float.
constexpr std::uint32_t kLargestExact = 1u << 24;

std::vector<float> read_numbers(const StreamView& stream) {
    std::vector<float> numbers;
    numbers.reserve(std::size_t{stream.elements} * stream.components);
    for (std::uint32_t e = 0; e < stream.elements; ++e) {
        for (std::uint32_t c = 0; c < stream.components; ++c) numbers.push_back(stream.number(e, c));
    }
    return numbers;
}

template <class Vector>
std::vector<Vector> read_vectors(const StreamView& stream) {
    std::vector<Vector> vectors(stream.elements);
    stream.decode(vectors);
    return vectors;
}

class StoredMeshImporter {
public:
    StoredMeshImporter(const ChunkTree& tree, const MeshView& view, std::vector<const SubmeshView*> submeshes,
                       MeshParts parts, Budget& budget, Report& report)
        : tree_(tree),
          view_(view),
          polygons_(std::move(submeshes)),
          has_all_(parts == MeshParts::all),
          budget_(budget),
          report_(report) {}

    /// \param is_in_levels  it has a collapse sequence, which counts on the stored order
    Mesh import(bool is_in_levels) {
        mesh_.name = view_.name;
        mesh_.extras = view_.extras;
        mesh_.more = view_.more;
        mesh_.joint = view_.joint;
        read_streams();
        read_targets();
        if (has_all_) read_parts();
        if (view_.is_rigid()) {
            set_movers();
        } else {
            read_influences();
        }
        if (has_all_) check_order();
        if (!is_in_levels) restore_order();
        return std::move(mesh_);
    }

private:
    void take(std::uint64_t count, std::uint64_t size) { budget_.take(count, size, place(view_.chunk)); }
    [[nodiscard]] std::string place(std::uint32_t chunk) const {
        return chunk_path(tree_.bytes(), tree_[chunk].offset);
    }

    void read_streams() {
        take(view_.vertices, sizeof(glm::vec3) * 2 + sizeof(glm::vec4));
        mesh_.positions = read_vectors<glm::vec3>(view_.positions);
        if (!has_all_) return;
        if (view_.normals) mesh_.normals = read_vectors<glm::vec3>(*view_.normals);
        if (view_.tangents) mesh_.tangents = read_vectors<glm::vec4>(*view_.tangents);
        for (const StreamView& stream : view_.texture_coords) mesh_.texture_coords.push_back(read_stream({}, stream));
        for (const StreamView& stream : view_.colours) mesh_.colours.push_back(read_stream({}, stream));
        for (const AttributeView& attribute : view_.attributes) {
            if (attribute.name == kSourceVertex) continue;  // see restore_order
            mesh_.attributes.push_back(read_stream(std::string(attribute.name), attribute.values));
            warn_of_large_integers(attribute.values);
        }
    }

    Stream read_stream(std::string name, const StreamView& stream) {
        take(std::uint64_t{stream.elements} * stream.components, sizeof(float));
        return {std::move(name), stream.set, stream.components, read_numbers(stream)};
    }

    void warn_of_large_integers(const StreamView& stream) {
        if (stream.type != ComponentType::u32) return;
        for (std::uint32_t e = 0; e < stream.elements; ++e) {
            for (std::uint32_t c = 0; c < stream.components; ++c) {
                if (stream.index(e, c) <= kLargestExact) continue;
                report_.warn("integers past 2^24 are rounded to floats", place(stream.chunk));
                return;
            }
        }
    }

    static FrameGrid grid_of(std::span<const StreamBox> boxes) {
        return {{boxes[0].minimum, boxes[1].minimum, boxes[2].minimum}, {boxes[0].step, boxes[1].step, boxes[2].step}};
    }

    /// Restores the storage of frames: the grid, and normals as a list.
    void read_grid() {
        const bool is_listed = view_.normals && !view_.normals->list.empty();
        if (view_.positions.boxes.size() != 3 || view_.positions.type == ComponentType::u32) return;
        if (is_listed || view_.frames() > 1) mesh_.grid = grid_of(view_.positions.boxes);
    }

    /// The positions or normals of a frame, one per vertex.
    std::vector<glm::vec3> read_shape(const MorphTargetView& frame, const std::optional<StreamView>& stream) {
        if (!stream) return {};
        take(view_.vertices, sizeof(glm::vec3));
        std::vector<glm::vec3> shape(view_.vertices);
        for (std::uint32_t vertex = 0; vertex < view_.vertices; ++vertex)
            shape[vertex] = stream->vec3(frame.places->index(vertex, 0));
        return shape;
    }

    void read_targets() {
        read_grid();
        for (const MorphTargetView& view : view_.targets) {
            MorphTarget target;
            target.name = view.name;
            target.rest_weight = view.rest_weight;
            if (view.is_frame()) {
                target.is_frame = true;
                target.grid = grid_of(view.positions->boxes);
                target.positions = read_shape(view, view.positions);
                if (has_all_) target.normals = read_shape(view, view.normals);
                mesh_.targets.push_back(std::move(target));
                continue;
            }
            target.positions = read_displacements(view, view.positions);
            if (has_all_) {
                target.normals = read_displacements(view, view.normals);
                target.tangents = read_displacements(view, view.tangents);
            }
            mesh_.targets.push_back(std::move(target));
        }
    }

    /// One displacement per vertex: zero for vertices that the target does not move.
    std::vector<glm::vec3> read_displacements(const MorphTargetView& target, const std::optional<StreamView>& stream) {
        if (!stream) return {};
        take(view_.vertices, sizeof(glm::vec3));
        std::vector<glm::vec3> displacements(view_.vertices, glm::vec3(0.0f));
        for (std::uint32_t entry = 0; entry < stream->elements; ++entry) {
            const std::uint32_t vertex = target.vertices ? target.vertices->index(entry, 0) : entry;
            displacements[vertex] = stream->vec3(entry);
        }
        return displacements;
    }

    /// Collects the polygons in index list order; adjacent ones with the same material and topology form one part.
    void read_parts() {
        std::sort(polygons_.begin(), polygons_.end(),
                  [](const SubmeshView* a, const SubmeshView* b) { return a->first < b->first; });
        std::uint64_t used = 0;
        for (const SubmeshView* range : polygons_) {
            const bool continues = !mesh_.submeshes.empty() && mesh_.submeshes.back().material == range->material &&
                                   mesh_.submeshes.back().topology == range->topology;
            if (!continues) mesh_.submeshes.push_back({range->topology, range->material, {}});
            std::vector<std::uint32_t>& indices = mesh_.submeshes.back().indices;
            for (std::uint32_t k = 0; k < range->count; ++k)
                indices.push_back(view_.indices->index(range->first + k, 0));
            used += range->count;
        }
        if (view_.indices && used != view_.indices->elements) {
            report_.warn("indices of no polygon are left out", place(view_.indices->chunk),
                         view_.indices->elements - used);
        }
    }

    void read_influences() {
        const StreamView& bones = *view_.bones;
        mesh_.influences = bones.components;
        take(std::uint64_t{bones.elements} * bones.components, sizeof(float) + sizeof(std::uint32_t));
        mesh_.bones.reserve(std::size_t{bones.elements} * bones.components);
        for (std::uint32_t e = 0; e < bones.elements; ++e) {
            for (std::uint32_t c = 0; c < bones.components; ++c) mesh_.bones.push_back(bones.index(e, c));
        }
        mesh_.weights = read_numbers(*view_.weights);
        take(view_.palette.joints.size(), sizeof(glm::mat4) + sizeof(std::uint32_t));
        mesh_.palette.joints.assign(view_.palette.joints.begin(), view_.palette.joints.end());
        const auto inverse_bind = view_.palette.inverse_bind();
        mesh_.palette.inverse_bind.assign(inverse_bind.begin(), inverse_bind.end());
    }

    /// Determines the joint that moves each rigid vertex: the one whose polygons use it. A mesh of the scene has only
    /// one such joint; if there are several, each vertex gets one bone with full weight, which has the same effect.
    void set_movers() {
        std::vector<std::uint32_t> movers(view_.vertices, view_.joint);
        for (const SubmeshView* range : polygons_) {
            for (std::uint32_t k = 0; k < range->count; ++k)
                movers[view_.indices->index(range->first + k, 0)] = range->joint;
        }
        const bool is_one =
            std::all_of(movers.begin(), movers.end(), [&](std::uint32_t mover) { return mover == movers.front(); });
        if (is_one) {
            if (!movers.empty()) mesh_.joint = movers.front();
            return;
        }
        report_.warn("rigid mesh that several joints move is written as a skinned one", place(view_.chunk));
        // A vertex without a joint belongs to no polygon here, so any joint will do.
        for (std::uint32_t& mover : movers) mover = mover == kNone ? 0 : mover;
        std::vector<std::uint32_t> joints(movers);
        std::sort(joints.begin(), joints.end());
        joints.erase(std::unique(joints.begin(), joints.end()), joints.end());
        mesh_.influences = 1;
        mesh_.weights.assign(movers.size(), 1.0f);
        for (const std::uint32_t mover : movers) {
            const auto entry = std::lower_bound(joints.begin(), joints.end(), mover) - joints.begin();
            mesh_.bones.push_back(static_cast<std::uint32_t>(entry));
        }
        mesh_.palette.inverse_bind.assign(joints.size(), glm::mat4(1.0f));
        mesh_.palette.joints = std::move(joints);
    }

    /// Warns if writing the scene would change the order of polygons or their joints.
    void check_order() {
        const AssignedPolygons anew = assign_polygons(mesh_);
        std::size_t at = 0;
        bool is_same = true;
        for (const SubmeshView* range : polygons_) {
            if (range->count == 0) continue;
            is_same = is_same && at < anew.ranges.size() && anew.ranges[at].joint == range->joint &&
                      anew.ranges[at].first == range->first && anew.ranges[at].count == range->count;
            ++at;
        }
        if (!is_same || at != anew.ranges.size())
            report_.warn("polygons are reassigned to joints and reordered", place(view_.chunk));
    }

    void restore_order() {
        take(view_.vertices, sizeof(std::uint32_t));
        const std::vector<std::uint32_t> order = source_order(view_);
        if (!order.empty()) permute_vertices(mesh_, order);
    }

    const ChunkTree& tree_;
    const MeshView& view_;
    std::vector<const SubmeshView*> polygons_;
    bool has_all_;
    Budget& budget_;
    Report& report_;
    Mesh mesh_;
};

}  // namespace

void import_stored_meshes(const ChunkTree& tree, const ObjectView& object, MeshParts parts, Budget& budget,
                          Scene& scene, Report& report) {
    std::vector<std::vector<const SubmeshView*>> submeshes(object.meshes.size());
    for (const SubmeshView& range : object.skeleton.submeshes) submeshes[range.mesh].push_back(&range);
    for (std::size_t mesh = 0; mesh < object.meshes.size(); ++mesh) {
        StoredMeshImporter importer(tree, object.meshes[mesh], std::move(submeshes[mesh]), parts, budget, report);
        const bool is_in_levels =
            object.collapse && std::any_of(object.collapse->meshes.begin(), object.collapse->meshes.end(),
                                           [&](const MeshCollapseView& one) { return one.mesh == mesh; });
        scene.meshes.push_back(importer.import(is_in_levels));
    }
}

}  // namespace bendy::converter
