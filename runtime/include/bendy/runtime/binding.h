#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/pose.h>

#include <cstdint>
#include <span>
#include <vector>

namespace BENDY_PUBLIC bendy {

/// Which translations a bound clip applies.
enum class BoundTranslations : std::uint8_t {
    all,        ///< every track as it is: for skeletons of the same size
    root_only,  ///< only those of the root: limbs keep the lengths of the posed model
};

struct BindingOptions {
    BoundTranslations translations = BoundTranslations::all;
    /// For root_only: this joint of the posed model and all its ancestors take translations; usually the hips. kNone,
    /// or no joint of the posed model: only joints without a matched ancestor do.
    std::uint32_t root = kNone;
    /// Factor for the translations that root_only takes: the posed model's hip height divided by the other's, so that
    /// the feet reach the ground.
    float root_scale = 1.0f;
};

/// Maps the clips of one model to another, matching joints and morph targets by name: for files that hold only a
/// skeleton and clips, shared by many characters. Names must match exactly; of duplicate names the first counts, and
/// empty names match nothing.
///
/// Animated values are copied as they are, relative to the parent; everything else is at the posed model's own rest.
/// Rotations are not corrected: where the rest poses of the two skeletons differ in the joints' orientations or in the
/// joints in between, the resulting pose differs too.
///
/// Contains a Pose to sample into, so each thread needs a Binding of its own (a copy will do).
class Binding {
public:
    /// \param animated  the model that has the clips
    /// \param posed     the model whose skeleton is posed
    Binding(const Model& animated, Model posed, const BindingOptions& options = {});

    [[nodiscard]] const Model& animated() const { return animated_; }
    [[nodiscard]] const Model& posed() const { return posed_; }
    /// For each joint of the animated model, the posed model's joint, or kNone.
    [[nodiscard]] std::span<const std::uint32_t> joints() const { return joints_; }
    /// For each morph target of the animated model (see Model::first_morph_target), the posed model's, or kNone.
    /// Targets in meshes of the same name are preferred; otherwise the first target of that name is taken.
    [[nodiscard]] std::span<const std::uint32_t> targets() const { return targets_; }
    /// Joints of the animated model that some clip animates but that have no match, ascending.
    [[nodiscard]] std::span<const std::uint32_t> unmatched_joints() const { return unmatched_joints_; }
    [[nodiscard]] std::span<const std::uint32_t> unmatched_targets() const { return unmatched_targets_; }

private:
    friend Result<void, CallError> sample(Pose& pose, Binding& binding, const Clip* clip, float seconds);

    /// Properties of a matched joint that a clip animates.
    struct BoundJoint {
        std::uint32_t from = 0, to = 0;
        bool rotation = false, translation = false, scale = false;
        float translation_scale = 1.0f;
    };
    struct BoundMorphTarget {
        std::uint32_t from = 0, to = 0;
    };
    struct BoundClip {
        std::vector<BoundJoint> joints;
        std::vector<BoundMorphTarget> targets;
    };

    void match_joints();
    void match_targets();
    void bind(const Clip& clip, const std::vector<bool>& is_root, float root_scale, bool has_all,
              std::vector<bool>& missed_joints, std::vector<bool>& missed_targets);
    [[nodiscard]] std::vector<bool> find_roots(std::uint32_t root) const;

    Model animated_;
    Model posed_;
    Pose sampled_;  // of the animated model
    std::vector<std::uint32_t> joints_, targets_;
    std::vector<std::uint32_t> unmatched_joints_, unmatched_targets_;
    std::vector<BoundClip> clips_;
};

/// As sample, for a clip of the animated model and a pose of the posed model. Returns an error, and sets the rest pose,
/// for NaN seconds and for a clip that is null or does not belong to the animated model. Returns an error, and changes
/// nothing, for a pose of another model.
[[nodiscard]] Result<void, CallError> sample(Pose& pose, Binding& binding, const Clip* clip, float seconds);

}  // namespace bendy
