#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/lod.h>
#include <bendy/runtime/pose.h>
#include <bendy/runtime/vertices.h>

#include <cstdint>

namespace BENDY_PUBLIC bendy {

/// How the joints of a vertex are blended.
enum class SkinningMethod : std::uint8_t {
    /// v' = sum(w_i M_i v) with M_i = model space of joint i * its inverse bind matrix.
    linear,
    /// By dual quaternions (Kavan, Collins, Zara, O'Sullivan, Skinning with Dual Quaternions, 2007): preserves the
    /// volume of limbs at joints that twist or bend, where `linear` makes them thinner. For characters made for it:
    /// elbows bulge a little, and `Bounds` does not cover it.
    ///
    /// Scale and shear are applied in two phases: first each joint's about its own position, blended by the weights as
    /// in `linear`; then the rotations and translations are blended as dual quaternions. The uniform scale of the
    /// topmost of a mesh's joints applies to the whole mesh, exactly. A vertex of one joint is moved as by `linear`,
    /// whatever the matrix. A vertex without weights is put at the origin.
    dual_quaternion,
};

/// All meshes, one after another: Model::first_vertex gives the index of each mesh's first vertex.
inline constexpr std::uint32_t kAllMeshes = kNone;

/// Options and outputs of `skin`.
struct SkinRequest {
    std::uint32_t mesh = kAllMeshes;  ///< one mesh, written from vertex 0 on, or all
    /// A level of detail of the pose's model, or null: all vertices. Skins only the vertices alive at that level, the
    /// first Lod::vertices of each mesh, at their usual places; the others are left unchanged. The cost is
    /// proportional.
    const Lod* lod = nullptr;
    SkinningMethod method = SkinningMethod::linear;
    VertexBuffer out{};  ///< room for the mesh's vertices (or those alive), or for all: Model::vertex_count()
};

/// Writes the vertices of a pose: applies its morph target weights, then skins; the vertices of a rigid mesh move with
/// their joint. Normals are transformed by the inverse transpose. On an error nothing is written.
///
///     skin(pose, {.out = {.positions = positions, .normals = normals}})
[[nodiscard]] Result<void, CallError> skin(Pose& pose, const SkinRequest& request);

/// Allocates the memory that a method needs in addition to the Pose's own: 256 bytes per bone of the largest mesh and
/// 24 per bone of all meshes. Otherwise the pose's first `skin` with that method allocates it. Does nothing for
/// `linear`.
void prepare_skin(Pose& pose, SkinningMethod method);

}  // namespace bendy
