#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/ik_link.h>
#include <bendy/runtime/model.h>
#include <bendy/runtime/palette_matrix.h>

#include <glm/mat4x4.hpp>

#include <span>
#include <vector>

namespace bendy {

class Reach;  // not exported

}  // namespace bendy

namespace BENDY_PUBLIC bendy {

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
    [[nodiscard]] std::span<const glm::mat4> model_space() const {
        if (model_space_.empty()) return {};
        return {&model_space_.front().matrix, model_space_.size()};
    }
    /// What each bone of a skinned pool does to its vertices, for skinning elsewhere: model space * inverse bind
    /// matrix, one for each entry of the pool's palette; empty for a rigid pool. Brings a stale pose up to date first.
    /// Holds until the pose changes, or is asked for another pool's or skinned.
    [[nodiscard]] std::span<const PaletteMatrix> palette(std::uint32_t pool);
    /// True when a local transform may have changed since local_to_model.
    [[nodiscard]] bool is_stale() const { return is_stale_; }

private:
    friend void local_to_model(Pose& pose);
    friend class Reach;
    friend class Skinning;

    struct alignas(64) JointMatrix {  // on a cache line of its own
        glm::mat4 matrix;
    };
    static_assert(sizeof(JointMatrix) == sizeof(glm::mat4));

    /// Joint space to model space, as exact as local_to_model had it.
    [[nodiscard]] glm::dmat4 exact_model_space(std::uint32_t joint) const {
        return is_exact_ ? exact_model_space_[joint] : glm::dmat4(model_space_[joint].matrix);
    }
    /// Sets palette_ for a skinned pool, if it is not that already. Whether all numbers are finite.
    bool make_palette(std::uint32_t pool);
    /// Sets palette_ for what one joint moves. Whether all numbers are finite.
    bool make_rigid_palette(std::uint32_t joint);

    const Model* model_;
    std::vector<JointTransform> local_;
    std::vector<JointMatrix> model_space_;
    std::vector<glm::dmat4> exact_model_space_;  // if is_exact_
    std::vector<float> target_weights_;
    std::vector<IkLink> ik_links_;        // of the chain that reaches
    std::vector<PaletteMatrix> palette_;  // of the pool that is being skinned; never empty
    std::uint32_t palette_pool_ = kNone;  // whose palette_ is
    bool is_palette_finite_ = false;
    bool is_exact_ = true;  // in doubles, so that rounding does not add up along deep chains
    bool is_stale_ = true;
};

}  // namespace bendy
