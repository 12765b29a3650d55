#pragma once

#include <bendy/converter/scene.h>
#include <bendy/format/curve.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace bendy::converter {

/// A view for write_curve, with unpacked values. It refers to the curve's memory.
CurveView view_of(const Curve& curve);

/// A curve's values as u16 within the range of each component.
struct PackedCurve {
    std::vector<float> box;             ///< the minimum of each component, then the maximum of each
    std::vector<std::uint16_t> values;  ///< as many as the curve has
    float max_error = 0.0f;             ///< largest difference between a decoded value and the curve's
    double share = 0.0;                 ///< the largest error as a share of its component's range

    /// The packed curve for write_curve. It refers to the memory of both.
    [[nodiscard]] CurveView view(const Curve& curve) const;
};

/// Packs a curve's values if that makes its chunk smaller, and each decoded value is within 0.51 steps of the
/// component's range / 65535: half a step, plus the rounding to 32-bit floats. Curves of whole numbers only (booleans,
/// counts) are packed only if they decode exactly. Cubic curves never are.
std::optional<PackedCurve> pack_curve(const Curve& curve);

}  // namespace bendy::converter
