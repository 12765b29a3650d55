#pragma once

#include <bendy/format/mesh.h>
#include <bendy/runtime/vertices.h>

#include "plan/blocks.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace bendy {

/// A morph target with a weight other than zero, and its entries in the vertices that are being displaced. An entry
/// is one touched vertex.
class ActiveTarget {
public:
    ActiveTarget() = default;
    ActiveTarget(const MorphTargetView& target, float weight) : target_(&target), weight_(weight) {}

    /// Adds weight * displacement to vertices [first, first + count); of tangents, to x, y and z. Cheap to find if
    /// `first` is where the last call's vertices ended.
    /// \param vertices  those that are wanted, from `first` on
    void displace(std::size_t first, std::size_t count, const Vertices& vertices);

private:
    template <class Vector>
    void add(const std::optional<StreamView>& shifts, std::span<const MorphRun> runs, std::span<Vector> vectors) const;

    const MorphTargetView* target_ = nullptr;
    float weight_ = 0.0f;
    std::size_t last_ = 0;   // vertices before it have been displaced
    std::size_t entry_ = 0;  // the first one of a vertex from last_ on
};

/// A mesh's targets whose weight is not zero, in the mesh's order.
/// \param room  at least as many as the mesh has targets; the result is the start of it
std::span<ActiveTarget> find_active_targets(const MeshView& mesh, std::span<const float> weights,
                                            std::span<ActiveTarget> room);

/// Decodes elements of a stream, from `first` on, with the kernel in use: as StreamView::decode, except for rounding.
void decode(const StreamView& stream, std::size_t first, std::span<glm::vec3> out);
void decode(const StreamView& stream, std::size_t first, std::span<glm::vec4> out);

}  // namespace bendy
