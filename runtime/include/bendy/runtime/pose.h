#pragma once

#include <bendy/runtime/ik_link.h>
#include <bendy/runtime/model.h>
#include <bendy/runtime/palette_matrix.h>

#include <glm/mat4x4.hpp>

#include <span>
#include <vector>

namespace bendy {

/// A model in one position: the joints' local transforms, the inbetweening targets' weights, and what follows from
/// them. Allocates all that posing and skinning need when it is made. The model must outlive it where it stands.
class Pose {
public:
    /// The rest pose.
    explicit Pose(const Model& model);

    void set_rest();

    [[nodiscard]] const Model& model() const { return *model_; }
    /// Relative to the parent, one per joint. Whoever asks for them to write has changed the pose.
    [[nodiscard]] std::span<const JointTransform> local() const { return local_; }
    [[nodiscard]] std::span<JointTransform> change_local() {
        is_stale_ = true;
        return local_;
    }
    /// One per inbetweening target, all pools: see Model::first_target.
    [[nodiscard]] std::span<const float> target_weights() const { return target_weights_; }
    [[nodiscard]] std::span<float> change_target_weights() { return target_weights_; }
    /// Joint space to model space, one per joint, as local_to_model left them.
    [[nodiscard]] std::span<const glm::mat4> model_space() const { return model_space_; }
    /// True when a local transform may have changed since local_to_model.
    [[nodiscard]] bool is_stale() const { return is_stale_; }

private:
    friend void local_to_model(Pose& pose);
    friend class Reach;
    friend class Skinning;

    const Model* model_;
    std::vector<JointTransform> local_;
    std::vector<glm::mat4> model_space_;
    std::vector<glm::dmat4> exact_model_space_;  // so that rounding does not add up along deep chains
    std::vector<float> target_weights_;
    std::vector<IkLink> ik_links_;        // of the chain that reaches
    std::vector<PaletteMatrix> palette_;  // of the pool that is being skinned; never empty
    bool is_stale_ = true;
};

}  // namespace bendy
