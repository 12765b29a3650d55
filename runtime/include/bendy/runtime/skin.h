#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/lod.h>
#include <bendy/runtime/pose.h>
#include <bendy/runtime/vertices.h>

#include <cstdint>

namespace BENDY_PUBLIC bendy {

/// How the joints that a vertex follows are mixed.
enum class SkinningMethod : std::uint8_t {
    /// v' = sum(w_i M_i v) with M_i = model space of joint i * its inverse bind matrix.
    linear,
    /// By dual quaternions (Kavan, Collins, Zara, O'Sullivan, Skinning with Dual Quaternions, 2007): joints that twist
    /// or bend keep the limb's volume, where `linear` makes it thinner. For characters that were made for it: elbows
    /// bulge a little, and `Bounds` does not hold it.
    ///
    /// Scale and shear go in two phases: each joint's are applied about its own place and mixed by the weights as
    /// `linear` does, then the rotations and translations are mixed as dual quaternions. The uniform scale of the
    /// topmost of a mesh' joints is the whole mesh', and exact. A vertex of one joint goes where `linear` takes it,
    /// whatever the matrix. A vertex without weights lies at the origin.
    dual_quaternion,
};

/// All meshes, one after another: Model::first_vertex says where each begins.
inline constexpr std::uint32_t kAllMeshes = kNone;

/// What `skin` is to do.
struct SkinRequest {
    std::uint32_t mesh = kAllMeshes;  ///< one mesh, whose vertices begin at 0, or all
    /// Of the pose's model, or null: all vertices. Else those that are alive at that level of detail, of each mesh the
    /// first Lod::vertices, in the same places; the others are left as they are. It costs as much less as there are
    /// fewer of them.
    const Lod* lod = nullptr;
    SkinningMethod method = SkinningMethod::linear;
    VertexBuffer out{};  ///< room for the mesh (for the vertices alive), or for all: Model::vertex_count()
};

/// Writes the vertices of a pose: inbetweening with its morph target weights, then skinning; the vertices of a rigid
/// mesh move with their joint. Normals go by the inverse transpose. On an error nothing is written.
///
///     skin(pose, {.out = {.positions = positions, .normals = normals}})
[[nodiscard]] Result<void, CallError> skin(Pose& pose, const SkinRequest& request);

/// Takes the memory that a method needs beside a Pose's own, 256 bytes for each bone of the largest mesh and 24 for
/// each bone of all. Else the pose's first `skin` by that method takes it. Nothing for `linear`.
void prepare_skin(Pose& pose, SkinningMethod method);

}  // namespace bendy
