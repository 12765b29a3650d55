#include "passes/assign_polygons.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <span>
#include <tuple>

namespace bendy::converter {
namespace {

/// Finds the joint with the largest sum of weights over a polygon's corners.
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

// Polygons are counted by what they have in common and then put in their places: nothing is sorted, and a polygon takes
// four bytes meanwhile.
AssignedPolygons assign_polygons(const Mesh& mesh) {
    HeaviestJoint heaviest(mesh);
    std::map<Key, std::uint32_t> numbers;  // of the ranges, as they are met
    std::vector<PolygonRange> ranges;
    std::vector<std::uint32_t> range_of;  // each polygon, part after part
    for (const Part& part : mesh.parts) {
        const std::uint32_t step = corners(part.topology);
        auto last = numbers.end();
        for (std::size_t first = 0; first + step <= part.indices.size(); first += step) {
            const Key key{part.material, part.topology, heaviest(std::span(part.indices).subspan(first, step))};
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
        PolygonRange& range = ranges[number];
        range.first = at;
        at += range.count;
        assigned.ranges.push_back(range);
    }
    assigned.indices.resize(at);
    auto range = range_of.begin();
    for (const Part& part : mesh.parts) {
        const std::uint32_t step = corners(part.topology);
        for (std::size_t first = 0; first + step <= part.indices.size(); first += step) {
            std::uint32_t& to = ranges[*range++].first;
            for (std::uint32_t k = 0; k < step; ++k) assigned.indices[to++] = part.indices[first + k];
        }
    }
    return assigned;
}

}  // namespace bendy::converter
