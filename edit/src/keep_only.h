#pragma once

#include "kept.h"
#include "rewrite.h"
#include "source.h"

namespace bendy::edit {

/// Removes everything from the file that is not kept, and updates what refers to it.
Result<void, Problem> keep_only(const Source& source, const Kept& kept, Rewrite& rewrite, Log& log);

/// The new numbers in an object.
struct ObjectNumbers {
    std::vector<std::uint32_t> joints, chains, meshes;
    std::vector<std::vector<std::uint32_t>> vertices;  ///< by mesh; empty: unchanged
};

/// Updates TEXT, and the texture numbers in all materials. `materials`: the document's that are kept.
void update_textures(const Source& source, const Kept& kept, Rewrite& rewrite, Log& log);

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
