#include "optimise/passes/level_order.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>

namespace bendy::converter {

std::vector<std::uint32_t> levels_of(const Scene& scene, std::uint32_t number) {
    const Mesh& mesh = scene.meshes[number];
    std::vector<std::uint32_t> alive{mesh.base, static_cast<std::uint32_t>(mesh.positions.size())};
    for (const LodLevel& level : scene.levels) alive.push_back(level.alive[number]);
    std::erase_if(alive, [&](std::uint32_t n) { return n < mesh.joined.size() && mesh.joined[n] != 0; });
    std::sort(alive.begin(), alive.end());
    alive.erase(std::unique(alive.begin(), alive.end()), alive.end());
    return alive;
}

namespace {

/// Two groups of vertices that collapse together, by their first vertices.
struct Precedence {
    std::uint32_t before = 0;  ///< stored first, so collapsed last
    std::uint32_t after = 0;
};

/// Finds which groups of vertices must keep their order: it collapses a mesh as its sequence says. A sequence that
/// takes too long is hostile: a simplifier's takes a few steps a vertex.
class Collapses {
public:
    explicit Collapses(const Mesh& mesh) : mesh_(mesh), first_of_(mesh.positions.size()) {
        for (std::uint32_t vertex = 0; vertex < first_of_.size(); ++vertex)
            first_of_[vertex] = mesh.joined[vertex] != 0 ? first_of_[vertex - 1] : vertex;
        fans_.resize(mesh.positions.size());
        for (const Submesh& submesh : mesh.submeshes) {
            if (submesh.topology == Topology::triangles) add_triangles(submesh.indices);
        }
        last_.assign(triangles_.size(), kNone);
        steps_left_ = kMostSteps * (first_of_.size() + triangles_.size());
        run();
    }

    /// False if it took too long.
    [[nodiscard]] bool are_known() const { return steps_left_ > 0; }

    /// By vertex: the first of those that it collapses with.
    [[nodiscard]] const std::vector<std::uint32_t>& first_of() const { return first_of_; }
    /// In no order; pairs may be repeated.
    [[nodiscard]] const std::vector<Precedence>& precedences() const { return precedences_; }

private:
    static constexpr std::size_t kMostSteps = 32;  // per vertex and triangle

    using Triangle = std::array<std::uint32_t, 3>;

    static bool has_area(const Triangle& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; }

    void add_triangles(std::span<const std::uint32_t> indices) {
        for (std::size_t k = 0; k + 2 < indices.size(); k += 3) {
            const Triangle triangle{indices[k], indices[k + 1], indices[k + 2]};
            if (!has_area(triangle)) continue;
            for (const std::uint32_t corner : triangle)
                fans_[corner].push_back(static_cast<std::uint32_t>(triangles_.size()));
            triangles_.push_back(triangle);
        }
    }

    void run() {
        for (auto end = static_cast<std::uint32_t>(first_of_.size()); end > mesh_.base && are_known();) {
            const std::uint32_t first = first_of_[end - 1];
            for (std::uint32_t vertex = first; vertex < end; ++vertex) touch_fan(vertex, first);
            while (end > first) collapse(--end, first);
        }
    }

    /// The triangles around a vertex are what its collapse changes and is measured with.
    void touch_fan(std::uint32_t vertex, std::uint32_t first) {
        steps_left_ -= std::min(steps_left_, fans_[vertex].size());
        for (const std::uint32_t triangle : fans_[vertex]) {
            if (!has_area(triangles_[triangle])) continue;
            std::uint32_t& last = last_[triangle];
            if (last != kNone && last != first) precedences_.push_back({first, last});
            last = first;
        }
    }

    void collapse(std::uint32_t vertex, std::uint32_t first) {
        const std::uint32_t target = mesh_.collapse[vertex];
        if (first_of_[target] != first) precedences_.push_back({first_of_[target], first});
        for (const std::uint32_t triangle : fans_[vertex]) {
            if (!has_area(triangles_[triangle])) continue;
            std::replace(triangles_[triangle].begin(), triangles_[triangle].end(), vertex, target);
            if (has_area(triangles_[triangle])) fans_[target].push_back(triangle);
        }
        fans_[vertex] = {};
    }

    const Mesh& mesh_;
    std::vector<std::uint32_t> first_of_;
    std::vector<Triangle> triangles_;
    std::vector<std::vector<std::uint32_t>> fans_;  // by vertex: triangles, with some that have lost their area
    std::vector<std::uint32_t> last_;               // by triangle: the last group whose collapse it was part of
    std::vector<Precedence> precedences_;
    std::size_t steps_left_ = 0;
};

/// Orders the groups of one level after another.
class PlacesInLevels {
public:
    PlacesInLevels(const Collapses& collapses, std::span<const std::uint32_t> rank)
        : first_of_(collapses.first_of()), place_of_(rank.size()), groups_(rank.size()) {
        for (std::uint32_t vertex = 0; vertex < rank.size(); ++vertex) {
            Group& group = groups_[first_of_[vertex]];
            group.rank = std::min(group.rank, rank[vertex]);
        }
        for (const auto& [before, after] : collapses.precedences()) {
            ++groups_[after].waits_for;
            groups_[before].waiting.push_back(after);
        }
    }

    std::vector<std::uint32_t> find(std::span<const std::uint32_t> levels) {
        std::uint32_t begin = 0;
        for (const std::uint32_t end : levels) {
            order_level(begin, end);
            begin = end;
        }
        return std::move(place_of_);
    }

private:
    // A collapse may come much earlier than in the sequence, so a count between two levels is only as good as the next
    // level. Where levels have few vertices, the next one may be much worse, and there is little to gain.
    static constexpr std::uint32_t kFewest = 64;

    struct Group {
        std::uint32_t rank = kNone;
        std::uint32_t waits_for = 0;
        std::vector<std::uint32_t> waiting;
    };

    // Whatever a group waits for is in this level or an earlier one.
    void order_level(std::uint32_t begin, std::uint32_t end) {
        using Ready = std::pair<std::uint32_t, std::uint32_t>;  // rank, and the first vertex
        if (begin != 0 && end - begin < kFewest) {
            for (std::uint32_t vertex = begin; vertex < end; ++vertex) groups_[vertex].rank = vertex;
        }
        std::priority_queue<Ready, std::vector<Ready>, std::greater<>> ready;
        for (std::uint32_t vertex = begin; vertex < end; ++vertex) {
            if (first_of_[vertex] == vertex && groups_[vertex].waits_for == 0)
                ready.emplace(groups_[vertex].rank, vertex);
        }
        std::uint32_t next = begin;
        while (!ready.empty()) {
            const std::uint32_t first = ready.top().second;
            ready.pop();
            for (std::uint32_t vertex = first; vertex < end && first_of_[vertex] == first; ++vertex)
                place_of_[vertex] = next++;
            for (const std::uint32_t other : groups_[first].waiting) {
                if (--groups_[other].waits_for == 0 && other < end) ready.emplace(groups_[other].rank, other);
            }
        }
    }

    const std::vector<std::uint32_t>& first_of_;
    std::vector<std::uint32_t> place_of_;
    std::vector<Group> groups_;  // by first vertex
};

}  // namespace

std::vector<std::uint32_t> places_in_levels(const Mesh& mesh, std::span<const std::uint32_t> rank,
                                            std::span<const std::uint32_t> levels) {
    const Collapses collapses(mesh);
    if (!collapses.are_known()) {
        std::vector<std::uint32_t> unchanged(rank.size());
        std::iota(unchanged.begin(), unchanged.end(), 0u);
        return unchanged;
    }
    return PlacesInLevels(collapses, rank).find(levels);
}

void move_collapse(Mesh& mesh, std::span<const std::uint32_t> place_of) {
    std::vector<std::uint32_t> collapse(place_of.size());
    std::vector<std::uint8_t> joined(place_of.size());
    for (std::size_t vertex = 0; vertex < place_of.size(); ++vertex) {
        collapse[place_of[vertex]] = place_of[mesh.collapse[vertex]];
        joined[place_of[vertex]] = mesh.joined[vertex];
    }
    mesh.collapse = std::move(collapse);
    mesh.joined = std::move(joined);
}

}  // namespace bendy::converter
