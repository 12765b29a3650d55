#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <cstdint>

namespace bendy::converter {

/// Merges clips that move different properties into one; older exporters write a motion as one clip per joint. Clips
/// are taken in order; one that moves a property that the merged clip already moves goes to the next merged clip. The
/// merged clip is named after the common prefix of all names, or else after the first clip; it repeats if all do.
/// Markers are kept; the report names the extras of all but the first, which are dropped.
/// \return the number of clips left
std::uint32_t merge_clips(Scene& scene, Report& report);

/// True if several clips look like parts of one motion: most of them move a single joint or mesh, and no two move the
/// same property.
bool is_spread_motion(const Scene& scene);

}  // namespace bendy::converter
