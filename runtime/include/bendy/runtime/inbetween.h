#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/model.h>
#include <bendy/runtime/vertices.h>

#include <cstdint>
#include <span>

namespace BENDY_PUBLIC bendy {

/// Inbetweening: a pool's vertices plus the weighted displacements of its targets, in pool space, not yet skinned.
/// `weights`: one per target of the pool, any number (usually 0 to 1). Each span of `out` that is not empty must hold
/// the pool's vertices. Normals and tangents come out unnormalised. False, and nothing written, if a span is too short.
bool inbetween(const Pool& pool, std::span<const float> weights, const Vertices& out);

/// The same for the pool's first `vertices` only: spans need hold no more, and it costs no more.
bool inbetween(const Pool& pool, std::span<const float> weights, std::uint32_t vertices, const Vertices& out);

}  // namespace bendy
