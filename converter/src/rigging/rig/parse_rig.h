#pragma once

#include "clips.h"
#include "fields.h"
#include "joint_key.h"
#include "scene/json_text.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/records.h>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bendy::converter {

/// The constraints of the joints that match a key.
struct RigEntry {
    JointKey key;
    std::string place;  ///< JSON path in the source
    std::vector<ConstraintRecord>
        constraints;  ///< at most one of each scope; pass check_constraint except for the rest pose; may be empty
};

/// A chain of a source. Joints are keys without globs; empty: none.
struct RigChain {
    std::string name;
    std::string place;  ///< JSON path in the source
    std::string start, effector, target, pole;
    ChainRecord record;  ///< without its joints
    std::vector<std::pair<JointKey, float>> weights;
    std::string extras;  ///< JSON text or empty
};

/// All markers that a source gives a clip.
struct RigClip {
    std::string key;    ///< the clip's name, or its number as `#12`
    std::string place;  ///< JSON path in the source
    std::vector<SourceMarker> markers;
};

/// The joints that a rig file gives a role, by their keys.
struct RigRole {
    Role role = Role::none;
    std::string place;  ///< JSON path in the source
    std::vector<std::string>
        joints;  ///< keys without globs; one or none, or the joints of a chain from the body outwards
};

/// The pose in which the body stands, by keys of joints.
struct RigStandingPose {
    StandingPoseRecord pose;
    std::vector<std::pair<std::string, std::array<float, 3>>> rotations;  ///< keys without globs
};

/// The constraints, chains and markers of one source, not yet matched to a skeleton. Sources of lower authority than
/// the rig file use the same form, and attach_rig checks them the same way.
struct Rig {
    std::string source;  ///< prefix for places in warnings, e.g. "fox.rig.json: "; or empty
    bool complete = false;
    std::vector<RigEntry> joints;
    std::vector<RigChain> chains;
    std::optional<std::vector<RigRole>> roles;  ///< nothing: it has no list of roles
    bool has_standing_pose = false;             ///< it says what the standing pose is, or that there is none
    std::optional<RigStandingPose> standing_pose;
    std::optional<std::vector<RigClip>> clips;    ///< nothing: it has no list of markers
    std::optional<std::vector<RigCurve>> curves;  ///< nothing: it has no list of curves
};

/// Parses one constraint. The rest pose may lie outside; all else passes check_constraint.
/// Fails at the JSON path of an error.
ConstraintRecord parse_constraint(const OrderedJson& value, const std::string& place, Notation notation);

/// Parses a joint's constraints: one, or a list, at most one of each scope.
std::vector<ConstraintRecord> parse_constraints(const OrderedJson& value, const std::string& place, Notation notation);

/// Fails at `place` if check_constraint finds a fault, other than a rest pose outside the limits.
void check_constraint_at(const ConstraintRecord& constraint, const std::string& place);

/// Parses what a chain has beside its name, joints, weights and extras. Fails at the JSON path of an error.
void parse_chain_settings(Fields& fields, ChainRecord& record);

/// Parses what a standing pose has beside its rotations. Fails at the JSON path of an error.
void parse_standing_settings(Fields& fields, StandingPoseRecord& record);

/// Parses the rotation of a joint: x y z of a unit quaternion whose w is not negative. Fails at the place.
std::array<float, 3> parse_standing_rotation(const OrderedJson& value, const std::string& place);

/// Parses one chain of a rig file or of extras. Fails at the JSON path of an error.
RigChain parse_chain(const OrderedJson& value, const std::string& place, Notation notation);

/// Parses a rig file (spec/rig.md). Fails at the JSON path of an error; for malformed JSON, with line and column.
Rig parse_rig(std::string_view text, Report& report);

/// As above, from a file. Fails with an empty place if it cannot be read.
Rig read_rig(const std::filesystem::path& file, Report& report);

/// The member of a glTF scene's extras that may hold a whole rig file (spec/rig.md).
inline constexpr const char* kRigInExtras = "bendy_rig";

/// Removes that member from the scene's extras and parses it. Nothing if it is missing or faulty; a fault is reported.
std::optional<Rig> take_rig_from_extras(Scene& scene, Report& report);

}  // namespace bendy::converter
