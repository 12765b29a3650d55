#pragma once

#include "json_text.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <string>
#include <vector>

namespace bendy::converter {

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

}  // namespace bendy::converter
