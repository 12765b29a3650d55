#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/model.h>
#include <bendy/runtime/vertices.h>

#include <cstdint>
#include <span>

namespace BENDY_PUBLIC bendy {

/// Morph targets: a mesh's vertices plus the weighted displacements of its targets, in mesh space, not yet skinned.
/// `weights`: one per target of the mesh, any number (usually 0 to 1). Each span of `out` that is not empty must hold
/// the mesh's vertices. Normals and tangents come out unnormalised. On an error nothing is written.
[[nodiscard]] Result<void, CallError> apply_morph_targets(const Mesh& mesh, std::span<const float> weights,
                                                          const Vertices& out);

/// The same for the mesh's first `vertices` only: spans need hold no more, and it costs no more.
[[nodiscard]] Result<void, CallError> apply_morph_targets(const Mesh& mesh, std::span<const float> weights,
                                                          std::uint32_t vertices, const Vertices& out);

}  // namespace bendy
