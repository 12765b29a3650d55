#pragma once

#include <bendy/converter/scene.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>

namespace bendy::converter {

/// The property that a curve animates; unique within a clip. Curves without a path differ by name.
using CurveProperty = std::tuple<CurveTarget, std::uint32_t, std::string_view, std::string_view>;

/// As above, but owning its memory, for containers that outlive the curve.
using OwnProperty = std::tuple<CurveTarget, std::uint32_t, std::string, std::string>;

/// Path prefix of curves that animate a joint's camera: glTF's cameras are kept with the joints that use them.
inline constexpr std::string_view kCameraPath = "camera/";

/// The property of a curve; refers to the curve's memory.
inline CurveProperty property_of(const Curve& curve) {
    return {curve.kind, curve.target, curve.path, curve.path.empty() ? curve.name : std::string_view()};
}

inline OwnProperty own_property_of(const Curve& curve) {
    return OwnProperty(property_of(curve));
}

}  // namespace bendy::converter
