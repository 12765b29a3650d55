#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/pose.h>

#include <cstdint>
#include <span>
#include <vector>

// Combines poses of one model. Weights are usually 0 to 1, but may lie outside. A mask scales the weight per joint (see
// mask_below); it is empty or has one number per joint. Only mask_below allocates. Each function returns an error, and
// changes nothing, for poses of different models, a mask of the wrong size or a weight that is not finite.
namespace BENDY_PUBLIC bendy {

/// Blends `pose` towards `other`: weight 0 leaves it unchanged, 1 makes it equal to `other`. Translations, scales and
/// morph target weights are interpolated linearly; rotations are interpolated linearly along the shorter arc and
/// normalised ("nlerp"). To average several poses, blend in the second with weight 1/2, the third with 1/3 and so on; a
/// cross-fade or a layer takes one call.
[[nodiscard]] Result<void, CallError> blend(Pose& pose, const Pose& other, float weight,
                                            std::span<const float> mask = {});

/// Turns `pose` into its difference from `reference`, for add(): a breath, a recoil, a lean. Rotations: the rotation
/// from the reference to the pose, in the joint's own axes; translations and morph target weights: the difference;
/// scales: the quotient, 1 where the reference's scale is 0. The result is not meant to be displayed.
[[nodiscard]] Result<void, CallError> make_additive(Pose& pose, const Pose& reference);

/// Adds a difference to `pose`, scaled by `weight`: 0 leaves the pose unchanged; 1 on the reference restores the pose
/// that make_additive was given.
[[nodiscard]] Result<void, CallError> add(Pose& pose, const Pose& difference, float weight,
                                          std::span<const float> mask = {});

/// Returns a mask: `inside` for the joint and its descendants, such as an upper body or an arm, and `outside` for all
/// others; for all joints if the joint does not exist. One number per joint.
[[nodiscard]] std::vector<float> mask_below(const Model& model, std::uint32_t joint, float inside = 1.0f,
                                            float outside = 0.0f);

}  // namespace bendy
