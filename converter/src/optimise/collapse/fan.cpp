#include "optimise/collapse/fan.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>

namespace bendy::converter {
namespace {

/// Maximum number of corners at the point and its target: bounds the work per step.
constexpr std::uint32_t kMostCorners = 100;
/// Cosine of the largest angle by which a triangle may turn at rest.
constexpr float kLeastCosine = 0.2f;

bool has(const Surface::Triangle& triangle, std::uint32_t point) {
    return triangle.points[0] == point || triangle.points[1] == point || triangle.points[2] == point;
}

}  // namespace

Fan::Fan(Surface& surface, const ShapedPlaces& places, const Appearance& appearance)
    : surface_(surface),
      places_(places),
      appearance_(appearance),
      corner_count_(surface.points(), 0),
      marks_(surface.points(), 0) {
    for (const Surface::Triangle& triangle : surface.triangles) {
        for (const std::uint32_t point : triangle.points) ++corner_count_[point];
    }
}

bool Fan::find(std::uint32_t point) {
    if (corner_count_[point] > kMostCorners) return false;
    surface_.find_corners(point, corners_);
    neighbours_.clear();
    const auto neighbour = [&](std::uint32_t other) -> Neighbour& {
        for (Neighbour& known : neighbours_) {
            if (known.point == other) return known;
        }
        neighbours_.push_back({other});
        return neighbours_.back();
    };
    for (const std::uint32_t corner : corners_) {
        const auto& p = surface_.triangles[corner / 3].points;
        ++neighbour(p[(corner % 3 + 1) % 3]).after;
        ++neighbour(p[(corner % 3 + 2) % 3]).before;
    }
    std::size_t ends = 0;
    for (const Neighbour& n : neighbours_) {
        if (n.before > 1 || n.after > 1) return false;
        ends += n.before + n.after == 1 ? 1 : 0;
    }
    is_border_ = ends != 0;
    return ends == 0 || ends == 2 ? is_connected() : false;
}

/// Walks around the fan from its end; a closed fan has no end, so from anywhere.
bool Fan::is_connected() const {
    std::uint32_t at = neighbours_.front().point;
    for (const Neighbour& n : neighbours_) {
        if (n.before == 0) at = n.point;
    }
    std::size_t steps = 0;
    for (bool moved = true; moved && steps < corners_.size();) {
        moved = false;
        for (const std::uint32_t corner : corners_) {
            const auto& p = surface_.triangles[corner / 3].points;
            if (p[(corner % 3 + 1) % 3] != at) continue;
            at = p[(corner % 3 + 2) % 3];
            ++steps;
            moved = true;
            break;
        }
    }
    return steps == corners_.size();
}

float Fan::apart(std::uint32_t a, std::uint32_t b) const {
    float sum = 0.0f;
    for (std::uint32_t k = 0; k < appearance_.components; ++k) {
        const float difference = appearance_.of(a)[k] - appearance_.of(b)[k];
        sum += difference * difference;
    }
    return sum;
}

/// Fills moves_ with the destination of each vertex of the point: along its side of a seam or, if it has none on this
/// edge, the vertex that looks most like it. False if a material would leave its border.
bool Fan::find_moves(std::uint32_t target) {
    moves_.clear();
    crosses_seam_ = false;
    std::array<std::uint32_t, 2> materials{kNone, kNone};
    std::size_t sides = 0;
    for (const std::uint32_t corner : corners_) {
        const Surface::Triangle& triangle = surface_.triangles[corner / 3];
        for (std::size_t k = 0; k < 3; ++k) {
            if (triangle.points[k] != target) continue;
            if (sides < 2) materials[sides++] = triangle.material;
            if (!add_move({surface_.alike[triangle.vertices[corner % 3]], surface_.alike[triangle.vertices[k]]}))
                return false;
        }
    }
    if (sides == 0 || (is_border_ && sides != 1)) return false;
    for (const std::uint32_t corner : corners_) {
        const Surface::Triangle& triangle = surface_.triangles[corner / 3];
        if (triangle.material != materials[0] && (sides != 2 || triangle.material != materials[1])) return false;
        const std::uint32_t from = surface_.alike[triangle.vertices[corner % 3]];
        if (std::any_of(moves_.begin(), moves_.end(), [&](const Move& move) { return move.from == from; })) continue;
        crosses_seam_ = true;
        moves_.push_back({from, most_alike(from)});
    }
    return true;
}

/// False where a seam ends: its triangles on this edge would connect two vertices and have no area.
bool Fan::add_move(const Move& move) {
    for (const Move& known : moves_) {
        if (known.from == move.from) return known.to == move.to;
    }
    moves_.push_back(move);
    return true;
}

/// The vertex at the target, among those that triangles use, that looks most like this one.
std::uint32_t Fan::most_alike(std::uint32_t vertex) const {
    std::uint32_t best = kNone;
    for (const std::uint32_t corner : target_corners_) {
        const std::uint32_t other = surface_.alike[surface_.triangles[corner / 3].vertices[corner % 3]];
        if (best == kNone || apart(vertex, other) < apart(vertex, best)) best = other;
    }
    return best;
}

/// Whether the collapse keeps the topology: the two points share no neighbours except those of their triangles, and no
/// triangle occurs twice. T. Dey and others, Topology Preserving Edge Contraction, 1999.
bool Fan::keeps_topology(std::uint32_t point, std::uint32_t target) {
    if (corner_count_[target] + corner_count_[point] > kMostCorners) return false;
    surface_.find_corners(target, target_corners_);
    const std::uint32_t mine = ++mark_;
    const std::uint32_t counted = ++mark_;
    for (const Neighbour& n : neighbours_) marks_[n.point] = mine;
    std::size_t common = 0;
    for (const std::uint32_t corner : target_corners_) {
        const Surface::Triangle& triangle = surface_.triangles[corner / 3];
        for (const std::uint32_t other : triangle.points) {
            if (other == target || other == point || marks_[other] != mine) continue;
            marks_[other] = counted;
            ++common;
        }
    }
    const auto shared =
        static_cast<std::size_t>(std::count_if(corners_.begin(), corners_.end(), [&](std::uint32_t corner) {
            return has(surface_.triangles[corner / 3], target);
        }));
    if (common != shared) return false;
    for (const std::uint32_t corner : corners_) {
        const auto& p = surface_.triangles[corner / 3].points;
        const std::uint32_t a = p[(corner % 3 + 1) % 3];
        const std::uint32_t b = p[(corner % 3 + 2) % 3];
        if (a == target || b == target) continue;
        for (const std::uint32_t other : target_corners_) {
            const Surface::Triangle& triangle = surface_.triangles[other / 3];
            if (has(triangle, a) && has(triangle, b)) return false;
        }
    }
    return true;
}

/// Fills left_ with the remaining triangles of the fan, moved; false if one would flip.
bool Fan::find_left(std::uint32_t point, std::uint32_t target) {
    left_.clear();
    for (const std::uint32_t corner : corners_) {
        const Surface::Triangle& before = surface_.triangles[corner / 3];
        if (has(before, target)) continue;
        Surface::Triangle after = before;
        after.points[corner % 3] = target;
        after.vertices[corner % 3] = moved(before.vertices[corner % 3]);
        if (turns_over(before, after)) return false;
        left_.emplace_back(corner / 3, after);
    }
    if (!left_.empty()) return true;
    // The point was the tip of a border: the target's other triangles show how far from the surface it was.
    for (const std::uint32_t corner : target_corners_) {
        if (!has(surface_.triangles[corner / 3], point)) left_.emplace_back(corner / 3, surface_.triangles[corner / 3]);
    }
    return !left_.empty();
}

bool Fan::turns_over(const Surface::Triangle& before, const Surface::Triangle& after) const {
    const auto normal = [&](std::size_t s, const Surface::Triangle& t) {
        return glm::cross(place(s, t.points[1]) - place(s, t.points[0]), place(s, t.points[2]) - place(s, t.points[0]));
    };
    const glm::vec3 a = normal(0, before);
    const glm::vec3 b = normal(0, after);
    const float lengths = glm::length(a) * glm::length(b);
    return glm::dot(a, a) > 0.0f && !(glm::dot(a, b) > kLeastCosine * lengths);
}

bool Fan::prepare(std::uint32_t point, std::uint32_t target) {
    return keeps_topology(point, target) && find_moves(target) && find_left(point, target);
}

void Fan::move_to(std::uint32_t target) {
    for (const std::uint32_t corner : corners_) {
        Surface::Triangle& triangle = surface_.triangles[corner / 3];
        if (has(triangle, target)) {
            triangle.is_alive = false;
            for (const std::uint32_t other : triangle.points) --corner_count_[other];
            continue;
        }
        --corner_count_[triangle.points[corner % 3]];
        ++corner_count_[target];
        triangle.points[corner % 3] = target;
        triangle.vertices[corner % 3] = moved(triangle.vertices[corner % 3]);
        surface_.next_corner[corner] = std::exchange(surface_.first_corner[target], corner);
    }
}

}  // namespace bendy::converter
