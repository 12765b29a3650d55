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

struct PoseState;  // the library's own

}  // namespace bendy

namespace BENDY_PUBLIC bendy {

/// A model in one position: the joints' local transforms, the morph targets' weights, and what follows from
/// them. Allocates all that posing and skinning need when it is made (but see prepare_skin). It shares the model's
/// character, so the Model that it was made from may be moved or destroyed. One thread at a time.
///
/// A pose that was moved from may be assigned to or destroyed, nothing else.
class Pose {
public:
    /// The rest pose.
    explicit Pose(const Model& model);
    Pose(const Pose& other);
    Pose(Pose&& other) noexcept;
    Pose& operator=(const Pose& other);
    Pose& operator=(Pose&& other) noexcept;
    ~Pose();

    void set_rest();

    [[nodiscard]] const Model& model() const;
    /// Relative to the parent, one per joint.
    [[nodiscard]] std::span<const JointTransform> local() const;
    /// The same to be written: what is written after the next call on the pose may go unnoticed.
    [[nodiscard]] std::span<JointTransform> change_local();
    /// One per morph target, all meshes: see Model::first_morph_target.
    [[nodiscard]] std::span<const float> morph_weights() const;
    [[nodiscard]] std::span<float> change_morph_weights();
    /// Joint space to model space, one per joint: of the local transforms as they are now, computed if they have
    /// changed. Valid until the pose changes.
    [[nodiscard]] std::span<const glm::mat4> model_space();
    /// What each bone of a skinned mesh does to its vertices, for skinning elsewhere: model space * inverse bind
    /// matrix, one for each entry of the mesh's palette; empty for a rigid mesh. Of the local transforms as they are
    /// now. Valid until the pose changes, is skinned or is asked for another mesh's.
    [[nodiscard]] std::span<const PaletteMatrix> palette(std::uint32_t mesh);

private:
    friend struct PoseState;

    std::unique_ptr<PoseState> state_;
};

}  // namespace bendy
