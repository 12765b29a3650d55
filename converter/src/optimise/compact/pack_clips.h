#pragma once

#include "optimise/compact/measure.h"

#include <bendy/converter/scene.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace bendy::converter {

/// Result of packing one clip.
struct PackedReport {
    std::string name;
    std::uint64_t source_bytes = 0;  ///< key times and values as floats, shared arrays counted once
    std::uint64_t kept_bytes = 0;    ///< the part of these that stays as timed keys
    std::uint64_t packed_bytes = 0;  ///< PACK payload in memory; 0: nothing was packed
    double worst_error = 0.0;        ///< metres in model space
    std::uint32_t worst_joint = kNone;
    double worst_time = 0.0;  ///< seconds
};

struct PackOptions {
    Probes probes = Probes::skin_and_shell;
    std::function<void(double)> progress{};  ///< called with the fraction done, 0 to 1; may be empty
    std::size_t threads = 1;                 ///< maximum; the result does not depend on it
    bool only_keys = false;                  ///< measure at the keys alone: the caller measures the rest
};

/// Packs the clips' tracks (Clip::packed) where that is smaller than timed keys, and removes them from Clip::tracks.
/// Tracks that cannot be packed (stepped or cubic, weights, keys on no grid) stay. No probe is ever farther than the
/// clip's bound from its place in the source: measured on the resulting bytes, at all keys and, unless
/// options.only_keys is set, 240 times a second.
/// \param max_errors  per clip: metres in model space; 0: the clip is unchanged
std::vector<PackedReport> pack_clips(Scene& scene, std::span<const double> max_errors, const PackOptions& options = {});

}  // namespace bendy::converter
