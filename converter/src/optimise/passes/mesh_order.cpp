#include "optimise/passes/mesh_order.h"

#include "optimise/passes/mesh_streams.h"

#include "scene/failure.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace bendy::converter {
namespace {

/// Finds the joint with the largest total weight over a polygon's corners.
class HeaviestJoint {
public:
    explicit HeaviestJoint(const Mesh& mesh) : mesh_(mesh) {}

    std::uint32_t operator()(std::span<const std::uint32_t> corners) {
        if (mesh_.influences == 0) return mesh_.joint;
        shares_.clear();
        for (const std::uint32_t vertex : corners) {
            for (std::uint32_t k = 0; k < mesh_.influences; ++k) add(std::size_t{vertex} * mesh_.influences + k);
        }
        const auto heavier = [](const Share& a, const Share& b) {
            return a.weight != b.weight ? a.weight < b.weight : a.joint > b.joint;
        };
        const auto heaviest = std::max_element(shares_.begin(), shares_.end(), heavier);
        return heaviest == shares_.end() ? mesh_.joint : heaviest->joint;
    }

private:
    struct Share {
        std::uint32_t joint;
        double weight;
    };

    void add(std::size_t influence) {
        const float weight = mesh_.weights[influence];
        if (weight == 0.0f) return;
        const std::uint32_t joint = mesh_.palette.joints[mesh_.bones[influence]];
        const auto known =
            std::find_if(shares_.begin(), shares_.end(), [&](const Share& share) { return share.joint == joint; });
        if (known == shares_.end()) {
            shares_.push_back({joint, weight});
        } else {
            known->weight += weight;
        }
    }

    const Mesh& mesh_;
    std::vector<Share> shares_;
};

struct Key {
    std::uint32_t material;
    Topology topology;
    std::uint32_t joint;

    bool operator<(const Key& other) const {
        return std::tie(material, topology, joint) < std::tie(other.material, other.topology, other.joint);
    }
};

}  // namespace

// A counting sort: polygons are counted by key and then put in place, which takes four bytes per polygon.
AssignedPolygons assign_polygons(const Mesh& mesh) {
    HeaviestJoint heaviest(mesh);
    std::map<Key, std::uint32_t> numbers;  // numbers of the ranges, in order of occurrence
    std::vector<AssignedSubmesh> ranges;
    std::vector<std::uint32_t> range_of;  // per polygon, part after part
    for (const Submesh& submesh : mesh.submeshes) {
        const std::uint32_t step = corners(submesh.topology);
        auto last = numbers.end();
        for (std::size_t first = 0; first + step <= submesh.indices.size(); first += step) {
            const Key key{submesh.material, submesh.topology,
                          heaviest(std::span(submesh.indices).subspan(first, step))};
            if (last == numbers.end() || key < last->first || last->first < key) {
                last = numbers.try_emplace(key, static_cast<std::uint32_t>(ranges.size())).first;
                if (last->second == ranges.size()) ranges.push_back({key.joint, key.material, key.topology, 0, 0});
            }
            range_of.push_back(last->second);
            ranges[last->second].count += step;
        }
    }

    AssignedPolygons assigned;
    std::uint32_t at = 0;
    for (const auto& [key, number] : numbers) {
        AssignedSubmesh& range = ranges[number];
        range.first = at;
        at += range.count;
        assigned.ranges.push_back(range);
    }
    assigned.indices.resize(at);
    auto range = range_of.begin();
    for (const Submesh& submesh : mesh.submeshes) {
        const std::uint32_t step = corners(submesh.topology);
        for (std::size_t first = 0; first + step <= submesh.indices.size(); first += step) {
            std::uint32_t& to = ranges[*range++].first;
            for (std::uint32_t k = 0; k < step; ++k) assigned.indices[to++] = submesh.indices[first + k];
        }
    }
    return assigned;
}

namespace {

/// `stride` elements per vertex.
template <class T>
void permute(std::vector<T>& stream, std::size_t stride, std::span<const std::uint32_t> order) {
    if (stream.empty()) return;
    std::vector<T> sorted;
    sorted.reserve(stream.size());
    for (const std::uint32_t old : order) {
        for (std::size_t k = 0; k < stride; ++k) sorted.push_back(stream[old * stride + k]);
    }
    stream = std::move(sorted);
}

}  // namespace

std::vector<std::uint32_t> permute_vertices(Mesh& mesh, std::span<const std::uint32_t> order) {
    std::vector<std::uint32_t> number(mesh.positions.size(), kNone);
    for (std::uint32_t at = 0; at < order.size(); ++at) number[order[at]] = at;
    for_each_stream(mesh, [&](auto& values, std::size_t entries) { permute(values, entries, order); });
    for (Submesh& submesh : mesh.submeshes) {
        for (std::uint32_t& index : submesh.indices) {
            assert(number[index] != kNone);
            index = number[index];
        }
    }
    return number;
}

namespace {

bool has_area(const std::array<std::uint32_t, 3>& corners) {
    return corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0];
}

/// The corners mapped by `now`; triangles that lose their area are dropped.
std::vector<std::uint32_t> moved(const Submesh& submesh, std::span<const std::uint32_t> now) {
    std::vector<std::uint32_t> indices;
    indices.reserve(submesh.indices.size());
    if (submesh.topology != Topology::triangles) {
        for (const std::uint32_t index : submesh.indices) indices.push_back(now[index]);
        return indices;
    }
    for (std::size_t k = 0; k + 2 < submesh.indices.size(); k += 3) {
        const std::array before{submesh.indices[k], submesh.indices[k + 1], submesh.indices[k + 2]};
        const std::array after{now[before[0]], now[before[1]], now[before[2]]};
        if (has_area(after) || !has_area(before)) indices.insert(indices.end(), after.begin(), after.end());
    }
    return indices;
}

void keep_first(Mesh& mesh, std::uint32_t vertices) {
    std::vector<std::uint32_t> now(mesh.positions.size());
    std::iota(now.begin(), now.end(), 0u);
    for (std::size_t vertex = vertices; vertex < now.size(); ++vertex) now[vertex] = now[mesh.collapse[vertex]];
    for (Submesh& submesh : mesh.submeshes) submesh.indices = moved(submesh, now);
    now.resize(vertices);
    permute_vertices(mesh, now);
}

}  // namespace

void keep_level(Scene& scene, std::span<const std::uint32_t> vertices) {
    if (vertices.size() != scene.meshes.size()) fail({}, "the level of detail is one of another file");
    for (std::size_t m = 0; m < vertices.size(); ++m) {
        Mesh& mesh = scene.meshes[m];
        const std::size_t least = mesh.collapse.empty() ? mesh.positions.size() : mesh.base;
        if (vertices[m] < least || vertices[m] > mesh.positions.size())
            fail(at("meshes", m), "there is no level of detail with " + std::to_string(vertices[m]) + " vertices");
        if (vertices[m] < mesh.positions.size()) keep_first(mesh, vertices[m]);
        mesh.collapse.clear();
        mesh.joined.clear();
        mesh.base = 0;
    }
    scene.levels.clear();
}

}  // namespace bendy::converter
