#pragma once

#include <bendy/format/error.h>
#include <bendy/format/public.h>
#include <bendy/format/records.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

// STND: the pose in which the body stands, where that is not the rest pose.
namespace BENDY_PUBLIC bendy {

/// An object's STND, in place.
struct StandingPoseView {
    StandingPoseRecord pose;
    std::span<const StandingRotationRecord> rotations;  ///< ascending by joint
};

/// Reads the STND of an object and checks it: joints in range and ascending, unit rotations, finite numbers. Returns
/// nothing if there is none, or if it has a fault.
std::optional<StandingPoseView> read_standing_pose(const ChunkTree& tree, std::uint32_t object, std::uint32_t joints,
                                                   Faults& faults);

/// Returns the joint's rotation in model space: a unit quaternion x y z w with w >= 0.
std::array<float, 4> rotation_of(const StandingRotationRecord& record);

/// Returns the record of a joint's rotation in model space.
/// \param xyzw  unit quaternion
StandingRotationRecord standing_rotation(std::uint32_t joint, std::array<float, 4> xyzw);

/// Returns the payload of an STND.
std::vector<std::byte> write_standing_pose(const StandingPoseRecord& pose,
                                           std::span<const StandingRotationRecord> rotations);

}  // namespace bendy
