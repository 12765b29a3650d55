#pragma once

#include "compact/compact_geometry.h"

#include <string>

namespace bendy::converter {

struct SkinError {
    double metres = 0.0;
    std::string place;  ///< mesh, vertex of the source, pose
};

/// The largest distance between points of the two scenes' skins: at rest with the targets' rest weights, and in the
/// poses of sample_poses(exact) without.
SkinError measure_skin(const Scene& exact, const Scene& compact, const CompactGeometry& geometry);

}  // namespace bendy::converter
