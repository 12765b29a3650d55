#pragma once

#include <bendy/runtime/model.h>

#include <cstdint>
#include <span>
#include <vector>

namespace bendy {

/// A model at one level of detail: which vertices are alive, and what is drawn of them. Allocates all that it needs
/// when it is made; starts at full detail. The model must outlive it where it stands. A model whose file has no
/// collapse sequence has one level: all of it.
class Lod {
public:
    explicit Lod(const Model& model);

    /// Keeps about so many of the model's triangles: 1 all, 0 as few as the sequence goes. NaN: all.
    void set_share(float triangles);

    /// What there is of them now, all pools; lines and points are not counted.
    [[nodiscard]] std::uint64_t triangles() const { return triangles_; }
    /// The first so many vertices of a pool are alive, and all that `indices` names.
    [[nodiscard]] std::uint32_t vertices(std::uint32_t pool) const { return pools_[pool].vertices; }
    /// The pool's index list at this level; `draws` are ranges of it.
    [[nodiscard]] std::span<const std::uint32_t> indices(std::uint32_t pool) const { return pools_[pool].indices; }
    [[nodiscard]] std::span<const Draw> draws() const { return draws_; }

private:
    struct PoolLevel {
        std::uint32_t vertices = 0;
        std::vector<std::uint32_t> indices;
    };
    const Model* model_;
    std::vector<PoolLevel> pools_;
    std::vector<Draw> draws_;
    std::uint64_t triangles_ = 0;
};

}  // namespace bendy
