#pragma once

#include "effort.h"
#include "joint_index.h"
#include "rig.h"

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
Chain resolve_chain(const RigChain& source, const Scene& scene, const JointIndex& index, Effort& effort);

/// Sets the flag and warns where the rest pose lies outside.
void flag_rest_outside(LimitRecord& limit, const std::string& joint, const std::string& place, Report& report);

}  // namespace bendy::converter
