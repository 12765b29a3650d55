#pragma once

#include "joint_key.h"
#include "parse_rig.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <string>
#include <unordered_set>
#include <vector>

namespace bendy::converter {

/// What sources of higher authority have spoken of: these joints' constraints and chains of these names stay as they
/// are.
struct Claims {
    std::vector<bool> joints;
    std::unordered_set<std::string> chains;
};

/// Gives a scene the constraints and chains of one source, but for what is claimed already, and claims them. A joint
/// takes the entry with its number, else with its name, else the last glob that fits. A rest pose outside its limits is
/// flagged and named in `report`, and so is an entry that no joint takes. Fails at the JSON path of a chain or weight
/// that the skeleton cannot have; the scene is unchanged then.
void attach_rig(Scene& scene, const Rig& rig, const JointIndex& index, Claims& claims, Report& report);

/// A chain with its joints looked up. Fails at its JSON path: joints that are not there, a start that is not above the
/// effector, a named weight outside the chain.
Chain resolve_chain(const RigChain& source, const Scene& scene, const JointIndex& index, WorkBudget& budget);

/// Sets the flag and warns where the rest pose lies outside.
void flag_rest_outside(ConstraintRecord& constraint, const std::string& joint, const std::string& place,
                       Report& report);

/// Gives a scene the constraints and chains that its extras speak of: rig_joint and rig_ik of nodes, rig_ik of the
/// scene (spec/rig.md), but for what is claimed already, and claims them. The extras stay as they are. What is wrong in
/// them is named in `report` and left out.
void attach_extras(Scene& scene, const JointIndex& index, Claims& claims, Report& report);

/// Gives joints that name an articulation of AGI_articulations (in Joint::extensions and Scene::extensions), have no
/// limits and are not `claimed`, one limit of its stages. A joint moves as its stages say and no other way. What a
/// limit cannot say (scale, several turns about one axis, translation after rotation) is approximated or named in
/// `report`; malformed articulations are named by JSON path and left out. \param claimed  by joint: somebody has said
/// that it has no limits; empty: nobody has
void add_articulations(Scene& scene, const std::vector<bool>& claimed, Report& report);

}  // namespace bendy::converter
