#include "passes/assign_polygons.h"

#include <algorithm>
#include <span>
#include <tuple>

namespace bendy::converter {
namespace {

/// The joint with the largest sum of weights over a polygon's corners.
std::uint32_t heaviest_joint(const Mesh& mesh, std::span<const std::uint32_t> corners) {
    struct Share {
        std::uint32_t joint;
        double weight;
    };
    std::vector<Share> shares;
    for (const std::uint32_t vertex : corners) {
        for (std::uint32_t k = 0; k < mesh.influences; ++k) {
            const std::size_t at = std::size_t{vertex} * mesh.influences + k;
            if (mesh.weights[at] == 0.0f) continue;
            const std::uint32_t joint = mesh.palette.joints[mesh.bones[at]];
            const auto known =
                std::find_if(shares.begin(), shares.end(), [&](const Share& share) { return share.joint == joint; });
            if (known == shares.end()) {
                shares.push_back({joint, mesh.weights[at]});
            } else {
                known->weight += mesh.weights[at];
            }
        }
    }
    const auto heavier = [](const Share& a, const Share& b) {
        return a.weight != b.weight ? a.weight < b.weight : a.joint > b.joint;
    };
    const auto heaviest = std::max_element(shares.begin(), shares.end(), heavier);
    return heaviest == shares.end() ? mesh.joint : heaviest->joint;
}

struct Polygon {
    std::uint32_t material;
    Topology topology;
    std::uint32_t joint;
    std::uint32_t part;
    std::uint32_t first;  // in the part's indices

    [[nodiscard]] auto key() const { return std::tie(material, topology, joint); }
};

}  // namespace

AssignedPolygons assign_polygons(const Mesh& mesh) {
    std::vector<Polygon> polygons;
    for (std::uint32_t number = 0; number < mesh.parts.size(); ++number) {
        const Part& part = mesh.parts[number];
        const std::uint32_t step = corners(part.topology);
        for (std::uint32_t first = 0; first + step <= part.indices.size(); first += step) {
            const std::uint32_t joint =
                mesh.influences == 0 ? mesh.joint : heaviest_joint(mesh, std::span(part.indices).subspan(first, step));
            polygons.push_back({part.material, part.topology, joint, number, first});
        }
    }
    std::stable_sort(polygons.begin(), polygons.end(),
                     [](const Polygon& a, const Polygon& b) { return a.key() < b.key(); });

    AssignedPolygons assigned;
    const Polygon* before = nullptr;
    for (const Polygon& polygon : polygons) {
        const auto at = static_cast<std::uint32_t>(assigned.indices.size());
        if (before == nullptr || before->key() != polygon.key()) {
            assigned.ranges.push_back({polygon.joint, polygon.material, polygon.topology, at, 0});
        }
        const std::uint32_t step = corners(polygon.topology);
        const auto source = std::span(mesh.parts[polygon.part].indices).subspan(polygon.first, step);
        assigned.indices.insert(assigned.indices.end(), source.begin(), source.end());
        assigned.ranges.back().count += step;
        before = &polygon;
    }
    return assigned;
}

}  // namespace bendy::converter
