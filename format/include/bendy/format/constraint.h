#pragma once

#include <bendy/format/error.h>
#include <bendy/format/public.h>
#include <bendy/format/records.h>

#include <array>
#include <cstddef>
#include <cstdint>

// LIMT: what a joint may do. Readers and writers check constraints against the same rules.
namespace BENDY_PUBLIC bendy {

/// A constraint of a joint.
struct ConstraintView {
    std::uint32_t chunk = 0;
    std::uint32_t joint = 0;
    ConstraintRecord record;

    [[nodiscard]] ConstraintModel model() const { return static_cast<ConstraintModel>(record.model); }
    [[nodiscard]] EulerOrder euler_order() const { return static_cast<EulerOrder>(record.euler_order); }
    [[nodiscard]] ConstraintScope scope() const { return static_cast<ConstraintScope>(record.scope); }
};

/// Reads a LIMT chunk. If its form is wrong (size, model, order, scope, flags), adds a fault and returns false.
bool read_constraint(const ChunkTree& tree, std::uint32_t chunk, std::uint32_t joint, ConstraintView& constraint,
                     Faults& faults);

/// Adds faults in the values of a constraint: NaN, a frame that is not a unit quaternion, a minimum above its maximum,
/// ranges that the model does not allow, stiffness outside 0 to 1, a rest pose outside the limits without the flag that
/// permits it. The faults name `joint`, have the given `offset`, and count axes 0 to 2 for rotation, 3 to 5 for
/// translation.
void check_constraint(const ConstraintRecord& constraint, std::uint32_t joint, std::uint64_t offset, Faults& faults);

/// Returns true if the rest pose, R = identity and no translation, is inside the limits: angles on the circle, and for
/// an Euler box in either of its two forms.
bool holds_rest(const ConstraintRecord& constraint);

/// Returns the axes (0 X, 1 Y, 2 Z) of an Euler box in the order of their rotations.
constexpr std::array<std::size_t, 3> axes_of(EulerOrder order) {
    std::array<std::size_t, 3> axes{};
    for (std::size_t i = 0; i < axes.size(); ++i)
        axes[i] = static_cast<std::size_t>(kValueNames<EulerOrder>[static_cast<std::size_t>(order)][i] - 'x');
    return axes;
}

/// Returns how many components of rotation_min and rotation_max the model uses: 3 (X, Y, Z), 1 (X: hinge, largest
/// angle) or 0.
unsigned limited_axes(ConstraintModel model);

}  // namespace bendy
