#include "collapse/lock_shared_borders.h"

#include <algorithm>
#include <cstddef>
#include <tuple>

namespace bendy::converter {

void lock_shared_borders(std::span<const std::vector<Shape>> shapes, std::span<Surface> surfaces) {
    if (surfaces.size() < 2) return;
    struct BorderPoint {
        float x, y, z;
        std::size_t mesh;
        std::uint32_t point;
        [[nodiscard]] auto place() const { return std::tie(x, y, z); }
    };
    std::vector<BorderPoint> borders;
    for (std::size_t mesh = 0; mesh < surfaces.size(); ++mesh) {
        const std::vector<bool> is_border = find_borders(surfaces[mesh]);
        for (std::uint32_t point = 0; point < is_border.size(); ++point) {
            if (!is_border[point]) continue;
            const glm::vec3 p = shapes[mesh].front()[surfaces[mesh].vertex_of(point)] + 0.0f;
            borders.push_back({p.x, p.y, p.z, mesh, point});
        }
    }
    std::sort(borders.begin(), borders.end(), [](const BorderPoint& a, const BorderPoint& b) {
        return std::tie(a.x, a.y, a.z, a.mesh, a.point) < std::tie(b.x, b.y, b.z, b.mesh, b.point);
    });
    for (std::size_t first = 0; first < borders.size();) {
        std::size_t end = first;
        while (end < borders.size() && borders[end].place() == borders[first].place()) ++end;
        const bool is_shared = borders[first].mesh != borders[end - 1].mesh;
        for (; first < end; ++first) {
            if (is_shared) surfaces[borders[first].mesh].is_locked[borders[first].point] = true;
        }
    }
}

}  // namespace bendy::converter
