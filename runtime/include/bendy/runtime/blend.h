#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/pose.h>

#include <cstdint>
#include <span>
#include <vector>

// Several poses of one model become one. Weights are 0 to 1 and may lie outside; a mask scales the weight joint by
// joint (see mask_below), and is empty or has a number for each joint. Nothing allocates but mask_below. Each returns
// an error, and changes nothing, for poses of different models, a mask of another size or a weight that is not finite.
namespace BENDY_PUBLIC bendy {

/// Moves `pose` towards `other`: 0 leaves it, 1 makes it the other. Translations, scales and morph target weights are
/// mixed, rotations too, the short way round, and normalised ("nlerp"). To mix several poses evenly, blend in the
/// second by 1/2, the third by 1/3 and so on; for a cross-fade or a layer, one call with its weight.
[[nodiscard]] Result<void, CallError> blend(Pose& pose, const Pose& other, float weight,
                                            std::span<const float> mask = {});

/// Turns `pose` into its difference from `reference`, which add() takes: a breath, a recoil, a lean. Rotations: what
/// turns the reference into the pose, in the joint's own axes; translations and morph target weights: the difference;
/// scales: the quotient, 1 where the reference has none. The difference is no pose to show.
[[nodiscard]] Result<void, CallError> make_additive(Pose& pose, const Pose& reference);

/// Adds a difference to `pose`, so much of it: 0 leaves it, 1 on the reference gives what make_additive was given.
[[nodiscard]] Result<void, CallError> add(Pose& pose, const Pose& difference, float weight,
                                          std::span<const float> mask = {});

/// For the joint and all below it `inside`, for the others `outside`: an upper body, an arm. One number for each joint.
[[nodiscard]] std::vector<float> mask_below(const Model& model, std::uint32_t joint, float inside = 1.0f,
                                            float outside = 0.0f);

}  // namespace bendy
