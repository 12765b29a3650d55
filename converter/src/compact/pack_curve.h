#pragma once

#include <bendy/converter/scene.h>
#include <bendy/format/curve.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace bendy::converter {

/// A curve for write_curve, with its values as they are. It refers to the curve's memory.
CurveView view_of(const Curve& curve);

/// A curve's values as u16 in the range of each component.
struct PackedCurve {
    std::vector<float> box;             ///< the smallest value of each component, then the largest of each
    std::vector<std::uint16_t> values;  ///< as many as the curve has
    float max_error = 0.0f;             ///< largest difference between a stored value and the curve's
    double share = 0.0;                 ///< the same as a share of its component's range, the largest

    /// The packed curve for write_curve. It refers to the memory of both.
    [[nodiscard]] CurveView view(const Curve& curve) const;
};

/// Packs a curve's values if that makes its chunk smaller, and each value comes back within 0.51 steps of its
/// component's range / 65535: half a step, and what rounding to 32-bit floats adds. Curves that hold nothing but whole
/// numbers (booleans, counts) are packed only where they come back exactly. Cubic curves never are.
std::optional<PackedCurve> pack_curve(const Curve& curve);

}  // namespace bendy::converter
