#pragma once

#include <bendy/runtime/ik.h>

#include <glm/vec3.hpp>

#include <cstdint>

// ReachOptions::carry_target.
namespace bendy {

/// Returns the effector's tip offset, in metres.
glm::dvec3 tip_offset(const Chain& chain);

/// Returns the joint that reaching with the chain moves to its tip, or kNone.
std::uint32_t carried_joint(const Chain& chain, const Pose& pose, const ReachOptions& options);

/// Moves that joint, if it is not kNone. A joint whose parent has a scale of 0, or numbers that
/// are not finite, stays where it is.
void carry_to_tip(const Chain& chain, std::uint32_t joint, Pose& pose);

}  // namespace bendy
