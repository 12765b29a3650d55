#pragma once

#include "compact/measure.h"

#include <bendy/converter/scene.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace bendy::converter {

/// What became of one clip.
struct PackedReport {
    std::string name;
    std::uint64_t source_bytes = 0;  ///< key times and values as floats, shared arrays counted once
    std::uint64_t kept_bytes = 0;    ///< of these, what stays as timed keys
    std::uint64_t packed_bytes = 0;  ///< PACK payload in memory; 0: nothing has been packed
    std::uint64_t stored_bytes = 0;  ///< the same in the file
    double worst_error = 0.0;        ///< metres in model space
    std::uint32_t worst_joint = kNone;
    double worst_time = 0.0;  ///< seconds
};

struct PackOptions {
    Probes probes = Probes::skin_and_shell;
    std::function<void(double)> progress{};  ///< is told the part that is done, 0 to 1; may be empty
    std::size_t threads = 1;                 ///< at most; the result does not depend on it
};

/// Packs the clips' tracks (Clip::packed) where that is smaller than timed keys, and takes them out of Clip::tracks.
/// A track that cannot be packed, because it is stepped or cubic, moves weights or has keys on no grid, stays. No probe
/// ever is farther than the clip's bound from where the source has it: measured on the bytes that result, 240 times a
/// second and at all keys.
/// \param max_errors  of each clip: metres in model space; 0: the clip is left as it is
std::vector<PackedReport> pack_clips(Scene& scene, std::span<const double> max_errors, const PackOptions& options = {});

}  // namespace bendy::converter
