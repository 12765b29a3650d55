#pragma once

#include <bendy/format/clip.h>
#include <bendy/format/public.h>

#include <cstdint>
#include <span>
#include <string_view>

// Named curves of a clip: numbers that are animated beside joints and morph targets, such as a material's colour, a
// camera's field of view, or how firmly a foot stands.
namespace BENDY_PUBLIC bendy {

using Curve = CurveView;

/// The curve's value at `seconds` on its clip's own time line, component by component: step holds the key before,
/// linear goes straight, cubic is Hermite's spline with tangents times the distance of the keys. Before the first and
/// after the last key it holds their value. False for NaN, where `value` stays as it is.
/// \param value  takes Curve::components numbers; it may have room for more
bool sample_curve(const Curve& curve, double seconds, std::span<float> value);

/// The clip's first curve of that name; if none has the name, the first of that path. Null if there is none. Takes time
/// linear in the number of curves: keep the pointer, which is valid as long as the clip's model is.
const Curve* find_curve(const ClipView& clip, std::string_view name_or_path);

/// The curve of a property of one joint, material, mesh or texture; null if there is none.
const Curve* find_curve(const ClipView& clip, CurveTarget kind, std::uint32_t target, std::string_view path);

}  // namespace bendy
