#pragma once

#include "measure_error.h"

#include <bendy/converter/scene.h>

#include <string>
#include <string_view>

namespace bendy::converter {

/// `"Hips"`, or `#3` of what has no name.
std::string quoted_name(std::string_view name, std::uint32_t number);

/// Where an error was met, in words: `mesh "Body", vertex 3, cycle "Walk" at 0.250 s`; empty if nowhere.
std::string place_of(const Scene& scene, const MeasuredError& error);

}  // namespace bendy::converter
