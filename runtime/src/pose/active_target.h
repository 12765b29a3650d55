#pragma once

#include <bendy/format/mesh.h>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace bendy {

/// A morph target with a weight other than zero, and its entries in the vertices that are being displaced. An entry
/// is one touched vertex.
class ActiveTarget {
public:
    ActiveTarget() = default;
    ActiveTarget(const MorphTargetView& target, float weight) : target_(&target), weight_(weight) {}

    /// Finds the entries of vertices [first, first + count). Cheap if `first` is where the last call's range ended.
    void seek(std::size_t first, std::size_t count);

    /// Adds weight * displacement to vertices [first, first + vectors), the range of the last seek.
    /// \param shifts  the target's positions, normals or tangents
    void add(const StreamView& shifts, std::span<glm::vec3> vectors) const;
    /// The same to x, y and z.
    void add(const StreamView& shifts, std::span<glm::vec4> vectors) const;

    [[nodiscard]] const MorphTargetView& target() const { return *target_; }

private:
    const MorphTargetView* target_ = nullptr;
    float weight_ = 0.0f;
    std::size_t first_ = 0, last_ = 0;   // vertices [first, last) are displaced
    std::uint32_t begin_ = 0, end_ = 0;  // by these entries
};

/// A mesh's targets whose weight is not zero, in the mesh's order.
/// \param room  at least as many as the mesh has targets; the result is the start of it
std::span<ActiveTarget> find_active_targets(const MeshView& mesh, std::span<const float> weights,
                                            std::span<ActiveTarget> room);

/// Decodes elements of a stream, from `first` on, with the kernel in use: as StreamView::decode, except for rounding.
void decode(const StreamView& stream, std::size_t first, std::span<glm::vec3> out);
void decode(const StreamView& stream, std::size_t first, std::span<glm::vec4> out);

}  // namespace bendy
