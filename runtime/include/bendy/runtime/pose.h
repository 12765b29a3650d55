#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/model.h>
#include <bendy/runtime/palette_matrix.h>
#include <bendy/runtime/transform.h>

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <memory>
#include <span>

namespace bendy {

struct PoseState;  // internal

}  // namespace bendy

namespace BENDY_PUBLIC bendy {

/// A pose of a model: the joints' local transforms, the morph targets' weights, and everything derived from them.
/// Allocates all memory for posing and skinning when it is made (but see prepare_skin). Shares the model's character,
/// so the Model that it was made from may be moved or destroyed. To be used by one thread at a time.
///
/// A pose that was moved from may only be assigned to or destroyed.
class Pose {
public:
    /// Creates a pose set to the rest pose.
    explicit Pose(const Model& model);
    Pose(const Pose& other);
    Pose(Pose&& other) noexcept;
    Pose& operator=(const Pose& other);
    Pose& operator=(Pose&& other) noexcept;
    ~Pose();

    void set_rest();

    [[nodiscard]] const Model& model() const;
    /// Returns a joint's transform relative to its parent.
    /// \param joint  less than the number of the model's joints, which is asserted. Without assertions nothing is read
    /// or written for a larger one, and the identity is returned
    [[nodiscard]] JointTransform local(std::uint32_t joint) const;
    void set_local(std::uint32_t joint, const JointTransform& transform);
    /// The same transforms as they are stored, for code that copies them or works on eight joints at a time: joint
    /// 8 * k + i is lane i of block k.
    [[nodiscard]] std::span<const JointBlock> local_blocks() const;
    /// The same for writing. The next call on the pose ends the write access: later writes may go unnoticed.
    [[nodiscard]] std::span<JointBlock> change_local_blocks();
    /// One per morph target, all meshes: see Model::first_morph_target.
    [[nodiscard]] std::span<const float> morph_weights() const;
    [[nodiscard]] std::span<float> change_morph_weights();
    /// The joint matrices, joint space to model space, one per joint. Recomputed if the local transforms have changed.
    /// Valid until the pose changes.
    [[nodiscard]] std::span<const glm::mat4> model_space();
    /// The skinning palette of a mesh, for skinning elsewhere: model space * inverse bind matrix, one entry per palette
    /// entry of the mesh; empty for a rigid mesh, and if the mesh does not exist. Recomputed if the local transforms
    /// have changed. Valid until the pose changes, is skinned, or the palette of another mesh is requested.
    [[nodiscard]] std::span<const PaletteMatrix> palette(std::uint32_t mesh);

private:
    friend struct PoseState;

    std::unique_ptr<PoseState> state_;
};

}  // namespace bendy
