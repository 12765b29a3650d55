#pragma once

#include "joint_key.h"
#include "parse_rig.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <string>
#include <unordered_set>
#include <vector>

namespace bendy::converter {

/// The joints and chain names that sources of higher authority have set: later sources do not change them.
struct Claims {
    std::vector<bool> joints;
    std::unordered_set<std::string> chains;
};

/// Adds the constraints and chains of one source to a scene, except for claimed ones, and claims them. A joint takes
/// the entry with its number, else the one with its name, else the last matching glob. A rest pose outside its limits
/// is flagged and named in `report`, and so is an entry that matches no joint. Fails at the JSON path of a chain or
/// weight that does not fit the skeleton; the scene is then unchanged.
void attach_rig(Scene& scene, const Rig& rig, const JointIndex& index, Claims& claims, Report& report);

/// Gives joints the roles that the rig names; other joints keep theirs, unless the rig gives the role to another joint.
/// Fails at the JSON path of a joint that does not exist or is named twice; the scene is then unchanged.
void attach_roles(Scene& scene, const Rig& rig, const JointIndex& index);
/// Sets the standing pose that the rig says, or removes it. Fails at the JSON path of a joint that does not exist or is
/// named twice; the scene is then unchanged.
void attach_standing_pose(Scene& scene, const Rig& rig, const JointIndex& index);
/// Sorts rotations by joint; fails at the place if a joint has two.
void sort_rotations(std::vector<StandingRotationRecord>& rotations, const std::string& place);
/// Returns the hips, if the rig names them and the scene has that joint; otherwise kNone.
std::uint32_t find_hips(const Rig& rig, const JointIndex& index);

/// Resolves the joints of a chain. Fails at its JSON path if a joint does not exist, the start is not above the
/// effector, or a named weight is outside the chain.
Chain resolve_chain(const RigChain& source, const Scene& scene, const JointIndex& index, WorkBudget& budget);

/// Sets the flag and warns if the rest pose lies outside the limits.
void flag_rest_outside(ConstraintRecord& constraint, const std::string& joint, const std::string& place,
                       Report& report);

/// Adds the constraints and chains in the scene's extras: rig_joint and rig_ik of nodes, rig_ik of the scene
/// (spec/rig.md), except for claimed ones, and claims them. The extras are unchanged. Faulty entries are named in
/// `report` and left out.
void attach_extras(Scene& scene, const JointIndex& index, Claims& claims, Report& report);

/// Adds a limit to each joint that names an articulation of AGI_articulations (in Joint::extensions and
/// Scene::extensions), has no limits and is not `claimed`. The limit lets the joint move only as the articulation's
/// stages do. Stages that a limit cannot express (scale, several turns about one axis, translation after rotation) are
/// approximated or named in `report`; malformed articulations are named by JSON path and left out.
/// \param claimed  by joint: another source has decided that it has no limits; empty: none has
void add_articulations(Scene& scene, const std::vector<bool>& claimed, Report& report);

}  // namespace bendy::converter
