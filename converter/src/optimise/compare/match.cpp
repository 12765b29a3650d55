#include "optimise/compare/match.h"

#include "scene/space.h"

#include <bendy/format/trig.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>

namespace bendy::converter {
namespace {

/// Parent and name.
using Key = std::pair<std::uint32_t, std::string_view>;

/// The numbers with one key, in order, and how many of them are taken.
struct Waiting {
    std::vector<std::uint32_t> numbers;
    std::size_t taken = 0;
};

std::uint32_t take(std::map<Key, Waiting>& waiting, const Key& key) {
    const auto found = waiting.find(key);
    if (found == waiting.end() || found->second.taken == found->second.numbers.size()) return kNone;
    return found->second.numbers[found->second.taken++];
}

}  // namespace

MatchedNames match_names(std::span<const std::string> a, std::span<const std::string> b) {
    MatchedNames matched{std::vector<std::uint32_t>(a.size(), kNone), std::vector<std::uint32_t>(b.size(), kNone)};
    std::map<Key, Waiting> waiting;
    for (std::uint32_t number = 0; number < b.size(); ++number) waiting[{kNone, b[number]}].numbers.push_back(number);
    for (std::uint32_t number = 0; number < a.size(); ++number) {
        const std::uint32_t other = take(waiting, {kNone, a[number]});
        matched.b_of[number] = other;
        if (other != kNone) matched.a_of[other] = number;
    }
    return matched;
}

void match_the_rest(MatchedNames& names) {
    std::size_t other = 0;
    for (std::uint32_t number = 0; number < names.b_of.size(); ++number) {
        if (names.b_of[number] != kNone) continue;
        while (other < names.a_of.size() && names.a_of[other] != kNone) ++other;
        if (other == names.a_of.size()) return;
        names.b_of[number] = static_cast<std::uint32_t>(other);
        names.a_of[other] = number;
    }
}

MatchedNames match_joints(std::span<const Joint> a, std::span<const Joint> b) {
    MatchedNames matched{std::vector<std::uint32_t>(a.size(), kNone), std::vector<std::uint32_t>(b.size(), kNone)};
    std::map<Key, Waiting> waiting;
    for (std::uint32_t number = 0; number < b.size(); ++number)
        waiting[{b[number].parent, b[number].name}].numbers.push_back(number);
    for (std::uint32_t number = 0; number < a.size(); ++number) {
        const std::uint32_t parent = a[number].parent == kNone ? kNone : matched.b_of[a[number].parent];
        if (parent == kNone && a[number].parent != kNone) continue;
        const std::uint32_t other = take(waiting, {parent, a[number].name});
        matched.b_of[number] = other;
        if (other != kNone) matched.a_of[other] = number;
    }
    return matched;
}

namespace {

constexpr double kDirection = 2.0;  // degrees
constexpr double kCoords = 1.0 / 1024.0;
constexpr double kColours = 1.0 / 128.0;

/// The largest minus the smallest number; 1 if there are none.
double range_of(std::span<const float> numbers) {
    if (numbers.empty()) return 1.0;
    const auto [low, high] = std::minmax_element(numbers.begin(), numbers.end());
    const double range = double{*high} - *low;
    return range > 0.0 ? range : 1.0;
}

double degrees_between(const float* a, const float* b) {
    double dot = 0.0;
    double a_square = 0.0;
    double b_square = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
        dot += double{a[c]} * b[c];
        a_square += double{a[c]} * a[c];
        b_square += double{b[c]} * b[c];
    }
    const double lengths = std::sqrt(a_square * b_square);
    if (!(lengths > 0.0)) return 0.0;  // one has no direction: cannot be compared
    return trig::acos(std::clamp(dot / lengths, -1.0, 1.0)) * 180.0 / trig::kPi;
}

}  // namespace

Looks::Looks(const Mesh& a, const Mesh& b) {
    const auto pair_vectors = [&](const std::string& name, Kind kind, const auto& here, const auto& there) {
        constexpr auto stride = static_cast<std::uint32_t>(sizeof(here[0]) / sizeof(float));
        if (!here.empty() && !there.empty())
            streams_.push_back({name, kind, stride, &here[0].x, &there[0].x, stride, stride, kDirection});
        if (!here.empty() && there.empty()) only_in_a_.push_back(name);
        if (here.empty() && !there.empty()) only_in_b_.push_back(name);
    };
    pair_vectors("normals", Kind::direction, a.normals, b.normals);
    pair_vectors("tangents", Kind::tangent, a.tangents, b.tangents);
    pair_streams("texture coordinates ", a.texture_coords, b.texture_coords, kCoords);
    pair_streams("colours ", a.colours, b.colours, kColours);
    pair_streams("attribute ", a.attributes, b.attributes, kCoords);
}

void Looks::pair_streams(const std::string& kind, const std::vector<Stream>& a, const std::vector<Stream>& b,
                         double allowed) {
    const auto name_of = [&](const Stream& stream) {
        return kind + (stream.name.empty() ? std::to_string(stream.set) : stream.name);
    };
    const auto find = [](const std::vector<Stream>& list, const Stream& wanted) {
        return std::find_if(list.begin(), list.end(), [&](const Stream& stream) {
            return stream.name == wanted.name && stream.set == wanted.set && !stream.values.empty();
        });
    };
    for (const Stream& stream : a) {
        if (stream.values.empty()) continue;
        const auto other = find(b, stream);
        if (other == b.end()) {
            only_in_a_.push_back(name_of(stream));
            continue;
        }
        const bool is_colour = allowed == kColours;
        const double most = is_colour ? allowed : allowed * range_of(stream.values);
        streams_.push_back({name_of(stream), Kind::numbers, std::min(stream.components, other->components),
                            stream.values.data(), other->values.data(), stream.components, other->components, most});
    }
    for (const Stream& stream : b) {
        if (!stream.values.empty() && find(a, stream) == a.end()) only_in_b_.push_back(name_of(stream));
    }
}

double Looks::apart(const Paired& stream, std::uint32_t a, std::uint32_t b) {
    const float* here = stream.a + std::size_t{a} * stream.a_stride;
    const float* there = stream.b + std::size_t{b} * stream.b_stride;
    if (stream.kind != Kind::numbers) {
        const bool turns = stream.kind == Kind::tangent && (here[3] < 0.0f) != (there[3] < 0.0f);
        return turns ? 180.0 : degrees_between(here, there);
    }
    double largest = 0.0;
    for (std::uint32_t c = 0; c < stream.components; ++c)
        largest = std::max(largest, std::abs(double{here[c]} - there[c]));
    return largest;
}

double Looks::unlikeness(std::uint32_t a, std::uint32_t b) const {
    double sum = 0.0;
    for (const Paired& stream : streams_) sum += apart(stream, a, b) / stream.allowed;
    return sum;
}

namespace {

constexpr std::uint64_t kMostTests = 300'000'000;  // pairs of polygons
constexpr std::size_t kMostChoices = 12;           // per polygon, in one pass
constexpr std::size_t kMostVisited = 4'000;        // polygons that may change partners to free one
constexpr double kFirstRadius = 1e-5;              // share of the extent
constexpr double kLastRadius = 0.1;
constexpr double kGrowth = 4.0;

/// The polygons of all submeshes, without degenerate ones, in which two corners are one vertex.
std::vector<Polygon> list_polygons(const Mesh& mesh, std::span<const std::uint32_t> material_of) {
    std::vector<Polygon> polygons;
    for (const Submesh& submesh : mesh.submeshes) {
        Polygon polygon;
        polygon.corners = submesh.topology == Topology::triangles ? 3 : submesh.topology == Topology::lines ? 2 : 1;
        polygon.material = submesh.material;
        if (submesh.material < material_of.size()) polygon.material = material_of[submesh.material];
        for (std::size_t at = 0; at + polygon.corners <= submesh.indices.size(); at += polygon.corners) {
            std::copy_n(submesh.indices.begin() + static_cast<std::ptrdiff_t>(at), polygon.corners,
                        polygon.vertices.begin());
            const auto& v = polygon.vertices;
            const bool is_flat =
                (polygon.corners > 1 && v[0] == v[1]) || (polygon.corners > 2 && (v[1] == v[2] || v[2] == v[0]));
            if (!is_flat) polygons.push_back(polygon);
        }
    }
    return polygons;
}

/// B's polygons in a grid by the rest position of their corners: one entry per rotation of the corner order.
class Grid {
public:
    struct Entry {
        std::uint64_t cell;
        std::uint32_t polygon;
        std::uint32_t turn;
        friend bool operator<(const Entry& x, const Entry& y) {
            return std::tie(x.cell, x.polygon, x.turn) < std::tie(y.cell, y.polygon, y.turn);
        }
    };

    explicit Grid(double radius) : size_(2.0 * radius) {}

    void add(std::uint32_t polygon, std::uint32_t turn, const glm::vec3& place) {
        entries_.push_back({cell_of(steps_of(place, 0.0)), polygon, turn});
    }
    void finish() { std::sort(entries_.begin(), entries_.end()); }

    /// Calls visit(entry) for all that may lie within the radius of a place, until it returns false.
    template <class Visit>
    void near(const glm::vec3& place, Visit visit) const {
        const Steps low = steps_of(place, -0.5 * size_);
        const Steps high = steps_of(place, 0.5 * size_);
        std::array<std::uint64_t, 8> cells{};
        std::size_t count = 0;
        for (unsigned corner = 0; corner < 8; ++corner) {
            Steps steps = low;
            for (unsigned axis = 0; axis < 3; ++axis) {
                if ((corner >> axis & 1u) != 0) steps[axis] = high[axis];
            }
            cells[count++] = cell_of(steps);
        }
        std::sort(cells.begin(), cells.end());
        const auto end = std::unique(cells.begin(), cells.end());
        for (auto cell = cells.begin(); cell != end; ++cell) {
            auto entry = std::lower_bound(entries_.begin(), entries_.end(), Entry{*cell, 0, 0});
            for (; entry != entries_.end() && entry->cell == *cell; ++entry) {
                if (!visit(*entry)) return;
            }
        }
    }

private:
    using Steps = std::array<std::int64_t, 3>;

    [[nodiscard]] Steps steps_of(const glm::vec3& place, double by) const {
        constexpr double kMost = 4e18;
        Steps steps{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double step = std::floor((double{place[static_cast<int>(axis)]} + by) / size_);
            steps[axis] = static_cast<std::int64_t>(std::clamp(step, -kMost, kMost));
        }
        return steps;
    }
    static std::uint64_t cell_of(const Steps& steps) {
        std::uint64_t cell = 0;
        for (const std::int64_t step : steps) {
            cell = (cell ^ static_cast<std::uint64_t>(step)) * 0x9e3779b97f4a7c15u;  // a hash: two cells may collide
            cell ^= cell >> 29U;
        }
        return cell;
    }

    double size_;
    std::vector<Entry> entries_;
};

double extent_of(const Shape& shape) {
    const auto [low, high] = box_of(shape);
    return glm::distance(glm::dvec3(low), glm::dvec3(high));
}

class Matcher {
public:
    Matcher(const Mesh& a, const Mesh& b, std::span<const Shape> shapes_a, std::span<const Shape> shapes_b,
            std::span<const std::uint32_t> material_of, const Looks& looks, double tolerance)
        : a_(list_polygons(a, {})),
          b_(list_polygons(b, material_of)),
          shapes_a_(shapes_a.first(std::min(shapes_a.size(), shapes_b.size()))),
          shapes_b_(shapes_b.first(shapes_a_.size())),
          compared_(shapes_a_.size()),
          looks_(looks),
          tolerance_(tolerance),
          partner_(a_.size()),
          owner_(b_.size(), kNone) {}

    MatchedPolygons run() {
        if (!a_.empty() && !b_.empty()) match();
        MatchedPolygons result;
        result.gave_up = tests_ > kMostTests;
        for (std::uint32_t number = 0; number < a_.size(); ++number) {
            const Choice& partner = partner_[number];
            if (partner.polygon == kNone) {
                if (!is_small(a_[number], shapes_a_)) result.only_in_a.push_back(a_[number]);
                continue;
            }
            const Polygon& here = a_[number];
            const Polygon& there = b_[partner.polygon];
            for (std::uint32_t k = 0; k < here.corners; ++k)
                result.corners.push_back({here.vertices[k], there.vertices[(k + partner.turn) % here.corners]});
        }
        for (std::uint32_t number = 0; number < b_.size(); ++number) {
            if (owner_[number] == kNone && !is_small(b_[number], shapes_b_)) result.only_in_b.push_back(b_[number]);
        }
        std::sort(result.corners.begin(), result.corners.end());
        result.corners.erase(std::unique(result.corners.begin(), result.corners.end()), result.corners.end());
        return result;
    }

private:
    struct Choice {
        double cost = 0.0;
        std::uint32_t polygon = kNone;  // polygon of B
        std::uint32_t turn = 0;         // the index of the corner that pairs with the first one
        friend bool operator<(const Choice& x, const Choice& y) {
            return std::tie(x.cost, x.polygon, x.turn) < std::tie(y.cost, y.polygon, y.turn);
        }
    };

    void match() {
        const double extent = std::max(extent_of(shapes_a_[0]), extent_of(shapes_b_[0]));
        if (!(extent > 0.0) && !(tolerance_ > 0.0)) return;
        double radius = std::max(kFirstRadius * extent, 1e-3 * tolerance_);
        while (radius < tolerance_) {
            pair_within(radius);
            radius *= kGrowth;
        }
        pair_within(tolerance_);
        change_partners();
        compared_ = 1;  // polygons that move differently still match if they rest at the same place
        pair_within(tolerance_);
        compared_ = shapes_a_.size();
        radius = kGrowth * tolerance_;
        while (radius < kLastRadius * extent) {
            pair_within(radius);
            radius *= kGrowth;
        }
    }

    [[nodiscard]] Grid make_grid(double radius, bool all) const {
        Grid grid(radius);
        for (std::uint32_t number = 0; number < b_.size(); ++number) {
            if (!all && owner_[number] != kNone) continue;
            for (std::uint32_t turn = 0; turn < b_[number].corners; ++turn)
                grid.add(number, turn, shapes_b_[0][b_[number].vertices[turn]]);
        }
        grid.finish();
        return grid;
    }

    /// The largest squared distance of two corners in any shape; if above the square of `limit`, any such value.
    [[nodiscard]] double square_apart(const Polygon& a, const Polygon& b, std::uint32_t turn, double limit) const {
        double largest = 0.0;
        for (std::size_t shape = 0; shape < compared_; ++shape) {
            for (std::uint32_t k = 0; k < a.corners; ++k) {
                const glm::dvec3 apart = glm::dvec3(shapes_a_[shape][a.vertices[k]]) -
                                         glm::dvec3(shapes_b_[shape][b.vertices[(k + turn) % a.corners]]);
                largest = std::max(largest, glm::dot(apart, apart));
                if (largest > limit * limit) return largest;
            }
        }
        return largest;
    }

    /// Finds the candidates in B for one of A's polygons, best first.
    void find_choices(const Grid& grid, const Polygon& polygon, double radius, std::vector<Choice>& choices) {
        choices.clear();
        grid.near(shapes_a_[0][polygon.vertices[0]], [&](const Grid::Entry& entry) {
            const Polygon& other = b_[entry.polygon];
            if (++tests_ > kMostTests) return false;
            if (other.material != polygon.material || other.corners != polygon.corners) return true;
            const double square = square_apart(polygon, other, entry.turn, radius);
            if (!(square <= radius * radius)) return true;
            double cost = std::sqrt(square) / radius;
            for (std::uint32_t k = 0; k < polygon.corners; ++k)
                cost += looks_.unlikeness(polygon.vertices[k], other.vertices[(k + entry.turn) % polygon.corners]);
            choices.push_back({cost, entry.polygon, entry.turn});
            return true;
        });
        std::sort(choices.begin(), choices.end());
    }

    void pair_within(double radius) {
        struct Edge {
            Choice choice;
            std::uint32_t a;
            bool operator<(const Edge& other) const {
                return choice < other.choice || (!(other.choice < choice) && a < other.a);
            }
        };
        const Grid grid = make_grid(radius, false);
        std::vector<Edge> edges;
        std::vector<Choice> choices;
        for (std::uint32_t number = 0; number < a_.size(); ++number) {
            if (partner_[number].polygon != kNone) continue;
            find_choices(grid, a_[number], radius, choices);
            for (std::size_t k = 0; k < std::min(choices.size(), kMostChoices); ++k)
                edges.push_back({choices[k], number});
        }
        std::sort(edges.begin(), edges.end());
        for (const Edge& edge : edges) {
            if (partner_[edge.a].polygon == kNone && owner_[edge.choice.polygon] == kNone) join(edge.a, edge.choice);
        }
    }

    void join(std::uint32_t a, const Choice& choice) {
        partner_[a] = choice;
        owner_[choice.polygon] = a;
    }

    /// Finds partners for unmatched polygons within the tolerance by reassigning others: augmenting paths.
    void change_partners() {
        std::vector<std::uint32_t> lone;
        for (std::uint32_t number = 0; number < a_.size(); ++number) {
            if (partner_[number].polygon == kNone) lone.push_back(number);
        }
        if (lone.empty()) return;
        const Grid grid = make_grid(tolerance_, true);
        for (const std::uint32_t number : lone) find_path(grid, number);
    }

    void find_path(const Grid& grid, std::uint32_t first) {
        struct Step {
            std::uint32_t from;  // polygon of A
            Choice choice;
        };
        std::map<std::uint32_t, Step> way;  // keyed by B's polygons
        std::vector<std::uint32_t> open{first};
        std::vector<Choice> choices;
        for (std::size_t at = 0; at < open.size() && at < kMostVisited; ++at) {
            find_choices(grid, a_[open[at]], tolerance_, choices);
            for (const Choice& choice : choices) {
                if (!way.try_emplace(choice.polygon, Step{open[at], choice}).second) continue;
                if (owner_[choice.polygon] != kNone) {
                    open.push_back(owner_[choice.polygon]);
                    continue;
                }
                for (std::uint32_t polygon = choice.polygon; polygon != kNone;) {
                    const Step& step = way.at(polygon);
                    polygon = std::exchange(partner_[step.from].polygon, kNone);
                    join(step.from, step.choice);
                }
                return;
            }
        }
    }

    /// Whether two corners coincide within the tolerance: such a polygon may have been dropped.
    [[nodiscard]] bool is_small(const Polygon& polygon, std::span<const Shape> shapes) const {
        for (std::uint32_t k = 0; k + 1 < polygon.corners || (k < 3 && polygon.corners == 3); ++k) {
            const std::uint32_t from = polygon.vertices[k];
            const std::uint32_t to = polygon.vertices[(k + 1) % polygon.corners];
            const bool is_near = std::all_of(shapes.begin(), shapes.end(), [&](const Shape& shape) {
                return glm::distance(glm::dvec3(shape[from]), glm::dvec3(shape[to])) <= 2.0 * tolerance_;
            });
            if (is_near) return true;
        }
        return false;
    }

    std::vector<Polygon> a_, b_;
    std::span<const Shape> shapes_a_, shapes_b_;
    std::size_t compared_;  // number of shapes that count now
    const Looks& looks_;
    double tolerance_;
    std::vector<Choice> partner_;       // per polygon of A
    std::vector<std::uint32_t> owner_;  // per polygon of B
    std::uint64_t tests_ = 0;
};

}  // namespace

MatchedPolygons match_polygons(const Mesh& a, const Mesh& b, std::span<const Shape> shapes_a,
                               std::span<const Shape> shapes_b, std::span<const std::uint32_t> material_of,
                               const Looks& looks, double tolerance) {
    return Matcher(a, b, shapes_a, shapes_b, material_of, looks, tolerance).run();
}

}  // namespace bendy::converter
