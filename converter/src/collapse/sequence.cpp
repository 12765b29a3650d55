#include "collapse/sequence.h"

#include "collapse/closest_point.h"
#include "collapse/four_distances.h"
#include "collapse/original.h"
#include "collapse/quadric.h"
#include "collapse/samples.h"
#include "collapse/shaped_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

namespace bendy::converter {
namespace {

constexpr float kImpossible = std::numeric_limits<float>::infinity();
/// Corners at a point that moves, or is moved to: keeps the work at each step bounded.
constexpr std::uint32_t kMostCorners = 100;
/// Of the edges at a point, so many are measured: those that the quadrics like best.
constexpr std::size_t kMeasured = 3;
/// On a mesh with fewer points, all; and when so few are left, how far the new surface is from the old.
constexpr std::uint32_t kSmall = 20'000;
/// Above so many samples round a point every other one is dropped, but for the worst: keeps the work near linear.
constexpr std::size_t kMostHeld = 160;
/// A triangle may turn so far at rest: the cosine.
constexpr float kLeastCosine = 0.2f;
/// Squared distances in other shapes than the rest pose count for so much: the skin is mostly seen near it.
constexpr float kPosedFactor = 0.2f;
/// What looks wrong where a vertex leaves its side of a seam counts for so much more.
constexpr double kSeamFactor = 8.0;
constexpr float kBorderFactor = 2.0f;    // of the squared distance from a border
constexpr float kQuadricFactor = 0.25f;  // of the mean squared distance from the planes, beside the largest distance
constexpr std::size_t kCornerFloats = 9 * kFour;  // of four triangles
constexpr float kLengthFactor = 1e-7f;            // of the squared length of the edge: decides on flat ground

/// The shapes at a common scale, each round the origin.
struct Scaled {
    std::vector<std::vector<glm::vec3>> places;  // of the vertices, by shape
    float extent = 1.0f;                         // metres
};

Scaled scale(std::span<const Shape> shapes) {
    Scaled scaled;
    for (const Shape& shape : shapes) {
        glm::vec3 low(0.0f);
        glm::vec3 high(0.0f);
        if (!shape.empty()) low = high = shape.front();
        for (const glm::vec3& p : shape) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        const float extent = glm::length(high - low);
        if (scaled.places.empty() && extent > 0.0f && std::isfinite(extent)) scaled.extent = extent;
        std::vector<glm::vec3>& places = scaled.places.emplace_back();
        places.reserve(shape.size());
        for (const glm::vec3& p : shape) places.push_back((p - 0.5f * (low + high)) / scaled.extent);
    }
    return scaled;
}

ShapedPlaces place_points(const Surface& surface, const Scaled& scaled) {
    ShapedPlaces places(scaled.places.size());
    places.reserve(surface.points());
    for (std::uint32_t point = 0; point < surface.points(); ++point)
        places.add([&](std::size_t shape) { return scaled.places[shape][surface.vertex_of(point)]; });
    return places;
}

/// Greedy half-edge collapses by the largest distance between the surface and the original one, in any shape.
class Simplifier {
public:
    Simplifier(const Mesh& mesh, std::span<const Shape> shapes, Surface surface)
        : surface_(std::move(surface)),
          scaled_(scale(shapes)),
          places_(place_points(surface_, scaled_)),
          appearance_(make_appearance(mesh, surface_, scaled_.places.front())),
          samples_(make_samples(surface_, scaled_.places, appearance_)),
          original_(surface_, scaled_.places),
          alive_(surface_.points()),
          corner_count_(surface_.points(), 0),
          changed_(surface_.points(), 0),
          measured_(surface_.points(), 0),
          target_(surface_.points(), kNone),
          is_queued_(surface_.points(), false),
          is_gone_(surface_.points(), false),
          marks_(surface_.points(), 0) {
        for (const Surface::Triangle& triangle : surface_.triangles) {
            for (const std::uint32_t point : triangle.points) ++corner_count_[point];
        }
        add_quadrics();
    }

    Sequence run() {
        remove_unused();
        for (std::uint32_t point = 0; point < surface_.points(); ++point) reconsider(point);
        while (!queue_.empty()) {
            const Entry entry = queue_.top();
            queue_.pop();
            const std::uint32_t point = entry.point;
            is_queued_[point] = false;
            const bool is_stale = changed_[point] > measured_[point] || is_gone_[target_[point]] ||
                                  changed_[target_[point]] > measured_[point];
            if (is_stale) {
                if (!measure_best(point)) continue;
                if (!queue_.empty() && queue_.top().cost < costs_.total) {
                    push(point, costs_.total);
                    continue;
                }
            }
            collapse(point, target_[point]);
        }
        return std::move(sequence_);
    }

private:
    struct Entry {
        float cost;
        std::uint32_t point;
        bool operator<(const Entry& other) const {  // the least comes first out of the queue
            return std::tie(cost, point) > std::tie(other.cost, other.point);
        }
    };
    struct Costs {
        float total = kImpossible;
        float distance_squared = 0.0f;
    };
    struct Move {  // of the vertices at a point
        std::uint32_t from, to;
    };
    struct Choice {
        float estimate;
        std::uint32_t target;
    };
    struct Neighbour {
        std::uint32_t point;
        std::uint32_t before = 0;  // triangles in which the edge from the fan's point leads to it
        std::uint32_t after = 0;   // and away from it
    };

    glm::vec3 place(std::size_t shape, std::uint32_t point) const { return places_.place(shape, point); }

    // --- quadrics: of the planes in every shape, and at rest of borders

    void add_quadrics() {
        const std::size_t shapes = scaled_.places.size();
        quadrics_.assign(shapes * surface_.points(), {});
        rims_.assign(surface_.points(), {});
        for (const Surface::Triangle& triangle : surface_.triangles) {
            for (std::size_t s = 0; s < shapes; ++s) {
                const auto& p = triangle.points;
                const glm::vec3 cross = glm::cross(place(s, p[1]) - place(s, p[0]), place(s, p[2]) - place(s, p[0]));
                const float length = glm::length(cross);
                if (!(length > 0.0f)) continue;
                for (const std::uint32_t point : p)
                    quadrics_[point * shapes + s].add_plane(cross / length, place(s, p[0]), length);
            }
        }
        add_rims();
    }

    void add_rims() {
        struct Side {
            std::uint32_t low, high, material, corner;
        };
        std::vector<Side> sides;
        sides.reserve(surface_.triangles.size() * 3);
        for (std::uint32_t corner = 0; corner < surface_.triangles.size() * 3; ++corner) {
            const Surface::Triangle& triangle = surface_.triangles[corner / 3];
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
                if (is_rim) add_rim(sides[first].corner);
            }
        }
    }

    /// The plane through a side of a triangle, at right angles to it.
    void add_rim(std::uint32_t corner) {
        const auto& p = surface_.triangles[corner / 3].points;
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

    float estimate(std::uint32_t point, std::uint32_t target) const {
        const std::size_t shapes = scaled_.places.size();
        float worst = kBorderFactor * rims_[point].mean_error(place(0, target));
        for (std::size_t s = 0; s < shapes; ++s) {
            worst = std::max(
                worst, (s == 0 ? 1.0f : kPosedFactor) * quadrics_[point * shapes + s].mean_error(place(s, target)));
        }
        const glm::vec3 way = place(0, target) - place(0, point);
        return worst + kLengthFactor * glm::dot(way, way);
    }

    // --- the neighbourhood of a point

    std::uint32_t next_mark() { return ++mark_; }

    /// The triangles at a point, in fan_, and its neighbours; false where it is no simple fan, that is non-manifold.
    bool find_fan(std::uint32_t point) {
        if (corner_count_[point] > kMostCorners) return false;
        surface_.find_corners(point, fan_);
        neighbours_.clear();
        const auto neighbour = [&](std::uint32_t other) -> Neighbour& {
            for (Neighbour& known : neighbours_) {
                if (known.point == other) return known;
            }
            neighbours_.push_back({other});
            return neighbours_.back();
        };
        for (const std::uint32_t corner : fan_) {
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

    /// Walks round the fan from its end, or from anywhere if it is closed.
    bool is_connected() const {
        std::uint32_t at = neighbours_.front().point;
        for (const Neighbour& n : neighbours_) {
            if (n.before == 0) at = n.point;
        }
        std::size_t steps = 0;
        for (bool moved = true; moved && steps < fan_.size();) {
            moved = false;
            for (const std::uint32_t corner : fan_) {
                const auto& p = surface_.triangles[corner / 3].points;
                if (p[(corner % 3 + 1) % 3] != at) continue;
                at = p[(corner % 3 + 2) % 3];
                ++steps;
                moved = true;
                break;
            }
        }
        return steps == fan_.size();
    }

    static bool has(const Surface::Triangle& triangle, std::uint32_t point) {
        return triangle.points[0] == point || triangle.points[1] == point || triangle.points[2] == point;
    }

    float apart(std::uint32_t a, std::uint32_t b) const {
        float sum = 0.0f;
        for (std::uint32_t k = 0; k < appearance_.components; ++k) {
            const float difference = appearance_.of(a)[k] - appearance_.of(b)[k];
            sum += difference * difference;
        }
        return sum;
    }

    /// Where each vertex of the point goes, in moves_: along its side of a seam, or where it has none on this edge to
    /// what looks most like it. False if a material would leave its border.
    bool find_moves(std::uint32_t target) {
        moves_.clear();
        crosses_seam_ = false;
        std::array<std::uint32_t, 2> materials{kNone, kNone};
        std::size_t sides = 0;
        for (const std::uint32_t corner : fan_) {
            const Surface::Triangle& triangle = surface_.triangles[corner / 3];
            for (std::size_t k = 0; k < 3; ++k) {
                if (triangle.points[k] != target) continue;
                if (sides < 2) materials[sides++] = triangle.material;
                if (!add_move({surface_.alike[triangle.vertices[corner % 3]], surface_.alike[triangle.vertices[k]]}))
                    return false;
            }
        }
        if (sides == 0 || (is_border_ && sides != 1)) return false;
        for (const std::uint32_t corner : fan_) {
            const Surface::Triangle& triangle = surface_.triangles[corner / 3];
            if (triangle.material != materials[0] && (sides != 2 || triangle.material != materials[1])) return false;
            const std::uint32_t from = surface_.alike[triangle.vertices[corner % 3]];
            if (std::any_of(moves_.begin(), moves_.end(), [&](const Move& move) { return move.from == from; }))
                continue;
            crosses_seam_ = true;
            moves_.push_back({from, most_alike(from)});
        }
        return true;
    }

    /// False where a seam ends: its triangles on this edge would keep two vertices apart, and no area.
    bool add_move(const Move& move) {
        for (const Move& known : moves_) {
            if (known.from == move.from) return known.to == move.to;
        }
        moves_.push_back(move);
        return true;
    }

    /// Of the vertices at the target that triangles have.
    std::uint32_t most_alike(std::uint32_t vertex) const {
        std::uint32_t best = kNone;
        for (const std::uint32_t corner : target_fan_) {
            const std::uint32_t other = surface_.alike[surface_.triangles[corner / 3].vertices[corner % 3]];
            if (best == kNone || apart(vertex, other) < apart(vertex, best)) best = other;
        }
        return best;
    }

    /// Whether the surface stays what it is: the two points have no neighbours in common but those of their triangles,
    /// and no triangle comes twice. T. Dey and others, Topology Preserving Edge Contraction, 1999.
    bool keeps_topology(std::uint32_t point, std::uint32_t target) {
        if (corner_count_[target] + corner_count_[point] > kMostCorners) return false;
        surface_.find_corners(target, target_fan_);
        const std::uint32_t mine = next_mark();
        const std::uint32_t counted = next_mark();
        for (const Neighbour& n : neighbours_) marks_[n.point] = mine;
        std::size_t common = 0;
        for (const std::uint32_t corner : target_fan_) {
            const Surface::Triangle& triangle = surface_.triangles[corner / 3];
            for (const std::uint32_t other : triangle.points) {
                if (other == target || other == point || marks_[other] != mine) continue;
                marks_[other] = counted;
                ++common;
            }
        }
        const auto shared = static_cast<std::size_t>(std::count_if(fan_.begin(), fan_.end(), [&](std::uint32_t corner) {
            return has(surface_.triangles[corner / 3], target);
        }));
        if (common != shared) return false;
        for (const std::uint32_t corner : fan_) {
            const auto& p = surface_.triangles[corner / 3].points;
            const std::uint32_t a = p[(corner % 3 + 1) % 3];
            const std::uint32_t b = p[(corner % 3 + 2) % 3];
            if (a == target || b == target) continue;
            for (const std::uint32_t other : target_fan_) {
                const Surface::Triangle& triangle = surface_.triangles[other / 3];
                if (has(triangle, a) && has(triangle, b)) return false;
            }
        }
        return true;
    }

    std::uint32_t moved(std::uint32_t vertex) const {
        for (const Move& move : moves_) {
            if (move.from == surface_.alike[vertex]) return move.to;
        }
        return vertex;
    }

    /// The triangles that are left of the fan, moved, in left_; false if one would turn over.
    bool find_left(std::uint32_t point, std::uint32_t target) {
        left_.clear();
        for (const std::uint32_t corner : fan_) {
            const Surface::Triangle& before = surface_.triangles[corner / 3];
            if (has(before, target)) continue;
            Surface::Triangle after = before;
            after.points[corner % 3] = target;
            after.vertices[corner % 3] = moved(before.vertices[corner % 3]);
            if (turns_over(before, after)) return false;
            left_.emplace_back(corner / 3, after);
        }
        if (!left_.empty()) return true;
        // The tip of a border: what the target has left shows how far it was.
        for (const std::uint32_t corner : target_fan_) {
            if (!has(surface_.triangles[corner / 3], point))
                left_.emplace_back(corner / 3, surface_.triangles[corner / 3]);
        }
        return !left_.empty();
    }

    bool turns_over(const Surface::Triangle& before, const Surface::Triangle& after) const {
        const auto normal = [&](std::size_t s, const Surface::Triangle& t) {
            return glm::cross(place(s, t.points[1]) - place(s, t.points[0]),
                              place(s, t.points[2]) - place(s, t.points[0]));
        };
        const glm::vec3 a = normal(0, before);
        const glm::vec3 b = normal(0, after);
        const float lengths = glm::length(a) * glm::length(b);
        return glm::dot(a, a) > 0.0f && !(glm::dot(a, b) > kLeastCosine * lengths);
    }

    // --- measuring

    /// The corners of left_ at rest, in corners_: for each corner of four triangles x, y, z; then the next four.
    void gather_left() {
        const std::size_t fours = (left_.size() + kFour - 1) / kFour;
        corners_.resize(fours * kCornerFloats);
        for (std::size_t k = 0; k < fours * kFour; ++k) {
            const Surface::Triangle& triangle = left_[k < left_.size() ? k : 0].second;  // the first once more
            float* to = corners_.data() + k / kFour * kCornerFloats + k % kFour;
            for (const std::uint32_t point : triangle.points) {
                const glm::vec3 p = places_.rest(point);
                for (int axis = 0; axis < 3; ++axis, to += kFour) *to = p[axis];
            }
        }
    }

    struct Nearest {
        std::size_t triangle = 0;  // of left_
        float distance_squared = 0.0f;
    };

    /// The triangle of left_ that is nearest to a sample at rest, the first of several. After gather_left.
    Nearest nearest(std::uint32_t sample) const {
        const glm::vec3 place = samples_.places.rest(sample);
        const FourPlaces p{FourFloats{} + place.x, FourFloats{} + place.y, FourFloats{} + place.z};
        Nearest best{0, std::numeric_limits<float>::infinity()};
        const float* corners = corners_.data();
        for (std::size_t first = 0; first < left_.size(); first += kFour, corners += kCornerFloats) {
            const FourFloats distances =
                four_distances(p, load_places(corners, kFour), load_places(corners + 3 * kFour, kFour),
                               load_places(corners + 6 * kFour, kFour));
            for (std::size_t k = 0; k < kFour; ++k) {
                if ((first == 0 && k == 0) || distances[k] < best.distance_squared) best = {first + k, distances[k]};
            }
        }
        return best;
    }

    float appearance_error(std::uint32_t sample, const Surface::Triangle& triangle) const {
        const std::uint32_t components = appearance_.components;
        if (components == 0) return 0.0f;
        const auto& p = triangle.points;
        const glm::vec3 weights =
            closest_point(samples_.places.rest(sample), places_.rest(p[0]), places_.rest(p[1]), places_.rest(p[2]))
                .weights;
        const float* own = samples_.appearance.data() + std::size_t{sample} * components;
        const float* a = appearance_.of(triangle.vertices[0]);
        const float* b = appearance_.of(triangle.vertices[1]);
        const float* c = appearance_.of(triangle.vertices[2]);
        float sum = 0.0f;
        for (std::uint32_t k = 0; k < components; ++k) {
            const float apart = own[k] - (weights.x * a[k] + weights.y * b[k] + weights.z * c[k]);
            sum += apart * apart;
        }
        return sum;
    }

    /// The squared distances of a sample from a triangle, in four of the other shapes.
    FourFloats posed_distances(std::uint32_t sample, std::size_t four, const Surface::Triangle& triangle) const {
        const std::size_t lanes = places_.lanes();
        const auto corner = [&](std::size_t k) {
            return load_places(places_.posed(triangle.points[k]) + four * kFour, lanes);
        };
        return four_distances(load_places(samples_.places.posed(sample) + four * kFour, lanes), corner(0), corner(1),
                              corner(2));
    }

    /// The squared distance of a sample from the triangles of left_, in the other shapes: exact where it is above
    /// `known`.
    float posed_distance(std::uint32_t sample, std::size_t guess, float known) const {
        for (std::size_t four = 0; four < places_.fours(); ++four) {
            FourFloats least = posed_distances(sample, four, left_[guess].second);
            for (std::size_t k = 0; k < left_.size() && kPosedFactor * largest_of(least) > known; ++k) {
                if (k == guess) continue;
                const FourFloats other = posed_distances(sample, four, left_[k].second);
                least = other < least ? other : least;
            }
            known = std::max(known, kPosedFactor * largest_of(least));
        }
        return known;
    }

    static float largest_of(const FourFloats& four) {
        return std::max(std::max(four[0], four[1]), std::max(four[2], four[3]));
    }

    /// The squared distance of the triangles of left_ from the original surface: exact where it is above `known`.
    /// Samples alone would not notice a triangle that bridges a hollow.
    float distance_from_original(float known, float limit) {
        if (alive_ > kSmall) return known;
        near_.clear();  // what is nearest in one shape is a good guess for the next
        for (const auto& [number, triangle] : left_) near_.insert(near_.end(), 4, number);
        for (std::size_t s = 0; s < scaled_.places.size() && known <= limit; ++s) {
            const float factor = s == 0 ? 1.0f : kPosedFactor;
            auto near = near_.begin();
            const auto look = [&](const glm::vec3& p) {
                known = std::max(known, factor * original_.distance_squared(s, p, known / factor, *near++));
            };
            for (const auto& [number, triangle] : left_) {
                const glm::vec3 a = place(s, triangle.points[0]);
                const glm::vec3 b = place(s, triangle.points[1]);
                const glm::vec3 c = place(s, triangle.points[2]);
                look((a + b + c) / 3.0f);
                look(0.5f * (a + b));
                look(0.5f * (b + c));
                look(0.5f * (c + a));
                if (known > limit) break;
            }
        }
        return known;
    }

    /// What moving the point to the target costs, by fan_ and left_; stops where it is above `limit`.
    Costs measure(std::uint32_t point, std::uint32_t target, float limit) {
        const float guess = kQuadricFactor * estimate(point, target);
        if (guess > limit) return {};
        gather_left();
        float largest = kBorderFactor * rims_[point].mean_error(place(0, target));
        double appearance = 0.0;
        std::size_t count = 0;
        for (const std::uint32_t corner : fan_) {
            for (std::uint32_t sample = samples_.first[corner / 3]; sample != kNone; sample = samples_.next[sample]) {
                const Nearest closest = nearest(sample);
                largest = posed_distance(sample, closest.triangle, std::max(largest, closest.distance_squared));
                if (largest + guess > limit) return {};
                appearance += appearance_error(sample, left_[closest.triangle].second);
                ++count;
            }
        }
        largest = distance_from_original(largest, limit - guess);
        if (largest + guess > limit) return {};
        if (count != 0) appearance /= static_cast<double>(count);
        if (crosses_seam_) appearance *= kSeamFactor;
        return {largest + static_cast<float>(appearance) + guess, largest};
    }

    /// The best target of a point, in target_, and what it costs, in costs_; false if it cannot go anywhere.
    bool measure_best(std::uint32_t point) {
        costs_ = {};
        measured_[point] = time_;
        if (is_gone_[point] || surface_.is_locked[point] || !find_fan(point)) return false;
        choices_.clear();
        for (const Neighbour& n : neighbours_) choices_.push_back({estimate(point, n.point), n.point});
        std::sort(choices_.begin(), choices_.end(), [](const Choice& a, const Choice& b) {
            return std::tie(a.estimate, a.target) < std::tie(b.estimate, b.target);
        });
        std::size_t tried = 0;
        for (const Choice& choice : choices_) {
            if (!prepare(point, choice.target)) continue;
            const Costs costs = measure(point, choice.target, costs_.total);
            if (costs.total < costs_.total) {
                costs_ = costs;
                target_[point] = choice.target;
            }
            if (++tried == kMeasured && surface_.points() >= kSmall) break;
        }
        return costs_.total < kImpossible;
    }

    /// Of a fan that is found.
    bool prepare(std::uint32_t point, std::uint32_t target) {
        return keeps_topology(point, target) && find_moves(target) && find_left(point, target);
    }

    // --- doing

    void push(std::uint32_t point, float cost) {
        queue_.push({cost, point});
        is_queued_[point] = true;
    }

    void reconsider(std::uint32_t point) {
        if (measure_best(point)) push(point, costs_.total);
    }

    void collapse(std::uint32_t point, std::uint32_t target) {
        if (!find_fan(point) || !prepare(point, target)) return;
        const Costs costs = measure(point, target, kImpossible);
        ++time_;
        error_ = std::max(error_, std::sqrt(costs.distance_squared) * scaled_.extent);
        add_moves(point);
        hold_samples(costs.distance_squared);
        move_triangles(target);
        is_gone_[point] = true;
        --alive_;
        const std::size_t shapes = scaled_.places.size();
        for (std::size_t s = 0; s < shapes; ++s) quadrics_[target * shapes + s].add(quadrics_[point * shapes + s]);
        rims_[target].add(rims_[point]);
        touch(target, costs.total);
        for (const Neighbour& n : neighbours_) {
            if (n.point != target) touch(n.point, costs.total);
        }
    }

    void touch(std::uint32_t point, float cost) {
        changed_[point] = time_;
        if (is_queued_[point] || is_gone_[point] || surface_.is_locked[point]) return;
        if (target_[point] == kNone) target_[point] = point;  // none yet: it will be measured
        push(point, cost);
    }

    void add_moves(std::uint32_t point) {
        bool is_joined = false;
        for (const std::uint32_t vertex : surface_.vertices_of(point)) {
            if (!surface_.is_used[vertex]) continue;
            std::uint32_t to = moved(vertex);
            if (to == vertex) to = moves_.front().to;  // no triangle has it any more
            sequence_.moves.push_back({vertex, to, is_joined, error_});
            is_joined = true;
        }
    }

    /// Gives the samples of the fan to the triangles of left_ that are nearest. `largest`: their squared distance.
    void hold_samples(float largest) {
        held_.clear();
        for (const std::uint32_t corner : fan_) {
            for (std::uint32_t sample = std::exchange(samples_.first[corner / 3], kNone); sample != kNone;
                 sample = samples_.next[sample]) {
                held_.push_back(sample);
            }
        }
        const float far = 0.25f * largest;
        for (std::size_t k = 0; k < held_.size(); ++k) {
            const Nearest closest = nearest(held_[k]);
            if (held_.size() > kMostHeld && k % 2 == 1 && closest.distance_squared < far) continue;
            samples_.hold(left_[closest.triangle].first, held_[k]);
        }
    }

    void move_triangles(std::uint32_t target) {
        for (const std::uint32_t corner : fan_) {
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

    /// Vertices of which nothing is drawn go first.
    void remove_unused() {
        const auto used = std::find(surface_.is_used.begin(), surface_.is_used.end(), true);
        if (used == surface_.is_used.end()) return;
        const auto kept = static_cast<std::uint32_t>(used - surface_.is_used.begin());
        for (auto vertex = static_cast<std::uint32_t>(surface_.is_used.size()); vertex-- > 0;) {
            if (!surface_.is_used[vertex]) sequence_.moves.push_back({vertex, kept, false, 0.0f});
        }
    }

    Surface surface_;
    Scaled scaled_;
    ShapedPlaces places_;  // of the points
    Appearance appearance_;
    Samples samples_;
    Original original_;
    std::uint32_t alive_;            // points
    std::vector<Quadric> quadrics_;  // by point, then shape
    std::vector<Quadric> rims_;      // by point: of borders, of the surface and of materials
    std::vector<std::uint32_t> corner_count_;
    std::vector<std::uint32_t> changed_, measured_;  // by point: when
    std::vector<std::uint32_t> target_;
    std::vector<bool> is_queued_, is_gone_;
    std::priority_queue<Entry> queue_;
    std::uint32_t time_ = 1;
    float error_ = 0.0f;  // metres
    Sequence sequence_;

    // Of the point that is looked at.
    std::vector<std::uint32_t> fan_, target_fan_;  // corners
    std::vector<Neighbour> neighbours_;
    bool is_border_ = false;
    bool crosses_seam_ = false;
    std::vector<Choice> choices_;
    std::vector<Move> moves_;
    std::vector<std::pair<std::uint32_t, Surface::Triangle>> left_;
    std::vector<float> corners_;  // of left_, at rest
    std::vector<std::uint32_t> near_;
    std::vector<std::uint32_t> held_;
    Costs costs_;
    std::vector<std::uint32_t> marks_;  // by point
    std::uint32_t mark_ = 0;
};

}  // namespace

Sequence find_sequence(const Mesh& mesh, std::span<const Shape> shapes, Surface surface) {
    if (surface.triangles.empty()) return {};
    return Simplifier(mesh, shapes, std::move(surface)).run();
}

}  // namespace bendy::converter
