#pragma once

#include "clips.h"
#include "fields.h"
#include "joint_key.h"
#include "json_text.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/records.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bendy::converter {

/// What a source says of joints: their constraints.
struct RigEntry {
    JointKey key;
    std::string place;  ///< JSON path in the source
    std::vector<ConstraintRecord>
        constraints;  ///< at most one of each scope; pass check_constraint but for the rest pose; may be empty
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

/// What a source says of a clip: all of its markers.
struct RigClip {
    std::string key;    ///< the clip's name, or its number as `#12`
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
    std::optional<std::vector<RigClip>> clips;    ///< none: it says nothing of markers
    std::optional<std::vector<RigCurve>> curves;  ///< none: it says nothing of curves
};

/// One constraint of a rig file or of extras. The rest pose may lie outside; all else passes check_constraint. Fails at
/// the JSON path of what is wrong.
ConstraintRecord parse_constraint(const OrderedJson& value, const std::string& place, AngleUnit unit);

/// A joint's constraints: one, or a list, at most one of each scope.
std::vector<ConstraintRecord> parse_constraints(const OrderedJson& value, const std::string& place, AngleUnit unit);

/// Fails at `place` where check_constraint finds a fault other than a rest pose outside.
void check_constraint_at(const ConstraintRecord& constraint, const std::string& place);

/// One chain of a rig file or of extras. Fails at the JSON path of what is wrong.
RigChain parse_chain(const OrderedJson& value, const std::string& place, AngleUnit unit);

/// A rig file (spec/rig.md). Fails at the JSON path of what is wrong; text that is no JSON, with line and column.
Rig parse_rig(std::string_view text, Report& report);

/// The same from a file. Fails with an empty place where it cannot be read.
Rig read_rig(const std::filesystem::path& file, Report& report);

/// The member of a glTF scene's extras that holds a whole rig file: what `bendy export` writes.
inline constexpr const char* kRigInExtras = "bendy_rig";

/// Takes that member out of the scene's extras and reads it. Nothing if there is none, or if it is wrong, which the
/// report says.
std::optional<Rig> take_rig_from_extras(Scene& scene, Report& report);

}  // namespace bendy::converter
