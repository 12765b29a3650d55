#include "leaf_form.h"

#include <algorithm>

namespace bendy::twin {

const RecordLayout& joint_polygons_layout() {
    static const std::vector<RecordField> fields = [] {
        std::vector<RecordField> all{{"JointPolygons", "joint", "u32", FieldType::u32, 1, 0}};
        for (RecordField field : find_layout("PolygonRecord")->fields) {
            field.offset += sizeof(std::uint32_t);
            all.push_back(field);
        }
        return all;
    }();
    static const RecordLayout layout{"JointPolygons", FourCC("JNTS"), sizeof(JointPolygons), sizeof(JointPolygons),
                                     fields};
    return layout;
}

std::vector<std::uint32_t> frame_widths(std::span<const std::byte> widths, std::uint32_t tracks,
                                        std::uint32_t components) {
    std::vector<std::uint32_t> in_order;
    in_order.reserve(widths.size());
    for (std::uint64_t first = 0; first < tracks; first += kPackedGroup) {
        const std::uint64_t last = std::min<std::uint64_t>(first + kPackedGroup, tracks);
        for (std::uint64_t c = 0; c < components; ++c) {
            for (std::uint64_t track = first; track < last; ++track)
                in_order.push_back(std::to_integer<std::uint32_t>(widths[c * tracks + track]));
        }
    }
    return in_order;
}

}  // namespace bendy::twin
