#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/model.h>
#include <bendy/runtime/vertices.h>

#include <cstdint>
#include <span>

namespace BENDY_PUBLIC bendy {

/// Inbetweening: a pool's vertices plus the weighted displacements of its targets, in pool space, not yet skinned.
/// `weights`: one per target of the pool, any number (usually 0 to 1). Each span of `out` that is not empty must hold
/// the pool's vertices. Normals and tangents come out unnormalised. On an error nothing is written.
[[nodiscard]] Result<void, CallError> inbetween(const Pool& pool, std::span<const float> weights, const Vertices& out);

/// The same for the pool's first `vertices` only: spans need hold no more, and it costs no more.
[[nodiscard]] Result<void, CallError> inbetween(const Pool& pool, std::span<const float> weights,
                                                std::uint32_t vertices, const Vertices& out);

}  // namespace bendy
