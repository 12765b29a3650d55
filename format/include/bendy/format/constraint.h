#pragma once

#include <bendy/format/faults.h>
#include <bendy/format/public.h>
#include <bendy/format/records.h>

#include <cstdint>

// LIMT: what a joint may do. Both readers and writers hold constraints against the same rules.
namespace BENDY_PUBLIC bendy {

/// A constraint of a joint.
struct ConstraintView {
    std::uint32_t chunk = 0;
    std::uint32_t joint = 0;
    ConstraintRecord record;
};

/// Reads a LIMT chunk. A fault of shape (size, model, order, scope, flags) is added and gives false.
bool read_constraint(const ChunkTree& tree, std::uint32_t chunk, std::uint32_t joint, ConstraintView& constraint,
                     Faults& faults);

/// Adds what is wrong with a constraint's numbers: NaN, a frame that is no unit quaternion, a minimum above its
/// maximum, ranges that the model cannot have, stiffness outside 0 to 1, a rest pose outside the limits without the
/// flag that says so. The faults name `joint`, stand at `offset`, and count axes 0 to 2 for rotation, 3 to 5 for
/// translation.
void check_constraint(const ConstraintRecord& constraint, std::uint32_t joint, std::uint64_t offset, Faults& faults);

/// True when the rest pose, R = identity and no translation, is inside the limits: on the circle, and for an Euler box
/// in either of its two forms.
bool holds_rest(const ConstraintRecord& constraint);

/// How many of rotation_min and rotation_max count for the model: 3 (X, Y, Z), 1 (X: hinge, largest angle) or 0.
unsigned limited_axes(ConstraintModel model);

}  // namespace bendy
