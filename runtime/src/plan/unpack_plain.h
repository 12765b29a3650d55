#pragma once

#include <bendy/format/packed_clip.h>
#include <bendy/runtime/transform.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace bendy {

struct UnpackPlan;

/// Sets the properties that the tracks animate to their values at `seconds`. Does nothing if the tracks are of a model
/// with more joints.
/// \param joints  in `local`
/// \param local   UnpackPlan::start; for the plain decoder, at rest where a track animates
using Unpack = void(const UnpackPlan& plan, float seconds, std::size_t joints, std::span<JointBlock> local);

/// In double precision, on any machine: the definition of a packed clip's content, and the reference for the kernels.
/// Uses only `packed` of the plan.
Unpack unpack_plain;

/// Sets one track's value at a joint that is at rest, like the plain decoder.
/// \param u  [0, 1), from the group's left numbers to its right ones
void set_unpacked(const PackedGroup& group, std::uint32_t track, double u, JointTransform& joint);

}  // namespace bendy
