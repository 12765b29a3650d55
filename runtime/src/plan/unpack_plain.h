#pragma once

#include <bendy/format/packed_clip.h>
#include <bendy/runtime/transform.h>

#include <cstdint>
#include <span>

namespace bendy {

struct UnpackPlan;

/// Sets what the tracks animate to its value at `seconds`. Nothing happens if they are of a model with more joints.
/// \param local  at rest where a track animates
using Unpack = void(const UnpackPlan& plan, float seconds, std::span<JointTransform> local);

/// In double precision, on any machine: what a packed clip means, which kernels are tested against. Looks at nothing
/// of the plan but `packed`.
Unpack unpack_plain;

/// As the plain decoder sets it: one track's value at a joint that is at rest.
/// \param u  [0, 1), from the group's left numbers to its right ones
void set_unpacked(const PackedGroup& group, std::uint32_t track, double u, JointTransform& joint);

}  // namespace bendy
