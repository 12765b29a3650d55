#pragma once

#include <bendy/converter/error_bound.h>
#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <cstddef>
#include <functional>
#include <string_view>
#include <vector>

namespace bendy::converter {

struct CompactOptions {
    ErrorBound bound;
    std::function<void(double)> progress{};  ///< called with the fraction done, 0 to 1; may be empty
    std::size_t threads = 1;                 ///< maximum; the bytes do not depend on it
    /// Null, or the meshes before their vertices were sorted for levels of detail: tells what these cost.
    const std::vector<Mesh>* meshes_without_levels = nullptr;
};

/// Writes a scene in compact encodings, such that no point of the skin is further than the bound from its place in the
/// scene. This is measured on the file's bytes, read back, over the rest pose and all of every clip (measure_error).
/// The result goes to report.compact. A scene that cannot be kept within the bound is written exactly, with a warning.
std::vector<std::byte> build_compact(const Scene& exact, const CompactOptions& options, std::string_view generator,
                                     Report& report);

}  // namespace bendy::converter
