#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/model.h>
#include <bendy/runtime/vertices.h>

#include <cstdint>
#include <span>

namespace BENDY_PUBLIC bendy {

/// Applies morph targets: a mesh's vertices plus the weighted displacements of its targets, in mesh space, not skinned.
/// `weights`: one per target of the mesh, any number (usually 0 to 1). Each non-empty span of `out` must have room for
/// the mesh's vertices. Normals and tangents are not normalised. On an error nothing is written.
[[nodiscard]] Result<void, CallError> apply_morph_targets(const Mesh& mesh, std::span<const float> weights,
                                                          const Vertices& out);

/// As above, for the mesh's first `vertices` only: the spans need room for no more, and the cost is proportional.
/// Error: out_of_range, if the mesh has fewer.
[[nodiscard]] Result<void, CallError> apply_morph_targets(const Mesh& mesh, std::span<const float> weights,
                                                          std::uint32_t vertices, const Vertices& out);

}  // namespace bendy
