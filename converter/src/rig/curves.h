#pragma once

#include "joint_key.h"
#include "json_text.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::converter {

struct Rig;

/// In the order of Interpolation.
inline constexpr std::array<std::string_view, 3> kInterpolationNames{"step", "linear", "cubic"};

/// The keys of a curve's `target`, in the order of CurveTarget.
inline constexpr std::array<std::string_view, 5> kCurveTargetNames{"", "joint", "material", "mesh", "texture"};

/// A curve of a rig file.
struct RigCurve {
    std::string clip;    ///< its name, or its number as `#12`
    std::string place;   ///< JSON path in the source
    std::string target;  ///< name or number of what `curve.kind` says
    Curve curve;         ///< but for the number of its target
};

/// The list `curves` of a rig file; fails at the JSON path of what is wrong.
std::vector<RigCurve> parse_curves(const OrderedJson& value, const std::string& place);

/// Gives the scene's clips the curves of a source: each in place of one of the clip's that animates the same. A
/// complete source that says anything of curves leaves no others. A clip stays as long as it is; one without any keys
/// gets the length of its curves. A curve of a clip that does not exist is named in `report`. Fails at the JSON path of
/// a target that does not exist, of a time outside the clip, and of a second curve for one property.
void attach_curves(Scene& scene, const Rig& rig, const JointIndex& index, Report& report);

}  // namespace bendy::converter
