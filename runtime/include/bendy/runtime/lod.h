#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/model.h>

#include <cstdint>
#include <span>
#include <vector>

namespace BENDY_PUBLIC bendy {

/// A model at one level of detail: which vertices are in use ("alive"), and which triangles are drawn. Allocates all
/// its memory when it is made; starts at full detail. A model whose file has no collapse sequence has a single level:
/// everything.
class Lod {
public:
    explicit Lod(const Model& model);

    [[nodiscard]] const Model& model() const { return model_; }

    /// Keeps about this share of the model's triangles: 1 keeps all, 0 as few as the sequence allows. NaN: all.
    void set_share(float triangles);

    /// Number of triangles at this level, in all meshes; lines and points are not counted.
    [[nodiscard]] std::uint64_t triangles() const { return triangles_; }
    /// Number of vertices of a mesh that are alive: the first ones. `indices` refers to no others. 0 if the mesh does
    /// not exist.
    [[nodiscard]] std::uint32_t vertices(std::uint32_t mesh) const {
        return mesh < meshes_.size() ? meshes_[mesh].vertices : 0;
    }
    /// The mesh's index list at this level; `submeshes` are ranges of it. Empty if the mesh does not exist.
    [[nodiscard]] std::span<const std::uint32_t> indices(std::uint32_t mesh) const {
        if (mesh >= meshes_.size()) return {};
        return std::span(meshes_[mesh].indices).first(meshes_[mesh].corners);
    }
    [[nodiscard]] std::span<const Submesh> submeshes() const { return submeshes_; }

    /// Maximum deviation of the surface from the full one at this level in metres, as stated in the file; 0 at full
    /// detail and for a file that does not state it.
    [[nodiscard]] float error() const { return error_; }

private:
    struct MeshLevel {
        std::uint32_t vertices = 0;
        std::vector<std::uint32_t> indices;  // the first `corners` are those of this level
        std::size_t corners = 0;
        std::vector<std::uint32_t> all;         // at full detail
        std::vector<std::uint32_t> thresholds;  // one per drawn triangle: it exists while more vertices than that are
                                                // alive
        std::vector<std::uint32_t> counts;      // number of triangles alive at base vertices, base + 1, ...
        std::vector<std::uint32_t> targets;     // for each vertex from base on, the one that it collapses to
        std::vector<std::uint32_t> now;         // for each vertex, the one that it has collapsed to at this level
        const MeshCollapseView* collapse = nullptr;
    };

    void prepare(std::uint32_t mesh);
    [[nodiscard]] std::uint32_t vertices_at(std::uint32_t mesh, double level) const;
    [[nodiscard]] std::uint64_t triangles_at(double level) const;
    void make_list(std::uint32_t mesh);

    Model model_;
    std::vector<MeshLevel> meshes_;
    std::vector<Submesh> submeshes_;
    std::vector<std::uint32_t> first_submesh_;  // for each mesh, index into submeshes_; one more than meshes
    std::vector<std::uint32_t> place_;          // for each mesh, its place in the file's table of levels, or kNone
    std::uint64_t all_triangles_ = 0;
    std::uint64_t fixed_triangles_ = 0;  // of meshes without a collapse sequence
    std::uint64_t triangles_ = 0;
    float error_ = 0.0f;
};

}  // namespace bendy
