#pragma once

#include <bendy/converter/error_bound.h>
#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <cstddef>
#include <functional>
#include <string_view>
#include <vector>

namespace bendy::converter {

/// Writes a scene in compact encodings, such that no point of the skin is further than the bound from where the scene
/// has it. That is measured: on the file's bytes, read back, over the rest pose and all of every clip (measure_error).
/// What was found goes to report.compact. A scene that cannot be kept inside the bound is written exactly, with a
/// warning.
/// \param progress  is told the part that is done, 0 to 1; may be empty
std::vector<std::byte> build_compact(const Scene& exact, const ErrorBound& bound, std::string_view generator,
                                     Report& report, const std::function<void(double)>& progress);

}  // namespace bendy::converter
