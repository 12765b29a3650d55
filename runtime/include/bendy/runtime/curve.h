#pragma once

#include <bendy/format/clip.h>
#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>

#include <cstdint>
#include <span>
#include <string_view>

// Named curves of a clip: numbers that are animated beside joints and morph targets, such as a material's colour, a
// camera's field of view, or how firmly a foot stands.
namespace BENDY_PUBLIC bendy {

using Curve = CurveView;

/// The curve's value at `seconds` on its clip's own time line, component by component: step holds the previous key,
/// linear interpolates, and cubic is a Hermite spline whose tangents are multiplied by the distance between the keys.
/// Before the first key and after the last it holds their value. Allocates nothing. On an error, not_finite if
/// `seconds` is NaN or output_too_short, nothing is written.
/// \param value  receives Curve::components numbers; it may have room for more
[[nodiscard]] Result<void, CallError> sample_curve(const Curve& curve, double seconds, std::span<float> value);

/// The clip's first curve of that name; if none has the name, the first of that path. Null if there is none. Takes time
/// linear in the number of curves: keep the pointer, which is valid as long as the clip's model is.
[[nodiscard]] const Curve* find_curve(const ClipView& clip, std::string_view name_or_path);

/// The curve of a property of one joint, material, mesh or texture; null if there is none.
[[nodiscard]] const Curve* find_curve(const ClipView& clip, CurveTarget kind, std::uint32_t target,
                                      std::string_view path);

}  // namespace bendy
