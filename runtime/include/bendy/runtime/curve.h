#pragma once

#include <bendy/format/clip.h>
#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>

#include <cstdint>
#include <span>
#include <string_view>

// Named curves of a clip: animated numbers other than joints and morph targets, such as a material's colour, a camera's
// field of view, or how firmly a foot is planted.
namespace BENDY_PUBLIC bendy {

using Curve = CurveView;

/// Evaluates a curve at `seconds` on its clip's time line, component by component: step holds the previous key, linear
/// interpolates, and cubic is a Hermite spline whose tangents are multiplied by the distance between the keys. Before
/// the first key and after the last one, the value of that key is returned. Allocates nothing. Errors: not_finite if
/// `seconds` is NaN, output_too_short; nothing is written then.
/// \param value  receives Curve::components numbers; may be larger
[[nodiscard]] Result<void, CallError> sample_curve(const Curve& curve, double seconds, std::span<float> value);

/// Returns the clip's first curve with that name or, if none has that name, the first with that path; null if there is
/// neither. Takes time linear in the number of curves: keep the pointer, which is valid as long as the clip's model is.
[[nodiscard]] const Curve* find_curve(const ClipView& clip, std::string_view name_or_path);

/// Returns the curve of a property of one joint, material, mesh or texture; null if there is none.
[[nodiscard]] const Curve* find_curve(const ClipView& clip, CurveTarget kind, std::uint32_t target,
                                      std::string_view path);

}  // namespace bendy
