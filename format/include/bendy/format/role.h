#pragma once

#include <bendy/format/error.h>
#include <bendy/format/public.h>
#include <bendy/format/records.h>

#include <cstdint>
#include <span>
#include <string>

// ROLE: what joints are in the body: hips, left upper leg, the third joint of the tail.
namespace BENDY_PUBLIC bendy {

/// A branch of the skeleton with fewer joints is a part of a character, not one of its own.
inline constexpr std::uint32_t kFewestCharacterJoints = 12;

/// Reads the ROLE of an object, in place, and checks it: joints in range and ascending, known roles, each role and
/// place given once. Returns nothing if there is none, or if it has a fault.
std::span<const RoleRecord> read_roles(const ChunkTree& tree, std::uint32_t object, std::uint32_t joints,
                                       Faults& faults);

/// Returns the record of a joint, or null. `roles` ascend by joint.
const RoleRecord* role_of(std::span<const RoleRecord> roles, std::uint32_t joint);

/// Returns a known role in words: "left_hand", "tail 2".
std::string role_text(const RoleRecord& record);

}  // namespace bendy
