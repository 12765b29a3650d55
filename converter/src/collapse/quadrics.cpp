#include "collapse/quadrics.h"

#include <algorithm>
#include <tuple>

namespace bendy::converter {
namespace {

constexpr float kBorderFactor = 2.0f;   // of the squared distance from a border
constexpr float kLengthFactor = 1e-7f;  // of the squared length of the edge: decides on flat ground

}  // namespace

Quadrics::Quadrics(const Surface& surface, const ShapedPlaces& places, std::size_t shapes)
    : places_(places), shapes_(shapes), quadrics_(shapes * surface.points()), rims_(surface.points()) {
    for (const Surface::Triangle& triangle : surface.triangles) {
        for (std::size_t s = 0; s < shapes_; ++s) {
            const auto& p = triangle.points;
            const glm::vec3 cross = glm::cross(place(s, p[1]) - place(s, p[0]), place(s, p[2]) - place(s, p[0]));
            const float length = glm::length(cross);
            if (!(length > 0.0f)) continue;
            for (const std::uint32_t point : p)
                quadrics_[point * shapes_ + s].add_plane(cross / length, place(s, p[0]), length);
        }
    }
    add_rims(surface);
}

void Quadrics::add_rims(const Surface& surface) {
    struct Side {
        std::uint32_t low, high, material, corner;
    };
    std::vector<Side> sides;
    sides.reserve(surface.triangles.size() * 3);
    for (std::uint32_t corner = 0; corner < surface.triangles.size() * 3; ++corner) {
        const Surface::Triangle& triangle = surface.triangles[corner / 3];
        const std::size_t from = corner % 3;
        const std::size_t to = (from + 1) % 3;
        const bool swaps = triangle.points[from] > triangle.points[to];
        sides.push_back(
            {triangle.points[swaps ? to : from], triangle.points[swaps ? from : to], triangle.material, corner});
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
    });
    for (std::size_t first = 0; first < sides.size();) {
        std::size_t end = first;
        bool is_one_material = true;
        for (; end < sides.size() && sides[end].low == sides[first].low && sides[end].high == sides[first].high;
             ++end) {
            is_one_material = is_one_material && sides[end].material == sides[first].material;
        }
        const bool is_rim = end - first != 2 || !is_one_material;
        for (; first < end; ++first) {
            if (is_rim) add_rim(surface, sides[first].corner);
        }
    }
}

/// The plane through a side of a triangle, at right angles to it.
void Quadrics::add_rim(const Surface& surface, std::uint32_t corner) {
    const auto& p = surface.triangles[corner / 3].points;
    const std::uint32_t from = p[corner % 3];
    const std::uint32_t to = p[(corner % 3 + 1) % 3];
    const glm::vec3 along = place(0, to) - place(0, from);
    const glm::vec3 normal = glm::cross(place(0, p[1]) - place(0, p[0]), place(0, p[2]) - place(0, p[0]));
    const glm::vec3 across = glm::cross(along, normal);
    const float length = glm::length(across);
    if (!(length > 0.0f)) return;
    rims_[from].add_plane(across / length, place(0, from), glm::length(along));
    rims_[to].add_plane(across / length, place(0, from), glm::length(along));
}

float Quadrics::estimate(std::uint32_t point, std::uint32_t target) const {
    float worst = border_error(point, target);
    for (std::size_t s = 0; s < shapes_; ++s) {
        worst = std::max(worst,
                         (s == 0 ? 1.0f : kPosedFactor) * quadrics_[point * shapes_ + s].mean_error(place(s, target)));
    }
    const glm::vec3 way = place(0, target) - place(0, point);
    return worst + kLengthFactor * glm::dot(way, way);
}

float Quadrics::border_error(std::uint32_t point, std::uint32_t target) const {
    return kBorderFactor * rims_[point].mean_error(place(0, target));
}

void Quadrics::add_to(std::uint32_t target, std::uint32_t point) {
    for (std::size_t s = 0; s < shapes_; ++s) quadrics_[target * shapes_ + s].add(quadrics_[point * shapes_ + s]);
    rims_[target].add(rims_[point]);
}

}  // namespace bendy::converter
