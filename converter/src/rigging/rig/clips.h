#pragma once

#include "joint_key.h"
#include "scene/json_text.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <string>
#include <vector>

namespace bendy::converter {

struct Rig;

/// A marker with its JSON path in the source.
struct SourceMarker {
    Marker marker;
    std::string place;
};

/// How to handle an invalid marker.
enum class WrongMarkers : std::uint8_t {
    fail,      ///< at its place
    left_out,  ///< reported; the others are kept
};

/// Parses markers in JSON: `[{"time": 0.25, "name": "step"}]`, or `{"step": 0.25, "hit": [0.5, 1]}`; seconds. Fails at
/// `place` on any other value.
std::vector<SourceMarker> parse_markers(const OrderedJson& value, const std::string& place, WrongMarkers wrong,
                                        Report& report);

/// Replaces a clip's markers by these, sorted by time. A marker up to a millisecond outside the clip's keys is moved to
/// the nearest key; one further out is an error.
/// \param source  prefix for places in warnings, or empty
void set_markers(Clip& clip, std::vector<SourceMarker> markers, const std::string& source, WrongMarkers wrong,
                 Report& report);

/// Moves the member `markers` from the extras of a clip, whose tracks must be complete, to the clip's markers. Errors
/// are reported; if no marker can be read, the extras are unchanged.
/// \param place  of the extras
void take_markers_from_extras(Clip& clip, const std::string& place, Report& report);

/// Replaces the markers of the scene's clips by those of a source; a complete source that has markers also removes
/// those of all other clips. An entry that matches no clip is named in `report`. Fails at the JSON path of a marker
/// outside its clip, and of a second entry for one clip.
void attach_markers(Scene& scene, const Rig& rig, Report& report);

struct RigCurve {
    std::string clip;    ///< its name, or its number as `#12`
    std::string place;   ///< JSON path in the source
    std::string target;  ///< name or number of a thing of kind `curve.kind`
    Curve curve;         ///< without the number of its target
};

/// Parses the list `curves` of a rig file; fails at the JSON path of an error.
std::vector<RigCurve> parse_curves(const OrderedJson& value, const std::string& place);

/// Adds a source's curves to the scene's clips; each replaces a curve of the clip that animates the same property. A
/// complete source that has curves also removes all others. Clips keep their length; one without keys gets the length
/// of its curves. A curve of a clip that does not exist is named in `report`. Fails at the JSON path of a target that
/// does not exist, of a time outside the clip, and of a second curve for one property.
void attach_curves(Scene& scene, const Rig& rig, const JointIndex& index, Report& report);

}  // namespace bendy::converter
