#include "optimise/measure_error.h"

#include "optimise/carried_points.h"
#include "optimise/posable_mesh.h"
#include "optimise/sample_limits.h"
#include "scene/evaluate.h"
#include "scene/frame_shapes.h"
#include "scene/in_parallel.h"
#include "scene/space.h"
#include "scene/used_entries.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>

namespace bendy::converter {
namespace {

constexpr double kMostSamplesOfClip = 100'800.0;  // of one clip: 7 minutes
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// NaN counts as infinite.
double or_infinite(double value) {
    if (std::isnan(value)) return kInfinity;
    return value;
}

/// Raises `most` to the value if that is larger.
void raise(double& most, double value) {
    if (!(value <= most)) most = or_infinite(value);
}

/// An upper bound on the factor by which the matrix stretches a vector.
double stretch_of(const glm::dmat3& m) {
    double largest = 0.0;  // of the row sums of m^T m, whose eigenvalues are squared stretches
    for (int row = 0; row < 3; ++row) {
        double sum = 0.0;
        for (int column = 0; column < 3; ++column) sum += std::abs(glm::dot(m[row], m[column]));
        raise(largest, sum);
    }
    return std::sqrt(largest);
}

/// The lengths of the matrix's columns.
glm::dvec3 lengths_of(const glm::dmat3& m) {
    return {glm::length(m[0]), glm::length(m[1]), glm::length(m[2])};
}

/// A mesh in both scenes. With bone matrices P and Q, positions p and p', weights w and w' of the exact and the decoded
/// mesh, and Q_0 of any one bone, the error of a vertex is
///     sum w P p - sum w' Q p' = sum w (P - Q) p + sum (w - w') (Q - Q_0) p + sum (w - w') Q_0 p + sum w' Q (p - p')
/// Each of the four terms is bounded by constants of the vertex and of the bones. Vertices are in a tree of boxes, so
/// that a bound passes over many of them. This is what does not depend on the pose.
class PairPlan {
public:
    /// The scenes must outlive the plan.
    PairPlan(const Mesh& exact_mesh, const Mesh& decoded_mesh, const std::vector<std::uint32_t>* vertex_map)
        : exact(exact_mesh, used_entries(exact_mesh, decoded_mesh)),
          decoded(decoded_mesh, used_entries(decoded_mesh, exact_mesh)),
          map(vertex_map) {
        touched.resize(exact.size());
        std::vector<bool> touched_there(decoded.size());
        exact.mark_touched(touched);
        decoded.mark_touched(touched_there);
        for (std::size_t vertex = 0; vertex < exact.size(); ++vertex) {
            const std::uint32_t there = place_in_decoded(vertex);
            if (there != kNone && touched_there[there]) touched[vertex] = true;
        }
        has_bounds = exact.joints() == decoded.joints();
        differences.resize(exact.size());
        if (has_bounds) find_differences();
        find_nodes();
    }

    [[nodiscard]] bool can_be_compared() const {
        if (map == nullptr) return exact.size() == decoded.size();
        return map->size() == exact.size() && std::all_of(map->begin(), map->end(), [&](std::uint32_t vertex) {
                   return vertex == kNone || vertex < decoded.size();
               });
    }

    /// How much a vertex's data differ between the two scenes: rounded up, since large meshes have many.
    struct Difference {
        float place = 0.0f;          // metres, in mesh space
        float weights = 0.0f;        // sum of |w - w'|
        float weight_sum = 0.0f;     // |sum of w - w'|
        float exact_total = 0.0f;    // sum of w
        float decoded_total = 0.0f;  // sum of w'
    };

    /// Vertices that the same bones move, in a box; its parts follow it.
    struct Node {
        std::uint32_t entries = 0;           // number of the list of palette entries
        std::uint32_t first = 0, count = 0;  // of a box without parts: its vertices
        std::uint32_t end = 0;               // index of the first node after its parts
        glm::vec3 middle{0.0f};              // in mesh space
        glm::vec3 half{0.0f};                // from the middle to the farthest corner, rounded up
        Difference worst_case;
        bool is_touched = false;  // some target displaces them
    };
    [[nodiscard]] std::uint32_t place_in_decoded(std::size_t vertex) const {
        if (map != nullptr) return vertex < map->size() && (*map)[vertex] < decoded.size() ? (*map)[vertex] : kNone;
        return vertex < decoded.size() ? static_cast<std::uint32_t>(vertex) : kNone;
    }

    MeshShape exact, decoded;
    const std::vector<std::uint32_t>* map;
    std::vector<bool> touched;  // by a target of either scene
    bool has_bounds = false;
    std::vector<std::vector<std::uint32_t>> entries;  // lists of palette entries, ascending
    std::vector<Node> nodes;
    std::vector<std::uint32_t> order;     // of the vertices that are compared, node by node
    std::vector<Difference> differences;  // per vertex
    std::vector<Box<glm::dvec3>> boxes;   // per bone: bounds of the vertices that it moves, in mesh space

private:
    /// The palette entries that a mesh uses, or that the other mesh uses if both have the same palette.
    static std::vector<bool> used_entries(const Mesh& mesh, const Mesh& other) {
        std::vector<bool> used;
        mark_used(mesh, used);
        if (other.palette.joints == mesh.palette.joints) mark_used(other, used);
        return used;
    }

    static float rounded_up(double value) {
        if (!(value <= std::numeric_limits<float>::max())) return std::numeric_limits<float>::infinity();
        const auto near = static_cast<float>(value);
        return near < value ? std::nextafter(near, std::numeric_limits<float>::infinity()) : near;
    }
    static void raise(float& most, float value) { most = std::max(most, value); }
    static void raise(Difference& most, const Difference& d) {
        raise(most.place, d.place);
        raise(most.weights, d.weights);
        raise(most.weight_sum, d.weight_sum);
        raise(most.exact_total, d.exact_total);
        raise(most.decoded_total, d.decoded_total);
    }

    void find_nodes() {
        std::map<std::pair<bool, std::vector<std::uint32_t>>, std::vector<std::uint32_t>> groups;
        auto last = groups.end();  // neighbours often are in the same group
        std::pair<bool, std::vector<std::uint32_t>> key;
        for (std::uint32_t vertex = 0; vertex < exact.size(); ++vertex) {
            const std::uint32_t there = place_in_decoded(vertex);
            if (there == kNone) continue;
            key.first = touched[vertex];
            key.second.clear();
            const auto add = [&](std::uint32_t entry, float) { key.second.push_back(entry); };
            exact.for_each_influence(vertex, add);
            decoded.for_each_influence(there, add);
            std::sort(key.second.begin(), key.second.end());
            key.second.erase(std::unique(key.second.begin(), key.second.end()), key.second.end());
            if (last == groups.end() || last->first != key) last = groups.try_emplace(key).first;
            last->second.push_back(vertex);
        }
        std::size_t most_nodes = groups.size();  // a box has at least half of kMostVertices, and as many parts as boxes
        for (const auto& group : groups) most_nodes += 2 * group.second.size() / (kMostVertices / 2);
        nodes.reserve(most_nodes);
        order.reserve(exact.size());
        for (auto& [bones, vertices] : groups) {
            entries.push_back(bones.second);
            add_nodes(vertices, bones.first);
        }
    }

    static constexpr std::size_t kMostVertices = 8;  // of a box without parts

    /// Splits the vertices across their longest side, until each box has few.
    void add_nodes(std::span<std::uint32_t> all, bool is_touched) {
        struct Open {
            std::span<std::uint32_t> vertices;
            std::size_t closes = 0;  // the node that ends here; vertices are empty
        };
        std::vector<Open> open{{all, 0}};
        while (!open.empty()) {
            const auto [vertices, closes] = open.back();
            open.pop_back();
            if (vertices.empty()) {
                nodes[closes].end = static_cast<std::uint32_t>(nodes.size());
                continue;
            }
            Box<glm::dvec3> box;
            for (const std::uint32_t vertex : vertices) box.add(exact.base(vertex));
            const glm::dvec3 size = box.high - box.low;
            const int larger = size.y > size.x ? 1 : 0;
            const int axis = size.z > size[larger] ? 2 : larger;
            Node& node = nodes.emplace_back();
            node.entries = static_cast<std::uint32_t>(entries.size() - 1);
            node.middle = glm::vec3(0.5 * (box.low + box.high));
            for (int c = 0; c < 3; ++c) {
                const double middle = node.middle[c];
                node.half[c] = rounded_up(std::max(box.high[c] - middle, middle - box.low[c]));
            }
            node.is_touched = is_touched;
            node.end = static_cast<std::uint32_t>(nodes.size());
            for (const std::uint32_t vertex : vertices) raise(node.worst_case, differences[vertex]);
            if (vertices.size() <= kMostVertices || !(size[axis] > 0.0)) {
                std::sort(vertices.begin(), vertices.end());  // nth_element's order differs between libraries
                node.first = static_cast<std::uint32_t>(order.size());
                node.count = static_cast<std::uint32_t>(vertices.size());
                order.insert(order.end(), vertices.begin(), vertices.end());
                continue;
            }
            const std::size_t half = vertices.size() / 2;
            std::nth_element(vertices.begin(), vertices.begin() + static_cast<std::ptrdiff_t>(half), vertices.end(),
                             [&](std::uint32_t a, std::uint32_t b) {
                                 return std::pair(or_infinite(exact.base(a)[axis]), a) <
                                        std::pair(or_infinite(exact.base(b)[axis]), b);
                             });
            open.push_back({{}, nodes.size() - 1});
            open.push_back({vertices.subspan(half), 0});
            open.push_back({vertices.first(half), 0});
        }
    }

    void find_differences() {
        boxes.resize(exact.joints().size());
        std::vector<double> change(boxes.size(), 0.0);
        for (std::size_t vertex = 0; vertex < exact.size(); ++vertex) {
            const std::uint32_t there = place_in_decoded(vertex);
            if (there == kNone) continue;
            double weights = 0.0, exact_total = 0.0, decoded_total = 0.0;
            exact.for_each_influence(vertex, [&](std::uint32_t entry, float weight) {
                change[entry] += weight;
                exact_total += weight;
                boxes[entry].add(exact.base(vertex));
            });
            decoded.for_each_influence(there, [&](std::uint32_t entry, float weight) {
                change[entry] -= weight;
                decoded_total += weight;
                boxes[entry].add(exact.base(vertex));
            });
            const auto take = [&](std::uint32_t entry, float) {
                weights += std::abs(std::exchange(change[entry], 0.0));
            };
            exact.for_each_influence(vertex, take);
            decoded.for_each_influence(there, take);
            differences[vertex] = {rounded_up(glm::distance(exact.base(vertex), decoded.base(there))),
                                   rounded_up(weights), rounded_up(std::abs(exact_total - decoded_total)),
                                   rounded_up(exact_total), rounded_up(decoded_total)};
        }
    }
};

/// A pair in a pose.
class MeshPair {
public:
    /// \param plan  must outlive the pair
    explicit MeshPair(const PairPlan& plan)
        : plan_(&plan), exact_(plan.exact), decoded_(plan.decoded), bones_(plan.boxes.size()) {}

    /// Updates `worst` if a vertex of this pose is worse; returns whether it did.
    bool measure(const EvaluatedPose& exact_pose, const EvaluatedPose& decoded_pose, std::uint32_t mesh,
                 MeasuredError& worst) {
        const bool moved_here = exact_.set_pose(exact_pose.joints, exact_pose.morph_weights[mesh]);
        const bool moved_there = decoded_.set_pose(decoded_pose.joints, decoded_pose.morph_weights[mesh]);
        if (!moved_here && !moved_there && is_measured_) return false;
        is_measured_ = true;
        const bool is_displaced = exact_.is_displaced() || decoded_.is_displaced();
        if (plan_->has_bounds) bound_bones();
        bool has_risen = false;
        const auto look_at = [&](std::uint32_t vertex) {
            const double error = glm::distance(exact_.place(vertex), decoded_.place(plan_->place_in_decoded(vertex)));
            if (error <= worst.metres) return;
            worst.metres = or_infinite(error);
            worst.mesh = mesh;
            worst.vertex = vertex;
            has_risen = true;
        };
        for (std::size_t number = 0; number < plan_->nodes.size();) {
            const PairPlan::Node& node = plan_->nodes[number++];
            const bool has_bounds = plan_->has_bounds && !(is_displaced && node.is_touched);
            PoseBound bones;
            if (has_bounds) {
                bones = bound_of(node);
                if (bound(node.worst_case, bones) <= worst.metres) {
                    number = node.end;
                    continue;
                }
            }
            for (std::uint32_t at = node.first; at < node.first + node.count; ++at) {
                const std::uint32_t vertex = plan_->order[at];
                if (!has_bounds || !(bound(plan_->differences[vertex], bones) <= worst.metres)) look_at(vertex);
            }
        }
        return has_risen;
    }

    /// Forces the next pose to be measured, even if it equals the last one.
    void forget_pose() { is_measured_ = false; }

private:
    /// A bone in this pose.
    struct Bone {
        Affine difference;      // exact minus decoded
        glm::dvec3 lengths;     // of the difference's columns
        double stretch = 0.0;   // of the decoded matrix, at most
        double distance = 0.0;  // from the origin to what it moves, at most
    };
    /// Upper bounds for all vertices of a node in this pose.
    struct PoseBound {
        double difference =
            0.0;                // metres between the places of a point, by one bone of the exact and the decoded scene
        double stretch = 0.0;   // of a decoded bone
        double spread = 0.0;    // metres between the places of a point, by two decoded bones
        double distance = 0.0;  // metres from the origin
    };

    /// Computes the bones' part of the bounds for this pose.
    void bound_bones() {
        for (std::size_t number = 0; number < plan_->boxes.size(); ++number) {
            const Box<glm::dvec3>& box = plan_->boxes[number];
            if (box.is_empty()) continue;
            const Affine& p = exact_.matrices()[number];
            const Affine& q = decoded_.matrices()[number];
            Bone& bone = bones_[number];
            bone.difference = {p.linear - q.linear, p.origin - q.origin};
            bone.lengths = lengths_of(bone.difference.linear);
            bone.stretch = stretch_of(q.linear);
            bone.distance =
                glm::length(q(0.5 * (box.low + box.high))) + bone.stretch * 0.5 * glm::distance(box.low, box.high);
        }
    }

    /// A point of the box is its middle plus at most `half` along each axis, which a matrix makes as long as its
    /// columns.
    [[nodiscard]] PoseBound bound_of(const PairPlan::Node& node) const {
        PoseBound most;
        const glm::dvec3 middle(node.middle), half(node.half);
        const std::vector<std::uint32_t>& entries = plan_->entries[node.entries];
        for (const std::uint32_t entry : entries) {
            const Bone& bone = bones_[entry];
            raise(most.difference, glm::length(bone.difference(middle)) + glm::dot(bone.lengths, half));
            raise(most.stretch, bone.stretch);
            raise(most.distance, bone.distance);
        }
        if (!(node.worst_case.weights > 0.0) || entries.empty()) return most;
        const Affine& first = decoded_.matrices()[entries[0]];
        const glm::dvec3 place = first(middle);
        for (std::size_t k = 1; k < entries.size(); ++k) {
            const Affine& other = decoded_.matrices()[entries[k]];
            raise(most.spread,
                  glm::distance(other(middle), place) + glm::dot(lengths_of(other.linear - first.linear), half));
        }
        return most;
    }

    [[nodiscard]] static double bound(const PairPlan::Difference& d, const PoseBound& bones) {
        constexpr double kRounding = 1.0 + 1e-9;
        return kRounding *
               (double{d.exact_total} * bones.difference + double{d.decoded_total} * bones.stretch * d.place +
                d.weights * bones.spread + d.weight_sum * bones.distance);
    }

    const PairPlan* plan_;
    PosableMesh exact_, decoded_;
    bool is_measured_ = false;
    std::vector<Bone> bones_;
};

/// Joints that move no vertex.
std::vector<std::uint32_t> loose_joints(const Scene& scene) {
    std::vector<bool> moves(scene.joints.size());
    for (const Mesh& mesh : scene.meshes) {
        if (mesh.influences == 0 && mesh.joint != kNone) moves[mesh.joint] = true;
        for (const std::uint32_t joint : mesh.palette.joints) moves[joint] = true;
    }
    std::vector<std::uint32_t> loose;
    for (std::uint32_t joint = 0; joint < moves.size(); ++joint) {
        if (!moves[joint]) loose.push_back(joint);
    }
    return loose;
}

/// Test points of a joint, in its own space: its origin and, if the scene has no vertices to show rotation and scale,
/// one on each axis.
std::vector<glm::dvec3> points_of_joints(const Scene& scene) {
    std::vector<glm::dvec3> points{glm::dvec3(0.0)};
    const bool has_vertices =
        std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const Mesh& mesh) { return !mesh.positions.empty(); });
    if (has_vertices) return points;
    const double reach = kJointReach * height_at_rest(scene);
    for (int axis = 0; axis < 3; ++axis) {
        points.emplace_back(0.0);
        points.back()[axis] = reach;
    }
    return points;
}

/// \param limit  maximum number of samples between the keys
std::vector<double> sample_times(const Clip& exact, const Clip& decoded, std::size_t limit) {
    std::vector<double> times;
    for (const Clip* clip : {&exact, &decoded}) {
        for (const Track& track : clip->tracks) times.insert(times.end(), track.times.begin(), track.times.end());
        for (const Play& play : clip->plays) {
            for (std::uint32_t frame = 0; frame <= play.frames; ++frame) {
                const double at = frame / double{clip->frame_rate};
                if (at <= length_of(*clip, play)) times.push_back(clip->frame_start + at);
            }
        }
        std::sort(times.begin(), times.end());
        times.erase(std::unique(times.begin(), times.end()), times.end());
    }
    if (times.empty() || limit == 0) return times;
    const double start = times.front();
    const double length = times.back() - start;
    const double most = std::min(kMostSamplesOfClip, static_cast<double>(limit));
    const double steps = std::min(std::ceil(length * kSamplesPerSecond), most);
    const double step = steps < most ? 1.0 / kSamplesPerSecond : length / steps;
    for (unsigned k = 1; k < steps; ++k) times.push_back(start + k * step);
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

class Measurement {
public:
    Measurement(const Scene& exact, const Scene& decoded, const MeasureOptions& options)
        : exact_(exact), decoded_(decoded), shell_(options.shell), limit_(options.limit) {
        const VertexMaps maps = options.vertex_maps;
        auto plans = std::make_shared<std::vector<PairPlan>>();
        plans->reserve(exact.meshes.size());
        pairs_.reserve(exact.meshes.size());
        for (std::size_t mesh = 0; mesh < exact.meshes.size(); ++mesh) {
            const bool is_mapped = mesh < maps.size() && !maps[mesh].empty();
            plans->emplace_back(exact.meshes[mesh], decoded.meshes[mesh], is_mapped ? &maps[mesh] : nullptr);
            pairs_.emplace_back(plans->back());
        }
        plans_ = std::move(plans);
        loose_ = loose_joints(exact);
        points_ = points_of_joints(exact);
        needed_.resize(exact.joints.size());
        for (const PairPlan& plan : *plans_) {
            for (const MeshShape* shape : {&plan.exact, &plan.decoded}) {
                for (const std::uint32_t joint : shape->joints()) {
                    if (joint != kNone) needed_[joint] = true;
                }
            }
        }
    }

    [[nodiscard]] bool is_possible() const {
        return std::all_of(plans_->begin(), plans_->end(), [](const PairPlan& plan) { return plan.can_be_compared(); });
    }

    void measure_rest() {
        evaluate_rest(exact_, exact_pose_);
        evaluate_rest(decoded_, decoded_pose_);
        place_points([](std::uint32_t joint) { return joint; },
                     [](std::uint32_t, const glm::dvec3& point) { return std::pair(point, point); });
        measure(kNone, 0.0);
    }

    void measure_at(double seconds) {
        exact_clip_->at(seconds, exact_pose_);
        decoded_clip_->at(seconds, decoded_pose_);
        measure(clip_, seconds);
    }

    [[nodiscard]] const MeasuredError& worst() const { return worst_; }
    /// Begins a clip. Passes over errors below `known`, the error of another pose.
    void start_anew(std::uint32_t clip, double known) {
        clip_ = clip;
        exact_clip_.emplace(exact_, exact_.clips[clip]);
        decoded_clip_.emplace(decoded_, decoded_.clips[clip]);
        worst_ = {};
        worst_.metres = std::nextafter(known, 0.0);  // an equal error counts: the result does not depend on the order
        for (MeshPair& pair : pairs_) pair.forget_pose();
        std::vector<std::uint32_t> moved;
        std::set_union(exact_clip_->moved().begin(), exact_clip_->moved().end(), decoded_clip_->moved().begin(),
                       decoded_clip_->moved().end(), std::back_inserter(moved));
        exact_clip_->follow(moved, needed_, exact_pose_);
        decoded_clip_->follow(moved, needed_, decoded_pose_);
        place_points([&](std::uint32_t joint) { return exact_clip_->carriers()[joint]; },
                     [&](std::uint32_t joint, const glm::dvec3& point) {
                         const glm::dvec4 at(point, 1.0);
                         return std::pair(glm::dvec3(exact_clip_->to_carriers()[joint] * at),
                                          glm::dvec3(decoded_clip_->to_carriers()[joint] * at));
                     });
    }

private:
    /// Fills `origins_` and `shells_`.
    /// \param carrier_of  of a joint
    /// \param places_of   of a joint's point in the carrier's space, in both scenes
    template <class CarrierOf, class PlacesOf>
    void place_points(const CarrierOf& carrier_of, const PlacesOf& places_of) {
        const auto add = [&](CarriedPoints& points, std::uint32_t joint, const glm::dvec3& point) {
            const auto [exact, decoded] = places_of(joint, point);
            points.add(joint, carrier_of(joint), exact, decoded);
        };
        for (CarriedPoints* points : {&origins_, &shells_}) points->clear();
        for (const std::uint32_t joint : loose_) {
            for (const glm::dvec3& point : points_) add(origins_, joint, point);
        }
        for (std::uint32_t joint = 0; joint < shell_.size(); ++joint) {
            for (const glm::dvec3& point : shell_[joint]) add(shells_, joint, point);
        }
        for (CarriedPoints* points : {&origins_, &shells_}) points->build();
    }

    void measure(std::uint32_t clip, double seconds) {
        bool has_risen = false;
        for (std::uint32_t mesh = 0; mesh < pairs_.size(); ++mesh) {
            if (!pairs_[mesh].measure(exact_pose_, decoded_pose_, mesh, worst_)) continue;
            worst_.joint = kNone;
            has_risen = true;
        }
        has_risen = measure_points(origins_, 0.0) || has_risen;
        has_risen = measure_points(shells_, limit_) || has_risen;
        if (!has_risen) return;
        worst_.clip = clip;
        worst_.seconds = seconds;
    }

    /// Updates `worst_` if a point is above the limit and worse.
    bool measure_points(CarriedPoints& points, double limit) {
        bool has_risen = false;
        double most = std::max(limit, worst_.metres);
        points.visit_farther(exact_pose_, decoded_pose_, most, [&](std::uint32_t joint, double metres) {
            most = worst_.metres = or_infinite(metres);
            worst_.mesh = worst_.vertex = kNone;
            worst_.joint = joint;
            has_risen = true;
        });
        return has_risen;
    }

    const Scene& exact_;
    const Scene& decoded_;
    std::shared_ptr<const std::vector<PairPlan>> plans_;  // of all threads
    std::vector<MeshPair> pairs_;
    std::vector<std::uint32_t> loose_;
    std::vector<glm::dvec3> points_;  // per loose joint, see points_of_joints
    std::vector<bool> needed_;        // per joint: a mesh needs its place
    CarriedPoints origins_, shells_;  // of loose joints, and of `shell_`
    std::span<const std::vector<glm::dvec3>> shell_;
    double limit_;  // metres, for the shell
    std::uint32_t clip_ = kNone;
    std::optional<ClipEvaluator> exact_clip_, decoded_clip_;
    EvaluatedPose exact_pose_, decoded_pose_;
    MeasuredError worst_;
};

/// At most one per clip; fewer for large meshes with targets, since every thread has their positions.
std::size_t most_threads(const Scene& scene, std::size_t clips) {
    constexpr std::size_t kMostBytes = std::size_t{1} << 28U;
    std::size_t bytes = 1;
    for (const Mesh& mesh : scene.meshes) {
        if (!mesh.targets.empty()) bytes += 2 * sizeof(glm::dvec3) * mesh.positions.size();  // in both scenes
    }
    return std::max<std::size_t>(std::min(clips, kMostBytes / bytes), 1);
}

}  // namespace

std::vector<MeasuredError> measure_clips(const Scene& exact, const Scene& decoded, std::span<const std::uint32_t> clips,
                                         const MeasureOptions& options) {
    std::vector<MeasuredError> errors(clips.size() + 1);
    const auto impossible = [&] {
        for (MeasuredError& error : errors) error.metres = kInfinity;
        return errors;
    };
    if (exact.joints.size() != decoded.joints.size() || exact.meshes.size() != decoded.meshes.size() ||
        exact.clips.size() != decoded.clips.size())
        return impossible();
    for (std::size_t mesh = 0; mesh < exact.meshes.size(); ++mesh) {
        if (exact.meshes[mesh].targets.size() != decoded.meshes[mesh].targets.size()) return impossible();
    }
    const std::size_t threads = std::clamp<std::size_t>(options.threads, 1, most_threads(exact, clips.size()));
    Measurement measurement(exact, decoded, options);
    if (!measurement.is_possible()) return impossible();
    measurement.measure_rest();
    errors.back() = measurement.worst();

    const WorkLimits limits = find_limits(exact);
    if (!limits.can_be_measured) return impossible();
    std::vector<std::vector<double>> times;
    std::size_t total = 0;
    for (const std::uint32_t clip : clips) {
        const std::size_t between = options.only_keys ? 0 : limits.clips[clip].samples;
        times.push_back(sample_times(exact.clips[clip], decoded.clips[clip], between));
        total += times.back().size();
    }
    SharedProgress progress(options.progress, static_cast<double>(total));
    std::vector<Measurement> workers;
    workers.reserve(threads);  // large: one for each thread, and no more
    workers.push_back(std::move(measurement));
    while (workers.size() < threads) workers.push_back(workers.front());
    std::mutex guard;
    double known = std::min(std::max(options.known, errors.back().metres), options.limit);
    in_parallel(threads, clips.size(), [&](std::size_t k, std::size_t worker) {
        Measurement& own = workers[worker];
        {
            const std::lock_guard lock(guard);
            own.start_anew(clips[k], known);
        }
        constexpr std::size_t kCoarse = 64;
        std::size_t done = 0;
        for (const bool is_coarse :
             {true, false}) {  // far apart first: a large error found early lets later poses be skipped
            for (std::size_t t = 0; t < times[k].size(); ++t) {
                if ((t % kCoarse == 0) != is_coarse) continue;
                own.measure_at(times[k][t]);
                if (++done % kCoarse == 0) progress.add(kCoarse);
            }
        }
        progress.add(static_cast<double>(done % kCoarse));
        if (own.worst().clip == kNone) return;  // no worse than another pose
        errors[k] = own.worst();
        const std::lock_guard lock(guard);
        if (errors[k].metres <= options.limit) known = std::max(known, errors[k].metres);
    });
    return errors;
}

MeasuredError measure_error(const Scene& exact, const Scene& decoded, const MeasureOptions& options) {
    std::vector<std::uint32_t> clips(exact.clips.size());
    std::iota(clips.begin(), clips.end(), 0u);
    const std::vector<MeasuredError> errors = measure_clips(exact, decoded, clips, options);
    MeasuredError worst = errors.back();
    for (const MeasuredError& error : errors) {
        if (error.metres > worst.metres) worst = error;
    }
    return worst;
}

std::string quoted_name(std::string_view name, std::uint32_t number) {
    return name.empty() ? '#' + std::to_string(number) : '"' + std::string(name) + '"';
}

std::string place_of(const Scene& scene, const MeasuredError& error) {
    std::string place;
    if (error.mesh != kNone) {
        place = "mesh " + quoted_name(scene.meshes[error.mesh].name, error.mesh) + ", vertex " +
                std::to_string(error.vertex);
    } else if (error.joint != kNone) {
        place = "joint " + quoted_name(scene.joints[error.joint].name, error.joint);
    } else {
        return {};
    }
    if (error.clip == kNone) return place + ", at rest";
    std::string seconds = std::to_string(error.seconds);
    seconds.resize(seconds.size() - 3);  // milliseconds
    return place + ", clip " + quoted_name(scene.clips[error.clip].name, error.clip) + " at " + seconds + " s";
}

}  // namespace bendy::converter
