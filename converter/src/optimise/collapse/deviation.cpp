#include "optimise/collapse/deviation.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <utility>

namespace bendy::converter {
namespace {

// The deviation, in extents of the mesh, that counts as much as the given change of a normal, colour or coordinate.
constexpr float kNormal = 0.0015f;  // a normal that differs by 1
constexpr float kColour = 0.005f;   // a colour that differs by 1
constexpr float kSlide = 0.02f;     // a texture that slides by 1 extent
constexpr std::size_t kMostCoords = 2;
constexpr std::size_t kMostColours = 1;
/// A mesh with fewer vertices gets additional samples, up to this total.
constexpr std::size_t kFewestSamples = 6000;

float area_of(std::span<const glm::vec3> places, const std::array<std::uint32_t, 3>& v) {
    return 0.5f * glm::length(glm::cross(places[v[1]] - places[v[0]], places[v[2]] - places[v[0]]));
}

/// Extents of the mesh per unit of texture coordinates, on average.
float texture_scale(const Surface& surface, std::span<const glm::vec3> shape, const Stream& stream) {
    double surface_area = 0.0;
    double texture_area = 0.0;
    const auto coords = [&](std::uint32_t v) {
        return glm::vec2(stream.values[std::size_t{v} * 2], stream.values[std::size_t{v} * 2 + 1]);
    };
    for (const Surface::Triangle& triangle : surface.triangles) {
        surface_area += area_of(shape, triangle.vertices);
        const glm::vec2 a = coords(triangle.vertices[1]) - coords(triangle.vertices[0]);
        const glm::vec2 b = coords(triangle.vertices[2]) - coords(triangle.vertices[0]);
        texture_area += 0.5f * std::abs(a.x * b.y - a.y * b.x);
    }
    const double scale = std::sqrt(surface_area / texture_area);
    return std::isfinite(scale) ? static_cast<float>(scale) : 0.0f;
}

class Sampler {
public:
    Sampler(const Surface& surface, std::span<const std::vector<glm::vec3>> places, const Appearance& appearance)
        : surface_(surface), places_(places), appearance_(appearance), samples_(places.size()) {
        samples_.places.reserve(std::max<std::size_t>(surface.points(), kFewestSamples));
        samples_.components = appearance.components;
        samples_.first.assign(surface.triangles.size(), kNone);
    }

    Samples run() {
        add_vertices();
        add_inner();
        return std::move(samples_);
    }

private:
    void add(std::uint32_t triangle, const glm::vec3& weights) {
        const auto& v = surface_.triangles[triangle].vertices;
        samples_.places.add([&](std::size_t s) {
            return weights.x * places_[s][v[0]] + weights.y * places_[s][v[1]] + weights.z * places_[s][v[2]];
        });
        for (std::uint32_t k = 0; k < appearance_.components; ++k) {
            samples_.appearance.push_back(weights.x * appearance_.of(v[0])[k] + weights.y * appearance_.of(v[1])[k] +
                                          weights.z * appearance_.of(v[2])[k]);
        }
        samples_.next.push_back(kNone);
        samples_.hold(triangle, static_cast<std::uint32_t>(samples_.next.size() - 1));
    }

    void add_vertices() {
        std::vector<bool> is_done(surface_.points());
        for (std::uint32_t triangle = 0; triangle < surface_.triangles.size(); ++triangle) {
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t point = surface_.triangles[triangle].points[static_cast<std::size_t>(k)];
                if (is_done[point]) continue;
                is_done[point] = true;
                glm::vec3 weights(0.0f);
                weights[k] = 1.0f;
                add(triangle, weights);
            }
        }
    }

    void add_inner() {
        const std::size_t done = samples_.next.size();
        if (done >= kFewestSamples) return;
        double whole = 0.0;
        for (const Surface::Triangle& triangle : surface_.triangles) whole += area_of(places_[0], triangle.vertices);
        if (!(whole > 0.0)) return;
        const double per_area = static_cast<double>(kFewestSamples - done) / whole;
        double owed = 0.0;
        float u = 0.5f;  // Roberts' R2 sequence: evenly spread and deterministic
        float v = 0.5f;
        for (std::uint32_t triangle = 0; triangle < surface_.triangles.size(); ++triangle) {
            owed += per_area * area_of(places_[0], surface_.triangles[triangle].vertices);
            while (owed >= 1.0) {
                owed -= 1.0;
                u += 0.7548776662f;
                v += 0.5698402909f;
                u -= u >= 1.0f ? 1.0f : 0.0f;
                v -= v >= 1.0f ? 1.0f : 0.0f;
                const bool folds = u + v > 1.0f;
                const float x = folds ? 1.0f - u : u;
                const float y = folds ? 1.0f - v : v;
                add(triangle, {1.0f - x - y, x, y});
            }
        }
    }

    const Surface& surface_;
    std::span<const std::vector<glm::vec3>> places_;
    const Appearance& appearance_;
    Samples samples_;
};

constexpr std::uint32_t kLeaf = 4;  // triangles
/// Triangles that are tested for one distance: needles that overlap in a box would all be. Other surfaces need tens.
constexpr std::size_t kMostTested = 512;

float outside(const Box<glm::vec3>& box, const glm::vec3& place) {
    const glm::vec3 out = glm::max(glm::max(box.low - place, place - box.high), glm::vec3(0.0f));
    return glm::dot(out, out);
}

constexpr float kBorderFactor = 2.0f;   // on the squared distance from a border
constexpr float kLengthFactor = 1e-7f;  // on the squared length of the edge: breaks ties on flat regions

}  // namespace

Appearance make_appearance(const Mesh& mesh, const Surface& surface, std::span<const glm::vec3> shape) {
    struct Source {
        const float* values;
        std::uint32_t components;
        float scale;
    };
    std::vector<Source> sources;
    if (!mesh.normals.empty()) sources.push_back({&mesh.normals.front().x, 3, kNormal});
    for (std::size_t k = 0; k < std::min(mesh.texture_coords.size(), kMostCoords); ++k) {
        const Stream& stream = mesh.texture_coords[k];
        if (stream.components != 2 || stream.values.empty()) continue;
        sources.push_back({stream.values.data(), 2, kSlide * texture_scale(surface, shape, stream)});
    }
    for (std::size_t k = 0; k < std::min(mesh.colours.size(), kMostColours); ++k) {
        if (mesh.colours[k].values.empty()) continue;
        sources.push_back({mesh.colours[k].values.data(), mesh.colours[k].components, kColour});
    }
    Appearance appearance;
    for (const Source& source : sources) appearance.components += source.components;
    appearance.values.reserve(std::size_t{appearance.components} * mesh.positions.size());
    for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
        for (const Source& source : sources) {
            for (std::uint32_t k = 0; k < source.components; ++k)
                appearance.values.push_back(source.scale * source.values[vertex * source.components + k]);
        }
    }
    return appearance;
}

Samples make_samples(const Surface& surface, std::span<const std::vector<glm::vec3>> places,
                     const Appearance& appearance) {
    return Sampler(surface, places, appearance).run();
}

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

/// Splits at the median, so the depth is at most the logarithm of the number of triangles.
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
    Box<glm::vec3> box;
    for (std::uint32_t k = first; k < first + count; ++k) box.add(centre(order_[k]));
    const glm::vec3 size = box.high - box.low;
    return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

void Original::fit_boxes() {
    for (const std::vector<glm::vec3>& places : places_) {
        std::vector<Box<glm::vec3>>& boxes = boxes_.emplace_back(nodes_.size());
        for (std::size_t number = nodes_.size(); number-- > 0;) {
            const Node& node = nodes_[number];
            Box<glm::vec3>& box = boxes[number];
            if (node.count == 0) {
                for (const std::uint32_t child : {static_cast<std::uint32_t>(number) + 1, node.right}) {
                    box.add(boxes[child].low);
                    box.add(boxes[child].high);
                }
                continue;
            }
            for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
                for (const std::uint32_t vertex : triangles_[order_[k]]) box.add(places[vertex]);
            }
        }
    }
}

float Original::distance_squared(std::size_t shape, const glm::vec3& place, float enough, std::uint32_t& near) {
    if (nodes_.empty()) return 0.0f;
    const std::vector<glm::vec3>& places = places_[shape];
    const std::vector<Box<glm::vec3>>& boxes = boxes_[shape];
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
    for (const std::uint64_t most = work_ + kMostTested; size != 0 && best > enough && work_ < most;) {
        const Open next = open[--size];
        if (next.distance >= best) continue;
        const Node& node = nodes_[next.node];
        if (node.count == 0) {
            Open left{outside(boxes[next.node + 1], place), next.node + 1};
            Open right{outside(boxes[node.right], place), node.right};
            if (right.distance < left.distance) std::swap(left, right);
            if (right.distance < best) open[size++] = right;
            if (left.distance < best) open[size++] = left;
            continue;
        }
        work_ += node.count;
        for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
            const float distance = distance_to(order_[k]);
            if (!(distance < best)) continue;
            best = distance;
            near = order_[k];
        }
    }
    return best;
}

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
