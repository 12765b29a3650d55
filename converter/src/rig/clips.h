#pragma once

#include "joint_key.h"
#include "json_text.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <string>
#include <vector>

namespace bendy::converter {

struct Rig;

/// A marker, and its JSON path in the source.
struct SourceMarker {
    Marker marker;
    std::string place;
};

/// What becomes of a marker that is wrong.
enum class WrongMarkers : std::uint8_t {
    fail,      ///< at its place
    left_out,  ///< named in the report; the others stay
};

/// Markers as JSON has them: `[{"time": 0.25, "name": "step"}]`, or `{"step": 0.25, "hit": [0.5, 1]}`; seconds. Fails
/// at `place` on any other value.
std::vector<SourceMarker> parse_markers(const OrderedJson& value, const std::string& place, WrongMarkers wrong,
                                        Report& report);

/// Gives a clip these markers in place of its own, in the order of their times. One that lies up to a millisecond
/// outside the clip's keys is moved to the nearest key; one that lies further out is wrong.
/// \param source  what warnings name before the markers' places, or empty
void set_markers(Clip& clip, std::vector<SourceMarker> markers, const std::string& source, WrongMarkers wrong,
                 Report& report);

/// Takes the member `markers` out of the extras of a clip whose tracks are there, and gives the clip these markers.
/// What is wrong is named in the report; extras of which no marker could be read stay as they are.
/// \param place  of the extras
void take_markers_from_extras(Clip& clip, const std::string& place, Report& report);

/// Gives the scene's clips the markers of a source, in place of their own; a complete one that says anything of
/// markers leaves no others. An entry that no clip takes is named in `report`. Fails at the JSON path of a marker
/// outside its clip, and of a second entry for one clip.
void attach_markers(Scene& scene, const Rig& rig, Report& report);

/// A curve of a rig file.
struct RigCurve {
    std::string clip;    ///< its name, or its number as `#12`
    std::string place;   ///< JSON path in the source
    std::string target;  ///< name or number of what `curve.kind` says
    Curve curve;         ///< but for the number of its target
};

/// The list `curves` of a rig file; fails at the JSON path of what is wrong.
std::vector<RigCurve> parse_curves(const OrderedJson& value, const std::string& place);

/// Gives the scene's clips the curves of a source: each in place of one of the clip's that animates the same. A
/// complete source that says anything of curves leaves no others. A clip stays as long as it is; one without any keys
/// gets the length of its curves. A curve of a clip that does not exist is named in `report`. Fails at the JSON path of
/// a target that does not exist, of a time outside the clip, and of a second curve for one property.
void attach_curves(Scene& scene, const Rig& rig, const JointIndex& index, Report& report);

}  // namespace bendy::converter
