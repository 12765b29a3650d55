#pragma once

#include "rewrite.h"
#include "source.h"
#include "staying.h"

namespace bendy::edit {

/// Takes out of the file what does not stay, and mends what refers to it.
Result<void, Problem> mend(const Source& source, const Staying& staying, Rewrite& rewrite, Log& log);

/// What mend has numbered anew in an object.
struct ObjectNumbers {
    std::vector<std::uint32_t> joints, chains, pools;
    std::vector<std::vector<std::uint32_t>> vertices;  ///< by pool; empty: as they were
};

/// TEXT, and the texture numbers in all materials. `materials`: the document's that stay.
void mend_textures(const Source& source, const Staying& staying, Rewrite& rewrite, Log& log);

/// Streams, targets, palette and owner of a pool that stays. `index_runs` are the runs of INDX that stay, ascending.
struct IndexRun {
    std::uint32_t first = 0, count = 0;
};
void mend_pool(const ChunkTree& tree, const PoolView& pool, const Staying::Pool& staying, const ObjectNumbers& numbers,
               std::span<const std::uint32_t> vertices, std::span<const IndexRun> index_runs, Rewrite& rewrite);

/// LODD.
void mend_collapse(const CollapseView& collapse, const Staying::Object& staying, const ObjectNumbers& numbers,
                   Rewrite& rewrite);

}  // namespace bendy::edit
