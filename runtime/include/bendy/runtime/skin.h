#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/lod.h>
#include <bendy/runtime/pose.h>
#include <bendy/runtime/vertices.h>

#include <cstdint>

namespace BENDY_PUBLIC bendy {

/// Poses the vertices of one pool: inbetweening with the pose's target weights, then skinning, v' = sum(w_i M_i v) with
/// M_i = model space of joint i * its inverse bind matrix; a rigid pool's vertices move with their joint. Normals go by
/// the inverse transpose. Brings a stale pose up to date first. `model` is the pose's own. False, and nothing written,
/// if a span that is not empty is shorter than the pool.
bool skin(const Model& model, std::uint32_t pool, Pose& pose, const Vertices& out);

/// Into memory of any layout. False, and nothing written, if a span that is not empty is too short or a stride too
/// small.
bool skin_into(const Model& model, std::uint32_t pool, Pose& pose, const VertexBuffer& out);
bool skin_into(const Model& model, Pose& pose, const VertexBuffer& out);

/// The same for all pools, pool after pool (Model::first_vertex); spans hold Model::vertex_count() or are empty.
bool skin(const Model& model, Pose& pose, const Vertices& out);

/// The same for the vertices that are alive at a level of detail, in the same places: of each pool the first
/// Lod::vertices, the others are left as they are. Costs as much less as there are fewer of them.
bool skin(const Model& model, std::uint32_t pool, Pose& pose, const Lod& lod, const Vertices& out);
bool skin(const Model& model, Pose& pose, const Lod& lod, const Vertices& out);
bool skin_into(const Model& model, std::uint32_t pool, Pose& pose, const Lod& lod, const VertexBuffer& out);
bool skin_into(const Model& model, Pose& pose, const Lod& lod, const VertexBuffer& out);

}  // namespace bendy
