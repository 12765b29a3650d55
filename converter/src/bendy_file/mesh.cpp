#include "bendy_file/mesh.h"

#include "passes/mesh_order.h"

#include <bendy/format/diagnostics.h>

#include <algorithm>
#include <span>
#include <string>
#include <utility>

namespace bendy::converter {
namespace {

/// Numbers past this lose their last digits in a float.
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

class PoolImporter {
public:
    PoolImporter(const ChunkTree& tree, const PoolView& pool, std::vector<const PolygonView*> polygons, Budget& budget,
                 Report& report)
        : tree_(tree), pool_(pool), polygons_(std::move(polygons)), budget_(budget), report_(report) {}

    Mesh import() {
        mesh_.name = pool_.name;
        mesh_.extras = pool_.extras;
        mesh_.more = pool_.more;
        mesh_.joint = pool_.joint;
        read_streams();
        read_targets();
        read_parts();
        if (pool_.is_rigid()) {
            set_movers();
        } else {
            read_influences();
        }
        check_order();
        return std::move(mesh_);
    }

private:
    void take(std::uint64_t count, std::uint64_t size) { budget_.take(count, size, place(pool_.chunk)); }
    [[nodiscard]] std::string place(std::uint32_t chunk) const {
        return chunk_path(tree_.bytes(), tree_[chunk].offset);
    }

    void read_streams() {
        take(pool_.vertices, sizeof(glm::vec3) * 2 + sizeof(glm::vec4));
        mesh_.positions = read_vectors<glm::vec3>(pool_.positions);
        if (pool_.normals) mesh_.normals = read_vectors<glm::vec3>(*pool_.normals);
        if (pool_.tangents) mesh_.tangents = read_vectors<glm::vec4>(*pool_.tangents);
        for (const StreamView& stream : pool_.texture_coords) mesh_.texture_coords.push_back(read_stream({}, stream));
        for (const StreamView& stream : pool_.colours) mesh_.colours.push_back(read_stream({}, stream));
        for (const AttributeView& attribute : pool_.attributes) {
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

    /// What frames are written with is found again: a grid, and normals in a list.
    void read_grid() {
        const bool is_listed = pool_.normals && !pool_.normals->list.empty();
        if (pool_.positions.boxes.size() != 3 || pool_.positions.type == ComponentType::u32) return;
        if (is_listed || pool_.frames() > 1) mesh_.grid = grid_of(pool_.positions.boxes);
    }

    /// The places and normals of a frame, one a vertex.
    std::vector<glm::vec3> read_shape(const TargetView& frame, const std::optional<StreamView>& stream) {
        if (!stream) return {};
        take(pool_.vertices, sizeof(glm::vec3));
        std::vector<glm::vec3> shape(pool_.vertices);
        for (std::uint32_t vertex = 0; vertex < pool_.vertices; ++vertex)
            shape[vertex] = stream->vec3(frame.places->index(vertex, 0));
        return shape;
    }

    void read_targets() {
        read_grid();
        for (const TargetView& view : pool_.targets) {
            Target target;
            target.name = view.name;
            target.rest_weight = view.rest_weight;
            if (view.is_frame()) {
                target.is_frame = true;
                target.grid = grid_of(view.positions->boxes);
                target.positions = read_shape(view, view.positions);
                target.normals = read_shape(view, view.normals);
                mesh_.targets.push_back(std::move(target));
                continue;
            }
            target.positions = read_displacements(view, view.positions);
            target.normals = read_displacements(view, view.normals);
            target.tangents = read_displacements(view, view.tangents);
            mesh_.targets.push_back(std::move(target));
        }
    }

    /// One displacement a vertex: zero for those that the target does not touch.
    std::vector<glm::vec3> read_displacements(const TargetView& target, const std::optional<StreamView>& stream) {
        if (!stream) return {};
        take(pool_.vertices, sizeof(glm::vec3));
        std::vector<glm::vec3> displacements(pool_.vertices, glm::vec3(0.0f));
        for (std::uint32_t entry = 0; entry < stream->elements; ++entry) {
            const std::uint32_t vertex = target.vertices ? target.vertices->index(entry, 0) : entry;
            displacements[vertex] = stream->vec3(entry);
        }
        return displacements;
    }

    /// The polygons in the order of the index list; neighbours of one material and topology are one part.
    void read_parts() {
        std::sort(polygons_.begin(), polygons_.end(),
                  [](const PolygonView* a, const PolygonView* b) { return a->first < b->first; });
        std::uint64_t used = 0;
        for (const PolygonView* range : polygons_) {
            const bool continues = !mesh_.parts.empty() && mesh_.parts.back().material == range->material &&
                                   mesh_.parts.back().topology == range->topology;
            if (!continues) mesh_.parts.push_back({range->topology, range->material, {}});
            std::vector<std::uint32_t>& indices = mesh_.parts.back().indices;
            for (std::uint32_t k = 0; k < range->count; ++k)
                indices.push_back(pool_.indices->index(range->first + k, 0));
            used += range->count;
        }
        if (pool_.indices && used != pool_.indices->elements) {
            report_.warn("indices of no polygon are left out", place(pool_.indices->chunk),
                         pool_.indices->elements - used);
        }
    }

    void read_influences() {
        const StreamView& bones = *pool_.bones;
        mesh_.influences = bones.components;
        take(std::uint64_t{bones.elements} * bones.components, sizeof(float) + sizeof(std::uint32_t));
        mesh_.bones.reserve(std::size_t{bones.elements} * bones.components);
        for (std::uint32_t e = 0; e < bones.elements; ++e) {
            for (std::uint32_t c = 0; c < bones.components; ++c) mesh_.bones.push_back(bones.index(e, c));
        }
        mesh_.weights = read_numbers(*pool_.weights);
        take(pool_.palette.joints.size(), sizeof(glm::mat4) + sizeof(std::uint32_t));
        mesh_.palette.joints.assign(pool_.palette.joints.begin(), pool_.palette.joints.end());
        const auto inverse_bind = pool_.palette.inverse_bind();
        mesh_.palette.inverse_bind.assign(inverse_bind.begin(), inverse_bind.end());
    }

    /// A rigid vertex is moved by the joint whose polygons use it. A mesh of the scene has one such joint; where a pool
    /// has more, each vertex gets one bone with all the weight, which moves it in the same way.
    void set_movers() {
        std::vector<std::uint32_t> movers(pool_.vertices, pool_.joint);
        for (const PolygonView* range : polygons_) {
            for (std::uint32_t k = 0; k < range->count; ++k)
                movers[pool_.indices->index(range->first + k, 0)] = range->joint;
        }
        const bool is_one =
            std::all_of(movers.begin(), movers.end(), [&](std::uint32_t mover) { return mover == movers.front(); });
        if (is_one) {
            if (!movers.empty()) mesh_.joint = movers.front();
            return;
        }
        report_.warn("rigid pool that several joints move is written as a skinned one", place(pool_.chunk));
        // A vertex that nothing moves is of no polygon here, so any joint will do.
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

    /// The order and the owners of polygons are made anew when the scene is written.
    void check_order() {
        const AssignedPolygons anew = assign_polygons(mesh_);
        std::size_t at = 0;
        bool is_same = true;
        for (const PolygonView* range : polygons_) {
            if (range->count == 0) continue;
            is_same = is_same && at < anew.ranges.size() && anew.ranges[at].joint == range->joint &&
                      anew.ranges[at].first == range->first && anew.ranges[at].count == range->count;
            ++at;
        }
        if (!is_same || at != anew.ranges.size())
            report_.warn("polygons are given to joints, and ordered, anew", place(pool_.chunk));
    }

    const ChunkTree& tree_;
    const PoolView& pool_;
    std::vector<const PolygonView*> polygons_;
    Budget& budget_;
    Report& report_;
    Mesh mesh_;
};

}  // namespace

void import_pools(const ChunkTree& tree, const ObjectView& object, Budget& budget, Scene& scene, Report& report) {
    std::vector<std::vector<const PolygonView*>> polygons(object.pools.size());
    for (const PolygonView& range : object.skeleton.polygons) polygons[range.pool].push_back(&range);
    for (std::size_t pool = 0; pool < object.pools.size(); ++pool) {
        PoolImporter importer(tree, object.pools[pool], std::move(polygons[pool]), budget, report);
        scene.meshes.push_back(importer.import());
    }
}

}  // namespace bendy::converter
