#pragma once

#include <draco/attributes/point_attribute.h>

#include <memory>

namespace bendy::converter::gltf {

/// An attribute that was decoded to integers, their way back to floats skipped, as floats. Null: it has none to go, or
/// its parameters make no sense. Draco's own code goes the same way, but where its build fuses multiplication and
/// addition (Debian's for ARM does) it ends in other floats.
std::unique_ptr<draco::PointAttribute> draco_floats(const draco::PointAttribute& source);

}  // namespace bendy::converter::gltf
