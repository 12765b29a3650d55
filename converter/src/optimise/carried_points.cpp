#include "optimise/carried_points.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace bendy::converter {
namespace {

constexpr std::size_t kMostPoints = 8;  // of a box without parts

}  // namespace

void CarriedPoints::clear() {
    points_.clear();
    nodes_.clear();
}

void CarriedPoints::build() {
    std::stable_sort(points_.begin(), points_.end(),
                     [](const Point& a, const Point& b) { return a.carrier < b.carrier; });
    for (std::size_t first = 0; first < points_.size();) {
        std::size_t end = first;
        while (end < points_.size() && points_[end].carrier == points_[first].carrier) ++end;
        add_nodes(first, end);
        first = end;
    }
}

/// Halves the points until each box has few. Joints are numbered tree by tree, so neighbours in the list are near.
void CarriedPoints::add_nodes(std::size_t first, std::size_t end) {
    struct Open {
        std::size_t first = 0, count = 0;
        std::size_t closes = 0;  // the node that ends here, if there are no points
    };
    const std::size_t root = nodes_.size();
    std::vector<Open> open{{first, end - first, 0}};
    while (!open.empty()) {
        const Open part = open.back();
        open.pop_back();
        if (part.count == 0) {
            nodes_[part.closes].end = nodes_.size();
            continue;
        }
        Box<glm::dvec3> box;
        Node& node = nodes_.emplace_back();
        node.first = part.first;
        node.count = part.count;
        node.end = nodes_.size();
        node.is_first = nodes_.size() == root + 1;
        for (std::size_t at = part.first; at < part.first + part.count; ++at) {
            const Point& point = points_[at];
            box.add(point.exact);
            const double apart = glm::distance(point.exact, point.decoded);
            if (!(apart <= node.apart)) node.apart = apart;
        }
        node.middle = 0.5 * (box.low + box.high);
        node.half = glm::max(box.high - node.middle, node.middle - box.low);
        if (part.count <= kMostPoints) continue;
        const std::size_t half = part.count / 2;
        open.push_back({0, 0, nodes_.size() - 1});
        open.push_back({part.first + half, part.count - half, 0});
        open.push_back({part.first, half, 0});
    }
}

void CarriedPoints::set_carrier(std::uint32_t carrier, const EvaluatedPose& exact, const EvaluatedPose& decoded) {
    const Affine place = carrier == kNone ? Affine() : Affine(exact.joints[carrier]);
    decoded_ = carrier == kNone ? Affine() : Affine(decoded.joints[carrier]);
    difference_ = {place.linear - decoded_.linear, place.origin - decoded_.origin};
}

/// With the places P and Q of the carrier, a point's two places p and q in it differ by P p - Q q = (P - Q) p + Q (p -
/// q).
double CarriedPoints::bound(const Node& node) const {
    constexpr double kRounding = 1e-9;
    const glm::dmat3& m = difference_.linear;
    const glm::dvec3 lengths(glm::length(m[0]), glm::length(m[1]), glm::length(m[2]));
    double most = glm::length(difference_(node.middle)) + glm::dot(lengths, node.half);
    if (node.apart > 0.0) {
        const glm::dmat3& q = decoded_.linear;
        most += node.apart * std::sqrt(glm::dot(q[0], q[0]) + glm::dot(q[1], q[1]) + glm::dot(q[2], q[2]));
    }
    return most * (1.0 + kRounding) + 1e-3 * kRounding * glm::dot(lengths, glm::abs(node.middle));
}

double CarriedPoints::distance(const Point& point) const {
    const glm::dvec3 off = difference_(point.exact);
    if (point.exact == point.decoded) return glm::length(off);
    return glm::length(off + decoded_.linear * (point.exact - point.decoded));
}

}  // namespace bendy::converter
