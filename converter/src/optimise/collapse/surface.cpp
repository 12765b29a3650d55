#include "optimise/collapse/surface.h"

#include "scene/space.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <utility>

namespace bendy::converter {
namespace {

/// Positions count as equal if they differ by at most this share of the shape's extent.
constexpr float kSamePlace = 5e-6f;
/// At one rest position, at most this many different positions in other shapes are told apart.
constexpr std::size_t kMostPlaces = 8;

/// Numbers each distinct place; vertices at one place share a number, in vertex order.
std::vector<std::uint32_t> weld(const Mesh& mesh, std::span<const Shape> shapes) {
    std::vector<float> tolerances;
    for (const Shape& shape : shapes) {
        const Box<glm::vec3> box = box_of(shape);
        tolerances.push_back(kSamePlace * glm::length(box.high - box.low));
    }
    const auto lies_at = [&](std::uint32_t a, std::uint32_t b) {
        for (std::size_t s = 0; s < shapes.size(); ++s) {
            if (!(glm::distance(shapes[s][a], shapes[s][b]) <= tolerances[s])) return false;
        }
        return true;
    };
    const auto key = [&](std::uint32_t v) {
        const glm::vec3 p = mesh.positions[v] + 0.0f;  // -0 becomes 0
        return std::tuple(p.x, p.y, p.z);
    };
    std::vector<std::uint32_t> order(mesh.positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::vector<std::uint32_t> leader(order.size());
    std::vector<std::uint32_t> places;  // at the current rest position
    for (std::size_t i = 0; i < order.size(); ++i) {
        const std::uint32_t vertex = order[i];
        if (i == 0 || key(order[i - 1]) != key(vertex)) places.clear();
        const auto same =
            std::find_if(places.begin(), places.end(), [&](std::uint32_t other) { return lies_at(other, vertex); });
        leader[vertex] = same == places.end() ? vertex : *same;
        if (same == places.end() && places.size() < kMostPlaces) places.push_back(vertex);
    }
    std::vector<std::uint32_t> numbers(order.size());
    std::uint32_t count = 0;
    for (std::uint32_t vertex = 0; vertex < numbers.size(); ++vertex)
        numbers[vertex] = leader[vertex] == vertex ? count++ : numbers[leader[vertex]];
    return numbers;
}

void list_vertices(Surface& surface) {
    const std::uint32_t points =
        surface.point_of.empty() ? 0 : *std::max_element(surface.point_of.begin(), surface.point_of.end()) + 1;
    surface.first_vertex.assign(points + std::size_t{1}, 0);
    for (const std::uint32_t point : surface.point_of) ++surface.first_vertex[point + std::size_t{1}];
    std::partial_sum(surface.first_vertex.begin(), surface.first_vertex.end(), surface.first_vertex.begin());
    std::vector<std::uint32_t> at(surface.first_vertex.begin(), surface.first_vertex.end() - 1);
    surface.vertices.resize(surface.point_of.size());
    for (std::uint32_t vertex = 0; vertex < surface.point_of.size(); ++vertex)
        surface.vertices[at[surface.point_of[vertex]]++] = vertex;
    surface.is_locked.assign(points, false);
}

/// Streams whose differences make a seam.
class Streams {
public:
    explicit Streams(const Mesh& mesh) : mesh_(mesh) {
        if (mesh.influences != 0) list_.emplace_back(mesh.weights.data(), mesh.influences);
        for (const MorphTarget& target : mesh.targets) {
            for (const auto* stream : {&target.positions, &target.normals, &target.tangents}) {
                if (!stream->empty()) list_.emplace_back(&stream->front().x, 3);
            }
        }
        if (!mesh.normals.empty()) list_.emplace_back(&mesh.normals.front().x, 3);
        if (!mesh.tangents.empty()) list_.emplace_back(&mesh.tangents.front().x, 4);
        for (const auto* streams : {&mesh.texture_coords, &mesh.colours, &mesh.attributes}) {
            for (const Stream& stream : *streams) {
                if (!stream.values.empty()) list_.emplace_back(stream.values.data(), stream.components);
            }
        }
    }
    [[nodiscard]] bool are_same(std::uint32_t a, std::uint32_t b) const {
        const std::size_t bones = mesh_.influences;
        const auto first = mesh_.bones.begin();
        const auto at = [&](std::size_t vertex) { return first + static_cast<std::ptrdiff_t>(vertex * bones); };
        if (!std::equal(at(a), at(a + std::size_t{1}), at(b))) return false;
        return std::all_of(list_.begin(), list_.end(), [&](const auto& stream) {
            const float* values = stream.first;
            const std::size_t n = stream.second;
            return std::equal(values + a * n, values + (a + 1) * n, values + b * n);
        });
    }

private:
    const Mesh& mesh_;
    std::vector<std::pair<const float*, std::size_t>> list_;
};

/// Merges vertices of a point that are identical. If a point has more than kMostPlaces distinct ones, the rest are
/// skipped.
void find_alike(const Mesh& mesh, Surface& surface) {
    const Streams streams(mesh);
    surface.alike.resize(surface.point_of.size());
    std::vector<std::uint32_t> different;
    for (std::uint32_t point = 0; point < surface.points(); ++point) {
        different.clear();
        for (const std::uint32_t vertex : surface.vertices_of(point)) {
            const auto same = std::find_if(different.begin(), different.end(),
                                           [&](std::uint32_t other) { return streams.are_same(other, vertex); });
            surface.alike[vertex] = same == different.end() ? vertex : *same;
            if (same == different.end() && different.size() < kMostPlaces) different.push_back(vertex);
        }
    }
}

void add_submesh(Surface& surface, const Submesh& submesh) {
    for (const std::uint32_t vertex : submesh.indices) surface.is_used[surface.alike[vertex]] = true;
    if (submesh.topology != Topology::triangles) {
        for (const std::uint32_t vertex : submesh.indices) surface.is_locked[surface.point_of[vertex]] = true;
        return;
    }
    for (std::size_t at = 0; at + 3 <= submesh.indices.size(); at += 3) {
        Surface::Triangle triangle;
        triangle.material = submesh.material;
        for (std::size_t k = 0; k < 3; ++k) {
            triangle.vertices[k] = surface.alike[submesh.indices[at + k]];
            triangle.points[k] = surface.point_of[submesh.indices[at + k]];
        }
        const auto& p = triangle.points;
        if (p[0] != p[1] && p[1] != p[2] && p[2] != p[0]) surface.triangles.push_back(triangle);
    }
}

void link_corners(Surface& surface) {
    surface.first_corner.assign(surface.points(), kNone);
    surface.next_corner.assign(surface.triangles.size() * 3, kNone);
    for (auto corner = static_cast<std::uint32_t>(surface.next_corner.size()); corner-- > 0;) {
        std::uint32_t& first = surface.first_corner[surface.triangles[corner / 3].points[corner % 3]];
        surface.next_corner[corner] = std::exchange(first, corner);
    }
    for (std::uint32_t point = 0; point < surface.points(); ++point) {
        if (surface.first_corner[point] == kNone) surface.is_locked[point] = true;
    }
}

}  // namespace

void Surface::find_corners(std::uint32_t point, std::vector<std::uint32_t>& corners) {
    corners.clear();
    std::uint32_t* link = &first_corner[point];
    while (*link != kNone) {
        const std::uint32_t corner = *link;
        if (triangles[corner / 3].is_alive) {
            corners.push_back(corner);
            link = &next_corner[corner];
        } else {
            *link = next_corner[corner];
        }
    }
}

Surface make_surface(const Mesh& mesh, std::span<const Shape> shapes) {
    Surface surface;
    surface.point_of = weld(mesh, shapes);
    surface.is_used.assign(mesh.positions.size(), false);
    list_vertices(surface);
    find_alike(mesh, surface);
    for (const Submesh& submesh : mesh.submeshes) add_submesh(surface, submesh);
    link_corners(surface);
    return surface;
}

std::vector<bool> find_borders(const Surface& surface) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    edges.reserve(surface.triangles.size() * 3);
    for (const Surface::Triangle& triangle : surface.triangles) {
        for (std::size_t k = 0; k < 3; ++k)
            edges.emplace_back(std::minmax(triangle.points[k], triangle.points[(k + 1) % 3]));
    }
    std::sort(edges.begin(), edges.end());
    std::vector<bool> is_border(surface.points());
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const bool is_single =
            (i == 0 || edges[i - 1] != edges[i]) && (i + 1 == edges.size() || edges[i + 1] != edges[i]);
        if (!is_single) continue;
        is_border[edges[i].first] = true;
        is_border[edges[i].second] = true;
    }
    return is_border;
}

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
