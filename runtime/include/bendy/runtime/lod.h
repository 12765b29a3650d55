#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/model.h>

#include <cstdint>
#include <span>
#include <vector>

namespace BENDY_PUBLIC bendy {

/// A model at one level of detail: which vertices are alive, and what is drawn of them. Allocates all that it needs
/// when it is made; starts at full detail. A model whose file has no collapse sequence has one level: all of it.
class Lod {
public:
    explicit Lod(const Model& model);

    [[nodiscard]] const Model& model() const { return model_; }

    /// Keeps about so many of the model's triangles: 1 all, 0 as few as the sequence goes. NaN: all.
    void set_share(float triangles);

    /// What there is of them now, all meshes; lines and points are not counted.
    [[nodiscard]] std::uint64_t triangles() const { return triangles_; }
    /// The first so many vertices of a mesh are alive, and all that `indices` names.
    [[nodiscard]] std::uint32_t vertices(std::uint32_t mesh) const { return meshes_[mesh].vertices; }
    /// The mesh's index list at this level; `submeshes` are ranges of it.
    [[nodiscard]] std::span<const std::uint32_t> indices(std::uint32_t mesh) const {
        return std::span(meshes_[mesh].indices).first(meshes_[mesh].corners);
    }
    [[nodiscard]] std::span<const Submesh> submeshes() const { return submeshes_; }

    /// How far, in metres, the surface may be from the full one at this level, by the file; 0 at full detail and for a
    /// file that does not say.
    [[nodiscard]] float error() const { return error_; }

private:
    struct MeshLevel {
        std::uint32_t vertices = 0;
        std::vector<std::uint32_t> indices;  // at this level the first `corners`
        std::size_t corners = 0;
        std::vector<std::uint32_t> all;         // at full detail
        std::vector<std::uint32_t> thresholds;  // of each triangle drawn: there while more vertices than that are alive
        std::vector<std::uint32_t> counts;      // triangles alive at base vertices, base + 1, ...
        std::vector<std::uint32_t> targets;     // of each vertex from base on the one that it collapses to
        std::vector<std::uint32_t> now;         // for each vertex the one that stands for it
        const MeshCollapseView* collapse = nullptr;
    };

    void prepare(std::uint32_t mesh);
    [[nodiscard]] std::uint32_t vertices_at(std::uint32_t mesh, double level) const;
    [[nodiscard]] std::uint64_t triangles_at(double level) const;
    void make_list(std::uint32_t mesh);

    Model model_;
    std::vector<MeshLevel> meshes_;
    std::vector<Submesh> submeshes_;
    std::vector<std::uint32_t> first_submesh_;  // of each mesh, in submeshes_; one more than meshes
    std::vector<std::uint32_t> place_;          // of each mesh in the file's table of levels, or kNone
    std::uint64_t all_triangles_ = 0;
    std::uint64_t fixed_triangles_ = 0;  // of meshes without a sequence
    std::uint64_t triangles_ = 0;
    float error_ = 0.0f;
};

}  // namespace bendy
