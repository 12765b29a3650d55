#pragma once

#include "rest_frames.h"

#include <bendy/format/records.h>

#include <array>
#include <cstddef>

namespace bendy::converter {

/// The axes (0 X, 1 Y, 2 Z) of an order, the one that turns first first.
std::array<std::size_t, 3> axes_of(EulerOrder order);

/// Angles about X, Y, Z, radians, with rotation = R(last axis) * R(middle) * R(first); the middle one within +-pi/2.
std::array<double, 3> to_euler(const Rotation& rotation, EulerOrder order);

}  // namespace bendy::converter
