#pragma once

#include "rewrite.h"

#include <bendy/format/limits.h>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace bendy::edit {

/// The parts of a file that are kept, by their original numbers.
struct Kept {
    struct Mesh {
        bool stays = true;
        std::vector<bool> targets;
        std::vector<bool> vertices;  ///< empty: all
        bool keeps_levels = true;    ///< levels of detail
    };
    struct Object {
        bool stays = true;
        std::vector<bool> joints;    ///< the parent of a kept joint is kept
        std::vector<bool> polygons;  ///< per joint: whether its submeshes and local materials are kept
        std::vector<bool> chains, clips;
        std::vector<Mesh> meshes;
    };
    std::vector<bool> textures, materials;  ///< those of HEAD
    bool local_materials = true;
    std::vector<Object> objects;
};

/// Returns a Kept that keeps everything.
Kept everything(const Document& document);

/// Returns the new number of each thing that is kept; kNone for what is removed.
inline std::vector<std::uint32_t> renumbered(const std::vector<bool>& stays) {
    std::vector<std::uint32_t> now(stays.size(), kNone);
    std::uint32_t next = 0;
    for (std::size_t k = 0; k < stays.size(); ++k) {
        if (stays[k]) now[k] = next++;
    }
    return now;
}

/// The new numbers in an object.
struct ObjectNumbers {
    std::vector<std::uint32_t> joints, chains, meshes;
    std::vector<std::vector<std::uint32_t>> vertices;  ///< by mesh; empty: unchanged
};

/// Returns the texture numbers in a material's extensions (EXTN).
std::vector<std::uint32_t> texture_numbers(std::string_view json);

/// Updates TEXT, and the texture numbers in the records of all materials.
void update_textures(const Source& source, const Kept& kept, Rewrite& rewrite);

/// Updates the numbers in all extensions (EXTN); what names a thing that goes is taken out.
void update_extensions(const Source& source, const Kept& kept, Rewrite& rewrite, Log& log);

/// Updates the streams, targets, palette and owner of a mesh that is kept. `index_runs` are the runs of INDX that are
/// kept, ascending.
struct IndexRun {
    std::uint32_t first = 0, count = 0;
};
void update_mesh(const ChunkTree& tree, const MeshView& mesh, const Kept::Mesh& kept, const ObjectNumbers& numbers,
                 std::span<const std::uint32_t> vertices, std::span<const IndexRun> index_runs, Rewrite& rewrite);

/// Updates LODD.
void update_collapse(const CollapseView& collapse, const Kept::Object& kept, const ObjectNumbers& numbers,
                     Rewrite& rewrite);

}  // namespace bendy::edit
