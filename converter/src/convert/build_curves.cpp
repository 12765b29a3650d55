#include "convert/build_curves.h"

#include "compact/pack_curve.h"

#include <optional>
#include <vector>

namespace bendy::converter {

void put_curves(LeafWriter& out, const Clip& clip) {
    constexpr LeafShape kFloats{0, 0, sizeof(float), false};
    for (const Curve& curve : clip.curves) {
        const std::optional<PackedCurve> packed = out.is_compact() ? pack_curve(curve) : std::nullopt;
        out.leaf(FourCC("CURV"), write_curve(packed ? packed->view(curve) : view_of(curve)), kFloats);
    }
}

}  // namespace bendy::converter
