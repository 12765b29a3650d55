#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/lod.h>
#include <bendy/runtime/palette_matrix.h>
#include <bendy/runtime/pose.h>
#include <bendy/runtime/stretched_motion.h>
#include <bendy/runtime/vertices.h>

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace BENDY_PUBLIC bendy {

/// Skinning by dual quaternions (Kavan, Collins, Zara, O'Sullivan, Skinning with Dual Quaternions, 2007): joints that
/// twist or bend keep the limb's volume, where `skin` makes it thinner. For characters that were made for it: elbows
/// bulge a little, and `Bounds` does not hold it.
///
/// Scale and shear go in two phases: each joint's are applied about its own place and mixed by the weights as `skin`
/// does, then the rotations and translations are mixed as dual quaternions. The uniform scale of the topmost of a
/// pool's joints is the whole pool's, and exact. A vertex of one joint goes where `skin` takes it, whatever the matrix.
///
/// The work memory for a model; one for each thread. Nothing is allocated after it is made. The model must outlive it
/// where it stands.
class DualSkinning {
public:
    explicit DualSkinning(const Model& model);

    /// As `skin` with the same parameters, of a pose of the model: inbetweening first, rigid pools with their joint,
    /// normals by the inverse transpose. A vertex without weights lies at the origin.
    bool skin(std::uint32_t pool, Pose& pose, const Vertices& out);
    bool skin(Pose& pose, const Vertices& out);
    bool skin(std::uint32_t pool, Pose& pose, const Lod& lod, const Vertices& out);
    bool skin(Pose& pose, const Lod& lod, const Vertices& out);

private:
    /// `is_next`: the pool before it was skinned last, of the same pose.
    bool skin_pool(std::uint32_t pool, Pose& pose, const Lod* lod, const Vertices& out, bool is_next);
    bool skin_all(Pose& pose, const Lod* lod, const Vertices& out);
    void skin_found(std::uint32_t pool, std::uint32_t vertices, Pose& pose, const Vertices& out);
    /// Fills motions_ from the palette, unless it is not finite.
    void find_motions(std::uint32_t pool, Pose& pose);
    /// The first ones as kernels want them; false if not all are finite as floats.
    bool round_motions(std::size_t count);

    const Model* model_;
    std::vector<glm::dvec3> places_;          // of each palette entry's joint in pool space when it was bound
    std::vector<std::uint32_t> first_place_;  // of each pool
    std::vector<StretchedMotion> motions_;
    std::vector<DualMotion> kernel_motions_;
    std::vector<PaletteMatrix> kernel_stretches_;
    double scale_ = 1.0;
    bool is_stretched_ = false;
    bool are_motions_good_ = false;
    bool has_kernel_ = false;  // kernel_motions_ hold what motions_ do
};

}  // namespace bendy
