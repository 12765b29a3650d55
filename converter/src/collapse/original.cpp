#include "collapse/original.h"

#include "collapse/closest_point.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace bendy::converter {
namespace {

constexpr std::uint32_t kLeaf = 4;  // triangles

float outside(const glm::vec3& low, const glm::vec3& high, const glm::vec3& place) {
    const glm::vec3 out = glm::max(glm::max(low - place, place - high), glm::vec3(0.0f));
    return glm::dot(out, out);
}

}  // namespace

Original::Original(const Surface& surface, std::span<const std::vector<glm::vec3>> places) : places_(places) {
    triangles_.reserve(surface.triangles.size());
    for (const Surface::Triangle& triangle : surface.triangles) triangles_.push_back(triangle.vertices);
    order_.resize(triangles_.size());
    std::iota(order_.begin(), order_.end(), 0u);
    if (!order_.empty()) build();
    fit_boxes();
}

glm::vec3 Original::centre(std::uint32_t triangle) const {
    const auto& v = triangles_[triangle];
    return places_[0][v[0]] + places_[0][v[1]] + places_[0][v[2]];
}

/// Halves; so it goes no deeper than the logarithm of the triangles.
void Original::build() {
    struct Range {
        std::uint32_t first, count, parent;  // parent: whose right child it is; kNone: a left one
    };
    std::vector<Range> open{{0, static_cast<std::uint32_t>(order_.size()), kNone}};
    while (!open.empty()) {
        const Range part = open.back();
        open.pop_back();
        const auto number = static_cast<std::uint32_t>(nodes_.size());
        if (part.parent != kNone) nodes_[part.parent].right = number;
        nodes_.push_back({0, part.first, part.count <= kLeaf ? part.count : 0});
        if (part.count <= kLeaf) continue;
        const int axis = longest_side(part.first, part.count);
        const auto before = [&](std::uint32_t a, std::uint32_t b) {
            return std::pair(centre(a)[axis], a) < std::pair(centre(b)[axis], b);
        };
        const std::uint32_t half = part.count / 2;
        const auto begin = order_.begin() + part.first;
        std::nth_element(begin, begin + half, begin + part.count, before);
        open.push_back({part.first + half, part.count - half, number});
        open.push_back({part.first, half, kNone});
    }
}

int Original::longest_side(std::uint32_t first, std::uint32_t count) const {
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high(std::numeric_limits<float>::lowest());
    for (std::uint32_t k = first; k < first + count; ++k) {
        low = glm::min(low, centre(order_[k]));
        high = glm::max(high, centre(order_[k]));
    }
    const glm::vec3 size = high - low;
    return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

void Original::fit_boxes() {
    for (const std::vector<glm::vec3>& places : places_) {
        std::vector<Box>& boxes = boxes_.emplace_back(nodes_.size());
        for (std::size_t number = nodes_.size(); number-- > 0;) {
            const Node& node = nodes_[number];
            Box& box = boxes[number];
            if (node.count == 0) {
                box.low = glm::min(boxes[number + 1].low, boxes[node.right].low);
                box.high = glm::max(boxes[number + 1].high, boxes[node.right].high);
                continue;
            }
            box.low = box.high = places[triangles_[order_[node.first]][0]];
            for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
                for (const std::uint32_t vertex : triangles_[order_[k]]) {
                    box.low = glm::min(box.low, places[vertex]);
                    box.high = glm::max(box.high, places[vertex]);
                }
            }
        }
    }
}

float Original::distance_squared(std::size_t shape, const glm::vec3& place, float enough, std::uint32_t& near) const {
    if (nodes_.empty()) return 0.0f;
    const std::vector<glm::vec3>& places = places_[shape];
    const std::vector<Box>& boxes = boxes_[shape];
    const auto distance_to = [&](std::uint32_t triangle) {
        const auto& v = triangles_[triangle];
        return closest_point(place, places[v[0]], places[v[1]], places[v[2]]).distance_squared;
    };
    struct Open {
        float distance;
        std::uint32_t node;
    };
    std::array<Open, 64> open{};  // deeper than any tree of halves
    std::size_t size = 0;
    open[size++] = {0.0f, 0};
    float best = distance_to(near);
    while (size != 0 && best > enough) {
        const Open next = open[--size];
        if (next.distance >= best) continue;
        const Node& node = nodes_[next.node];
        if (node.count == 0) {
            Open left{outside(boxes[next.node + 1].low, boxes[next.node + 1].high, place), next.node + 1};
            Open right{outside(boxes[node.right].low, boxes[node.right].high, place), node.right};
            if (right.distance < left.distance) std::swap(left, right);
            if (right.distance < best) open[size++] = right;
            if (left.distance < best) open[size++] = left;
            continue;
        }
        for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
            const float distance = distance_to(order_[k]);
            if (!(distance < best)) continue;
            best = distance;
            near = order_[k];
        }
    }
    return best;
}

}  // namespace bendy::converter
