#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/pose.h>

#include <cstdint>
#include <span>
#include <vector>

namespace BENDY_PUBLIC bendy {

/// Whose translations a bound clip brings along.
enum class BoundTranslations : std::uint8_t {
    all,        ///< every track as it is: right for skeletons of one size
    root_only,  ///< limbs keep the lengths of the model that is posed
};

struct BindingOptions {
    BoundTranslations translations = BoundTranslations::all;
    /// For root_only: this joint of the model that is posed, and all above it, take translations: hips, usually. kNone:
    /// only joints with no matched joint above them.
    std::uint32_t root = kNone;
    /// Times what root_only takes: the posed model's hip height by the other's, so that feet reach the ground.
    float root_scale = 1.0f;
};

/// The clips of one model for another one, joint by joint and target by target of the same name: files that hold
/// nothing but a skeleton and clips, shared by many characters. Names must be the same to the letter; of names that
/// are doubled the first counts, empty ones match nothing.
///
/// What a track animates gets its value as it is, relative to the parent; everything else is at the posed model's own
/// rest. Rotations are not corrected: where two skeletons' rest poses differ in how joints are turned, or in which
/// joints lie between, the pose does too.
///
/// Holds a Pose to sample into, so each thread needs a Binding of its own (copies do).
class Binding {
public:
    /// \param animated  has the clips
    /// \param posed     has the skeleton that is to move
    Binding(const Model& animated, Model posed, const BindingOptions& options = {});

    [[nodiscard]] const Model& animated() const { return animated_; }
    [[nodiscard]] const Model& posed() const { return posed_; }
    /// For each joint of the animated model the posed model's, or kNone.
    [[nodiscard]] std::span<const std::uint32_t> joints() const { return joints_; }
    /// For each target of the animated model (see Model::first_morph_target) the posed model's, or kNone. Of meshes of
    /// the same name if there are such, else the first of its name.
    [[nodiscard]] std::span<const std::uint32_t> targets() const { return targets_; }
    /// What some clip animates in vain: joints of the animated model, ascending.
    [[nodiscard]] std::span<const std::uint32_t> unmatched_joints() const { return unmatched_joints_; }
    [[nodiscard]] std::span<const std::uint32_t> unmatched_targets() const { return unmatched_targets_; }

private:
    friend Result<void, CallError> sample(Pose& pose, Binding& binding, const Clip* clip, float seconds);

    /// What a clip animates of a joint that is matched.
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

/// As sample, of a clip of the animated model, for a pose of the posed one. An error, and the rest pose, for NaN
/// seconds and for a clip that is null or not the animated model's; an error, and nothing changes, for a pose of
/// another model.
[[nodiscard]] Result<void, CallError> sample(Pose& pose, Binding& binding, const Clip* clip, float seconds);

}  // namespace bendy
