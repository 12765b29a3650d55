#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <cstdint>

namespace bendy::converter {

/// Makes one clip of all that move different properties, as older exporters write a motion: one clip a joint. Clips
/// are taken in order; one that moves a property that the merged clip moves already goes to the next one. The merged
/// clip has the name that the first one's begins with and all others' too, or the first one's; it repeats if all do.
/// Markers are kept; extras of all but the first are named in the report. \return clips that are left
std::uint32_t merge_clips(Scene& scene, Report& report);

/// True of several clips that look like one motion: most of them move a single joint or mesh each, and no two the same
/// property.
bool is_spread_motion(const Scene& scene);

}  // namespace bendy::converter
