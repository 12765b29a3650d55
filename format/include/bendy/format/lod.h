#pragma once

#include <bendy/format/error.h>
#include <bendy/format/mesh.h>
#include <bendy/format/public.h>
#include <bendy/format/records.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

// LODD: the sequence in which the vertices of an object's meshes are collapsed.
namespace BENDY_PUBLIC bendy {

/// The collapse sequence of one mesh, in place. With N vertices alive, base <= N <= vertices, these are the mesh's
/// first N.
struct MeshCollapseView {
    std::uint32_t mesh = 0;      ///< number inside the object
    std::uint32_t base = 0;      ///< number of vertices that never collapse
    std::uint32_t vertices = 0;  ///< of the mesh
    ComponentType type = ComponentType::u16;
    Bytes targets;  ///< vertices - base numbers of u16 or u32
    Bytes joined;   ///< one bit each, least significant first

    /// Returns the vertex that `vertex`, base or more, collapses to: always a smaller number.
    [[nodiscard]] std::uint32_t target(std::uint32_t vertex) const;
    /// Returns true if a vertex belongs together with the one before it: a level should not separate them, or a seam
    /// opens.
    [[nodiscard]] bool is_joined(std::uint32_t vertex) const;
};

struct CollapseView {
    std::uint32_t chunk = 0;
    std::vector<MeshCollapseView> meshes;  ///< ascending by mesh; a mesh that is not listed has one level
    std::uint32_t levels = 0;

    /// Returns how far the surface of a level may deviate from the full one, in metres; never decreases from level to
    /// level.
    [[nodiscard]] float error(std::uint32_t level) const;
    /// Returns the number of vertices alive at a level, of the mesh at `place` in `meshes`; never increases from level
    /// to level.
    [[nodiscard]] std::uint32_t alive(std::uint32_t level, std::uint32_t place) const;

    Bytes rows;  ///< one row per level: error f32, alive u32 for each of `meshes`
};

/// Reads the LODD of an object and makes all checks that memory safety depends on, and that no chain of targets is
/// circular: meshes in range and ascending, sizes, base within the mesh, each target below its own number, levels in
/// order. Returns nothing if there is none, or if it has a fault.
std::optional<CollapseView> read_collapse(const ChunkTree& tree, std::uint32_t object, std::span<const MeshView> meshes,
                                          Faults& faults);

/// Size in bytes of the targets of `count` vertices, and of their bits, each rounded up to the next 16-byte boundary.
constexpr std::uint64_t collapse_targets_size(std::uint64_t count, ComponentType type) {
    return padded(count * component_size(type));
}
constexpr std::uint64_t collapse_bits_size(std::uint64_t count) {
    return padded((count + 7) / 8);
}

}  // namespace bendy
