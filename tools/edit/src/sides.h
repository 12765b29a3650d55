#pragma once

#include <bendy/format/document.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Left and right: names, and the joints that mirror one another.
namespace bendy::edit {

/// Returns the name of the thing on the other side: `LeftArm` and `RightArm`, `arm.L` and `arm.R`, `lShldr` and
/// `rShldr`, 左腕 and 右腕. A name that tells no side stays as it is.
std::string other_side(std::string_view name);

/// Returns for each name the number of the one of the other side; its own number if there is none. Of several with one
/// name, the first is paired with the first.
std::vector<std::uint32_t> pair_sides(std::span<const std::string_view> names);

/// How joints mirror one another, by joint.
struct JointSides {
    std::vector<std::uint32_t> other;  ///< the joint on the other side; its own number: none
    std::vector<bool> is_left;         ///< of a pair
    std::vector<bool> is_kept;         ///< below a joint of one side, without a counterpart: cannot be mirrored
    std::size_t pairs = 0;
};

/// Pairs joints by their roles, others by their names. The parents of a pair must be a pair, or one joint in the
/// middle.
JointSides pair_joints(const ObjectView& object);

}  // namespace bendy::edit
