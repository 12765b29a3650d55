#pragma once

#include <bendy/format/faults.h>
#include <bendy/format/mesh.h>
#include <bendy/format/public.h>
#include <bendy/format/records.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

// LODD: the sequence in which the vertices of an object's meshes are collapsed.
namespace BENDY_PUBLIC bendy {

/// The collapse sequence of one mesh, in place. The mesh's first N vertices are those alive at N, base <= N <=
/// vertices.
struct MeshCollapseView {
    std::uint32_t mesh = 0;      ///< number inside the object
    std::uint32_t base = 0;      ///< the vertices that never collapse
    std::uint32_t vertices = 0;  ///< of the mesh
    ComponentType type = ComponentType::u16;
    Bytes targets;  ///< vertices - base numbers of u16 or u32
    Bytes joined;   ///< a bit each, the lowest of a byte first

    /// The vertex that `vertex`, base or more, collapses to: always a smaller number.
    [[nodiscard]] std::uint32_t target(std::uint32_t vertex) const;
    /// True where a vertex goes together with the one before it: N should not part them, or a seam opens.
    [[nodiscard]] bool is_joined(std::uint32_t vertex) const;
};

struct CollapseView {
    std::uint32_t chunk = 0;
    std::vector<MeshCollapseView> meshes;  ///< by mesh; a mesh that is not here has one level
    std::uint32_t levels = 0;

    /// The distance, in metres, that a level's surface may have from the full one's; does not fall from level to level.
    [[nodiscard]] float error(std::uint32_t level) const;
    /// Vertices alive at a level, of the mesh at `place` in `meshes`; does not rise from level to level.
    [[nodiscard]] std::uint32_t alive(std::uint32_t level, std::uint32_t place) const;

    Bytes rows;  ///< levels rows: error f32, alive u32 for each of `meshes`
};

/// Reads an object's LODD and checks all that memory safety hangs on, and that no chain of targets is circular: meshes
/// in range and ascending, sizes, base within the mesh, each target below its own number, levels in order. Nothing if
/// there is none, or it has a fault.
std::optional<CollapseView> read_collapse(const ChunkTree& tree, std::uint32_t object, std::span<const MeshView> meshes,
                                          Faults& faults);

/// Bytes of the targets of `count` vertices, and of their bits, each up to the next 16-byte boundary.
constexpr std::uint64_t collapse_targets_size(std::uint64_t count, ComponentType type) {
    return padded(count * component_size(type));
}
constexpr std::uint64_t collapse_bits_size(std::uint64_t count) {
    return padded((count + 7) / 8);
}

}  // namespace bendy
