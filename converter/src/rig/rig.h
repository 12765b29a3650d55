#pragma once

#include "joint_key.h"
#include "parse_markers.h"

#include <bendy/format/records.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bendy::converter {

/// What a source says of joints: their constraints.
struct RigEntry {
    JointKey key;
    std::string place;  ///< JSON path in the source
    std::vector<LimitRecord>
        limits;  ///< at most one of each scope; pass check_limit but for the rest pose; may be empty
};

/// What a source says of a chain. Joints are keys, no globs; empty: none.
struct RigChain {
    std::string name;
    std::string place;  ///< JSON path in the source
    std::string start, effector, target, pole;
    ChainRecord record;  ///< but for its joints
    std::vector<std::pair<JointKey, float>> weights;
    std::string extras;  ///< JSON text or empty
};

/// What a source says of a cycle: all of its markers.
struct RigCycle {
    std::string key;    ///< the cycle's name, or its number as `#12`
    std::string place;  ///< JSON path in the source
    std::vector<SourceMarker> markers;
};

/// The constraints, chains and markers of one source, not yet held against a skeleton. A source whose authority is
/// lower than the rig file's can be put into the same form, and attach_rig checks it the same way.
struct Rig {
    std::string source;  ///< what warnings name before the place, e.g. "fox.rig.json: "; or empty
    bool complete = false;
    std::vector<RigEntry> joints;
    std::vector<RigChain> chains;
    std::optional<std::vector<RigCycle>> cycles;  ///< none: it says nothing of markers
};

}  // namespace bendy::converter
