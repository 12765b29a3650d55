#include "optimise/collapse/collapse_vertices.h"

#include "optimise/collapse/deviation.h"
#include "optimise/collapse/distances.h"
#include "optimise/collapse/fan.h"
#include "optimise/collapse/find_shapes.h"
#include "optimise/collapse/surface.h"
#include "optimise/passes/mesh_order.h"
#include "scene/space.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <queue>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace bendy::converter {
namespace {

/// A vertex that collapses onto another one.
struct VertexMove {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    bool is_joined = false;  ///< happens together with the previous move
    float error = 0.0f;      ///< metres; never decreases from move to move
};

/// The moves in the order in which they happen. The remaining vertices keep their positions.
struct Sequence {
    std::vector<VertexMove> moves;
};

constexpr float kImpossible = std::numeric_limits<float>::infinity();
/// Candidate edges that are measured per point: the ones with the lowest quadric estimates.
constexpr std::size_t kMeasured = 3;
/// Below this many points all edges are measured, and with so few left, also the new surface's distance from the old.
constexpr std::uint32_t kSmall = 20'000;
/// If more samples than this surround a point, half are dropped, but none that is half as far off as the worst: keeps
/// the work near linear.
constexpr std::size_t kMostHeld = 160;
/// If there are this many, all but the worst may be dropped: they can be equally far off, as on a flat or round
/// surface.
constexpr std::size_t kFarTooMany = 4 * kMostHeld;
/// Factor on the appearance error when a vertex leaves its side of a seam.
constexpr double kSeamFactor = 8.0;
constexpr float kQuadricFactor = 0.25f;  // of the mean squared distance from the planes, added to the largest distance
constexpr std::size_t kCornerFloats = 9 * kFour;  // floats of four triangles

/// The shapes at a common scale, each centred at the origin.
struct Scaled {
    std::vector<std::vector<glm::vec3>> places;  // per shape: the vertex positions
    float extent = 1.0f;                         // metres
};

Scaled scale(std::span<const Shape> shapes) {
    Scaled scaled;
    for (const Shape& shape : shapes) {
        const auto [low, high] = box_of(shape);
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

/// Greedy half-edge collapses. The cost is the largest distance between the surface and the original one, in any shape.
class Simplifier {
public:
    Simplifier(const Mesh& mesh, std::span<const Shape> shapes, Surface surface)
        : surface_(std::move(surface)),
          scaled_(scale(shapes)),
          places_(place_points(surface_, scaled_)),
          appearance_(make_appearance(mesh, surface_, scaled_.places.front())),
          samples_(make_samples(surface_, scaled_.places, appearance_)),
          original_(surface_, scaled_.places),
          quadrics_(surface_, places_, scaled_.places.size()),
          fan_(surface_, places_, appearance_),
          alive_(surface_.points()),
          changed_(surface_.points(), 0),
          measured_(surface_.points(), 0),
          target_(surface_.points(), kNone),
          is_queued_(surface_.points(), false),
          is_gone_(surface_.points(), false) {}

    Sequence run(const Progress& progress) {
        remove_unused();
        for (std::uint32_t point = 0; point < surface_.points(); ++point) reconsider(point);
        std::size_t told = 0;
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
            constexpr std::size_t kSeldom = 256;
            if (progress && sequence_.moves.size() >= told + kSeldom) {
                told = sequence_.moves.size();
                progress(std::min(1.0, static_cast<double>(told) / static_cast<double>(surface_.is_used.size())));
            }
        }
        return std::move(sequence_);
    }

private:
    struct Entry {
        float cost;
        std::uint32_t point;
        bool operator<(const Entry& other) const {  // makes the priority queue a min-heap
            return std::tie(cost, point) > std::tie(other.cost, other.point);
        }
    };
    struct Costs {
        float total = kImpossible;
        float distance_squared = 0.0f;
    };
    struct Choice {
        float estimate;
        std::uint32_t target;
    };

    glm::vec3 place(std::size_t shape, std::uint32_t point) const { return places_.place(shape, point); }

    // --- measuring

    /// Fills corners_ with the corners of fan_.left() at rest, in blocks of four triangles: x, y, z of each corner.
    void gather_left() {
        const std::size_t fours = (fan_.left().size() + kFour - 1) / kFour;
        corners_.resize(fours * kCornerFloats);
        for (std::size_t k = 0; k < fours * kFour; ++k) {
            const Surface::Triangle& triangle =
                fan_.left()[k < fan_.left().size() ? k : 0].second;  // pad with the first
            float* to = corners_.data() + k / kFour * kCornerFloats + k % kFour;
            for (const std::uint32_t point : triangle.points) {
                const glm::vec3 p = places_.rest(point);
                for (int axis = 0; axis < 3; ++axis, to += kFour) *to = p[axis];
            }
        }
    }

    struct Nearest {
        std::size_t triangle = 0;  // of fan_.left()
        float distance_squared = 0.0f;
    };

    /// The triangle of fan_.left() that is nearest to a sample at rest; on a tie, the first. Needs gather_left.
    Nearest nearest(std::uint32_t sample) const {
        const glm::vec3 place = samples_.places.rest(sample);
        const FourPlaces p{FourFloats{} + place.x, FourFloats{} + place.y, FourFloats{} + place.z};
        Nearest best{0, std::numeric_limits<float>::infinity()};
        const float* corners = corners_.data();
        for (std::size_t first = 0; first < fan_.left().size(); first += kFour, corners += kCornerFloats) {
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

    /// The squared distance of a sample from the triangles of fan_.left(), over the other shapes: exact if above
    /// `known`.
    float posed_distance(std::uint32_t sample, std::size_t guess, float known) const {
        for (std::size_t four = 0; four < places_.fours(); ++four) {
            FourFloats least = posed_distances(sample, four, fan_.left()[guess].second);
            for (std::size_t k = 0; k < fan_.left().size() && kPosedFactor * largest_of(least) > known; ++k) {
                if (k == guess) continue;
                const FourFloats other = posed_distances(sample, four, fan_.left()[k].second);
                least = select(other < least, other, least);
            }
            known = std::max(known, kPosedFactor * largest_of(least));
        }
        return known;
    }

    static float largest_of(const FourFloats& four) {
        return std::max(std::max(four[0], four[1]), std::max(four[2], four[3]));
    }

    /// The squared distance of the triangles of fan_.left() from the original surface: exact if above `known`. Samples
    /// alone would miss a triangle that bridges a hollow.
    float distance_from_original(float known, float limit) {
        if (alive_ > kSmall) return known;
        near_.clear();  // the nearest in one shape is a good first guess for the next
        for (const auto& [number, triangle] : fan_.left()) near_.insert(near_.end(), 4, number);
        for (std::size_t s = 0; s < scaled_.places.size() && known <= limit; ++s) {
            const float factor = s == 0 ? 1.0f : kPosedFactor;
            auto near = near_.begin();
            const auto look = [&](const glm::vec3& p) {
                known = std::max(known, factor * original_.distance_squared(s, p, known / factor, *near++));
            };
            for (const auto& [number, triangle] : fan_.left()) {
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

    /// The cost of moving the point to the target, for the prepared fan; stops early above `limit`.
    Costs measure(std::uint32_t point, std::uint32_t target, float limit) {
        const float guess = kQuadricFactor * quadrics_.estimate(point, target);
        if (guess > limit) return {};
        gather_left();
        float largest = quadrics_.border_error(point, target);
        double appearance = 0.0;
        std::size_t count = 0;
        for (const std::uint32_t corner : fan_.corners()) {
            for (std::uint32_t sample = samples_.first[corner / 3]; sample != kNone; sample = samples_.next[sample]) {
                const Nearest closest = nearest(sample);
                largest = posed_distance(sample, closest.triangle, std::max(largest, closest.distance_squared));
                if (largest + guess > limit) return {};
                appearance += appearance_error(sample, fan_.left()[closest.triangle].second);
                ++count;
            }
        }
        largest = distance_from_original(largest, limit - guess);
        if (largest + guess > limit) return {};
        if (count != 0) appearance /= static_cast<double>(count);
        if (fan_.crosses_seam()) appearance *= kSeamFactor;
        return {largest + static_cast<float>(appearance) + guess, largest};
    }

    /// Finds the best target of a point and its cost, in target_ and costs_; false if the point cannot move.
    bool measure_best(std::uint32_t point) {
        costs_ = {};
        measured_[point] = time_;
        if (is_gone_[point] || surface_.is_locked[point] || !fan_.find(point)) return false;
        choices_.clear();
        for (const Fan::Neighbour& n : fan_.neighbours())
            choices_.push_back({quadrics_.estimate(point, n.point), n.point});
        std::sort(choices_.begin(), choices_.end(), [](const Choice& a, const Choice& b) {
            return std::tie(a.estimate, a.target) < std::tie(b.estimate, b.target);
        });
        std::size_t tried = 0;
        for (const Choice& choice : choices_) {
            if (!fan_.prepare(point, choice.target)) continue;
            const Costs costs = measure(point, choice.target, costs_.total);
            if (costs.total < costs_.total) {
                costs_ = costs;
                target_[point] = choice.target;
            }
            if (++tried == kMeasured && surface_.points() >= kSmall) break;
        }
        return costs_.total < kImpossible;
    }

    // --- collapsing

    void push(std::uint32_t point, float cost) {
        queue_.push({cost, point});
        is_queued_[point] = true;
    }

    void reconsider(std::uint32_t point) {
        if (measure_best(point)) push(point, costs_.total);
    }

    void collapse(std::uint32_t point, std::uint32_t target) {
        if (!fan_.find(point) || !fan_.prepare(point, target)) return;
        const Costs costs = measure(point, target, kImpossible);
        ++time_;
        error_ = std::max(error_, std::sqrt(costs.distance_squared) * scaled_.extent);
        add_moves(point);
        hold_samples(costs.distance_squared);
        fan_.move_to(target);
        is_gone_[point] = true;
        --alive_;
        quadrics_.add_to(target, point);
        touch(target, costs.total);
        for (const Fan::Neighbour& n : fan_.neighbours()) {
            if (n.point != target) touch(n.point, costs.total);
        }
    }

    void touch(std::uint32_t point, float cost) {
        changed_[point] = time_;
        if (is_queued_[point] || is_gone_[point] || surface_.is_locked[point]) return;
        if (target_[point] == kNone) target_[point] = point;  // no target yet: it will be measured
        push(point, cost);
    }

    void add_moves(std::uint32_t point) {
        bool is_joined = false;
        for (const std::uint32_t vertex : surface_.vertices_of(point)) {
            if (!surface_.is_used[vertex]) continue;
            std::uint32_t to = fan_.moved(vertex);
            if (to == vertex) to = fan_.moves().front().to;  // no triangle uses it any more
            sequence_.moves.push_back({vertex, to, is_joined, error_});
            is_joined = true;
        }
    }

    /// Assigns the samples of the fan to the nearest triangles of fan_.left(). `largest`: their largest squared
    /// distance.
    void hold_samples(float largest) {
        held_.clear();
        for (const std::uint32_t corner : fan_.corners()) {
            for (std::uint32_t sample = std::exchange(samples_.first[corner / 3], kNone); sample != kNone;
                 sample = samples_.next[sample]) {
                held_.push_back(sample);
            }
        }
        const bool are_far_too_many = held_.size() > kFarTooMany;
        const float far = are_far_too_many ? largest : 0.25f * largest;
        for (std::size_t k = 0; k < held_.size(); ++k) {
            const Nearest closest = nearest(held_[k]);
            const bool is_near = closest.distance_squared < far || (are_far_too_many && far == 0.0f);
            if (held_.size() > kMostHeld && k % 2 == 1 && is_near) continue;
            samples_.hold(fan_.left()[closest.triangle].first, held_[k]);
        }
    }

    /// Vertices that no primitive uses go first.
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
    Quadrics quadrics_;
    Fan fan_;                                        // of the current point
    std::uint32_t alive_;                            // points
    std::vector<std::uint32_t> changed_, measured_;  // by point: when
    std::vector<std::uint32_t> target_;
    std::vector<bool> is_queued_, is_gone_;
    std::priority_queue<Entry> queue_;
    std::uint32_t time_ = 1;
    float error_ = 0.0f;  // metres
    Sequence sequence_;

    // For the current point.
    std::vector<Choice> choices_;
    std::vector<float> corners_;  // of fan_.left(), at rest
    std::vector<std::uint32_t> near_;
    std::vector<std::uint32_t> held_;
    Costs costs_;
};

/// The collapse sequence of a mesh.
/// \param shapes   as find_shapes returns them
/// \param surface  of this mesh; modified
Sequence find_sequence(const Mesh& mesh, std::span<const Shape> shapes, Surface surface, const Progress& progress) {
    if (surface.triangles.empty()) return {};
    return Simplifier(mesh, shapes, std::move(surface)).run(progress);
}

constexpr std::size_t kMostLevels = 32;
constexpr double kShareKept = 0.9;  // of the collapsible vertices, by the next level

struct Move {
    float error;
    std::uint32_t mesh;
    bool is_joined;
};

/// Levels of equal error across all meshes, from full detail to the least: some tens of them, each with about the same
/// share of the vertices of the one before.
std::vector<LodLevel> make_levels(std::span<const Mesh> meshes, std::span<const Sequence> sequences) {
    std::vector<Move> moves;
    for (std::uint32_t mesh = 0; mesh < sequences.size(); ++mesh) {
        for (const VertexMove& move : sequences[mesh].moves) moves.push_back({move.error, mesh, move.is_joined});
    }
    if (moves.empty()) return {};
    std::stable_sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) { return a.error < b.error; });
    LodLevel level;
    for (const Mesh& mesh : meshes) level.alive.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    std::vector<LodLevel> levels{level};
    double next = kShareKept * static_cast<double>(moves.size());
    for (std::size_t done = 0; done < moves.size();) {
        level.error = moves[done].error;
        --level.alive[moves[done].mesh];
        const std::size_t left = moves.size() - ++done;
        const bool is_last = left == 0;
        if (!is_last && moves[done].is_joined) continue;
        if (!is_last && (static_cast<double>(left) > next || levels.size() + 1 >= kMostLevels)) continue;
        next = kShareKept * static_cast<double>(left);
        levels.push_back(level);
    }
    return levels;
}

/// Sorts a mesh's vertices so that the longest-lived come first, with all streams, targets and indices, and fills
/// Mesh::collapse, joined and base. A sequence without moves changes nothing.
void order_vertices(Mesh& mesh, const Sequence& sequence) {
    if (sequence.moves.empty()) return;
    const std::size_t vertices = mesh.positions.size();
    std::vector<bool> moves(vertices);
    for (const VertexMove& move : sequence.moves) moves[move.from] = true;
    std::vector<std::uint32_t> order;
    order.reserve(vertices);
    for (std::uint32_t vertex = 0; vertex < vertices; ++vertex) {
        if (!moves[vertex]) order.push_back(vertex);
    }
    mesh.base = static_cast<std::uint32_t>(order.size());
    // Backwards, but the first of a joined group stays the first.
    for (std::size_t end = sequence.moves.size(); end > 0;) {
        std::size_t begin = end - 1;
        while (sequence.moves[begin].is_joined) --begin;
        for (std::size_t move = begin; move < end; ++move) order.push_back(sequence.moves[move].from);
        end = begin;
    }
    const std::vector<std::uint32_t> number = permute_vertices(mesh, order);
    mesh.collapse.resize(vertices);
    mesh.joined.assign(vertices, 0);
    for (std::uint32_t vertex = 0; vertex < mesh.base; ++vertex) mesh.collapse[vertex] = vertex;
    for (const VertexMove& move : sequence.moves) {
        mesh.collapse[number[move.from]] = number[move.to];
        mesh.joined[number[move.from]] = move.is_joined ? 1 : 0;
    }
}

}  // namespace

void collapse_vertices(Scene& scene, const Progress& progress) {
    const std::vector<std::vector<Shape>> shapes = find_shapes(scene);
    std::vector<Surface> surfaces;
    surfaces.reserve(scene.meshes.size());
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        surfaces.push_back(make_surface(scene.meshes[mesh], shapes[mesh]));
        // Merge identical vertices: otherwise degenerate triangles between duplicates would remain.
        for (Submesh& submesh : scene.meshes[mesh].submeshes) {
            for (std::uint32_t& index : submesh.indices) index = surfaces.back().alike[index];
        }
    }
    lock_shared_borders(shapes, surfaces);
    double all = 1.0;
    for (const Mesh& mesh : scene.meshes) all += static_cast<double>(mesh.positions.size());
    double done = 0.0;
    std::vector<Sequence> sequences;
    sequences.reserve(surfaces.size());
    for (std::size_t mesh = 0; mesh < surfaces.size(); ++mesh) {
        const auto vertices = static_cast<double>(scene.meshes[mesh].positions.size());
        sequences.push_back(find_sequence(scene.meshes[mesh], shapes[mesh], std::move(surfaces[mesh]),
                                          part_of(progress, done / all, (done + vertices) / all)));
        done += vertices;
    }
    for (std::size_t mesh = 0; mesh < sequences.size(); ++mesh) order_vertices(scene.meshes[mesh], sequences[mesh]);
    scene.levels = make_levels(scene.meshes, sequences);
}

}  // namespace bendy::converter
