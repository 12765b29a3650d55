#include "optimise/measure_error.h"

#include "optimise/posable_mesh.h"
#include "optimise/sample_limits.h"
#include "scene/evaluate.h"
#include "scene/frame_shapes.h"
#include "scene/in_parallel.h"
#include "scene/space.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>

namespace bendy::converter {
namespace {

constexpr double kMostSamples = 100'800.0;  // of one clip: 7 minutes
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
/// that a bound passes over many of them.
class MeshPair {
public:
    MeshPair(const Mesh& exact, const Mesh& decoded, const std::vector<std::uint32_t>* map)
        : exact_(exact, used_entries(exact, decoded)), decoded_(decoded, used_entries(decoded, exact)), map_(map) {
        touched_.resize(exact_.size());
        std::vector<bool> touched_there(decoded_.size());
        exact_.mark_touched(touched_);
        decoded_.mark_touched(touched_there);
        for (std::size_t vertex = 0; vertex < exact_.size(); ++vertex) {
            const std::uint32_t there = place_in_decoded(vertex);
            if (there != kNone && touched_there[there]) touched_[vertex] = true;
        }
        has_bounds_ = exact_.joints() == decoded_.joints();
        differences_.resize(exact_.size());
        if (has_bounds_) find_differences();
        find_nodes();
    }

    /// Updates `worst` if a vertex of this pose is worse; returns whether it did.
    bool measure(const EvaluatedPose& exact_pose, const EvaluatedPose& decoded_pose, std::uint32_t mesh,
                 MeasuredError& worst) {
        const bool moved_here = exact_.set_pose(exact_pose.joints, exact_pose.morph_weights[mesh]);
        const bool moved_there = decoded_.set_pose(decoded_pose.joints, decoded_pose.morph_weights[mesh]);
        if (!moved_here && !moved_there && is_measured_) return false;
        is_measured_ = true;
        const bool is_displaced = exact_.is_displaced() || decoded_.is_displaced();
        if (has_bounds_) bound_bones();
        bool has_risen = false;
        const auto look_at = [&](std::uint32_t vertex) {
            const double error = glm::distance(exact_.place(vertex), decoded_.place(place_in_decoded(vertex)));
            if (error <= worst.metres) return;
            worst.metres = or_infinite(error);
            worst.mesh = mesh;
            worst.vertex = vertex;
            has_risen = true;
        };
        for (std::size_t number = 0; number < nodes_.size();) {
            const Node& node = nodes_[number++];
            const bool has_bounds = has_bounds_ && !(is_displaced && node.is_touched);
            PoseBound bones;
            if (has_bounds) {
                bones = bound_of(node);
                if (bound(node.worst_case, bones) <= worst.metres) {
                    number = node.end;
                    continue;
                }
            }
            for (std::uint32_t at = node.first; at < node.first + node.count; ++at) {
                const std::uint32_t vertex = vertices_[at];
                if (!has_bounds || !(bound(differences_[vertex], bones) <= worst.metres)) look_at(vertex);
            }
        }
        return has_risen;
    }

    /// Forces the next pose to be measured, even if it equals the last one.
    void forget_pose() { is_measured_ = false; }

    [[nodiscard]] bool can_be_compared() const {
        if (map_ == nullptr) return exact_.size() == decoded_.size();
        return map_->size() == exact_.size() && std::all_of(map_->begin(), map_->end(), [&](std::uint32_t vertex) {
                   return vertex == kNone || vertex < decoded_.size();
               });
    }

private:
    /// The palette entries that a mesh uses, or that the other mesh uses if both have the same palette.
    static std::vector<bool> used_entries(const Mesh& mesh, const Mesh& other) {
        std::vector<bool> used;
        mark_used(mesh, used);
        if (other.palette.joints == mesh.palette.joints) mark_used(other, used);
        return used;
    }

    /// How much a vertex's data differ between the two scenes.
    struct Difference {
        double place = 0.0;          // metres, in mesh space
        double weights = 0.0;        // sum of |w - w'|
        double weight_sum = 0.0;     // |sum of w - w'|
        double exact_total = 0.0;    // sum of w
        double decoded_total = 0.0;  // sum of w'
    };

    static void raise(Difference& most, const Difference& d) {
        raise(most.place, d.place);
        raise(most.weights, d.weights);
        raise(most.weight_sum, d.weight_sum);
        raise(most.exact_total, d.exact_total);
        raise(most.decoded_total, d.decoded_total);
    }
    static void raise(double& most, double value) { converter::raise(most, value); }

    /// Vertices that the same bones move, in a box; its parts follow it.
    struct Node {
        std::uint32_t entries = 0;           // number of the list of palette entries
        std::uint32_t first = 0, count = 0;  // of a box without parts: its vertices
        std::uint32_t end = 0;               // index of the first node after its parts
        glm::dvec3 middle{0.0};              // in mesh space
        glm::dvec3 half{0.0};                // from the middle to a corner
        Difference worst_case;
        bool is_touched = false;  // some target displaces them
    };
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

    [[nodiscard]] std::uint32_t place_in_decoded(std::size_t vertex) const {
        if (map_ != nullptr)
            return vertex < map_->size() && (*map_)[vertex] < decoded_.size() ? (*map_)[vertex] : kNone;
        return vertex < decoded_.size() ? static_cast<std::uint32_t>(vertex) : kNone;
    }

    void find_nodes() {
        std::map<std::pair<bool, std::vector<std::uint32_t>>, std::vector<std::uint32_t>> groups;
        auto last = groups.end();  // neighbours often are in the same group
        std::pair<bool, std::vector<std::uint32_t>> key;
        for (std::uint32_t vertex = 0; vertex < exact_.size(); ++vertex) {
            const std::uint32_t there = place_in_decoded(vertex);
            if (there == kNone) continue;
            key.first = touched_[vertex];
            key.second.clear();
            for (const Influence& influence : exact_.influences(vertex)) key.second.push_back(influence.entry);
            for (const Influence& influence : decoded_.influences(there)) key.second.push_back(influence.entry);
            std::sort(key.second.begin(), key.second.end());
            key.second.erase(std::unique(key.second.begin(), key.second.end()), key.second.end());
            if (last == groups.end() || last->first != key) last = groups.try_emplace(key).first;
            last->second.push_back(vertex);
        }
        for (auto& [bones, vertices] : groups) {
            entries_.push_back(bones.second);
            add_nodes(vertices, bones.first);
        }
    }

    /// Splits the vertices across their longest side, until each box has few.
    void add_nodes(std::span<std::uint32_t> all, bool is_touched) {
        constexpr std::size_t kMost = 8;
        struct Open {
            std::span<std::uint32_t> vertices;
            std::size_t closes = 0;  // the node that ends here; vertices are empty
        };
        std::vector<Open> open{{all, 0}};
        while (!open.empty()) {
            const auto [vertices, closes] = open.back();
            open.pop_back();
            if (vertices.empty()) {
                nodes_[closes].end = static_cast<std::uint32_t>(nodes_.size());
                continue;
            }
            Box<glm::dvec3> box;
            for (const std::uint32_t vertex : vertices) box.add(exact_.base(vertex));
            const glm::dvec3 size = box.high - box.low;
            const int larger = size.y > size.x ? 1 : 0;
            const int axis = size.z > size[larger] ? 2 : larger;
            Node& node = nodes_.emplace_back();
            node.entries = static_cast<std::uint32_t>(entries_.size() - 1);
            node.middle = 0.5 * (box.low + box.high);
            node.half = 0.5 * size;
            node.is_touched = is_touched;
            node.end = static_cast<std::uint32_t>(nodes_.size());
            for (const std::uint32_t vertex : vertices) raise(node.worst_case, differences_[vertex]);
            if (vertices.size() <= kMost || !(size[axis] > 0.0)) {
                std::sort(vertices.begin(), vertices.end());  // nth_element's order differs between libraries
                node.first = static_cast<std::uint32_t>(vertices_.size());
                node.count = static_cast<std::uint32_t>(vertices.size());
                vertices_.insert(vertices_.end(), vertices.begin(), vertices.end());
                continue;
            }
            const std::size_t half = vertices.size() / 2;
            std::nth_element(vertices.begin(), vertices.begin() + static_cast<std::ptrdiff_t>(half), vertices.end(),
                             [&](std::uint32_t a, std::uint32_t b) {
                                 return std::pair(or_infinite(exact_.base(a)[axis]), a) <
                                        std::pair(or_infinite(exact_.base(b)[axis]), b);
                             });
            open.push_back({{}, nodes_.size() - 1});
            open.push_back({vertices.subspan(half), 0});
            open.push_back({vertices.first(half), 0});
        }
    }

    void find_differences() {
        boxes_.resize(exact_.joints().size());
        bones_.resize(boxes_.size());
        std::vector<double> change(boxes_.size(), 0.0);
        for (std::size_t vertex = 0; vertex < exact_.size(); ++vertex) {
            const std::uint32_t there = place_in_decoded(vertex);
            if (there == kNone) continue;
            Difference& d = differences_[vertex];
            d.place = glm::distance(exact_.base(vertex), decoded_.base(there));
            for (const Influence& influence : exact_.influences(vertex)) {
                change[influence.entry] += influence.weight;
                d.exact_total += influence.weight;
                boxes_[influence.entry].add(exact_.base(vertex));
            }
            for (const Influence& influence : decoded_.influences(there)) {
                change[influence.entry] -= influence.weight;
                d.decoded_total += influence.weight;
                boxes_[influence.entry].add(exact_.base(vertex));
            }
            for (const auto& list : {exact_.influences(vertex), decoded_.influences(there)}) {
                for (const Influence& influence : list) {
                    d.weights += std::abs(change[influence.entry]);
                    change[influence.entry] = 0.0;
                }
            }
            d.weight_sum = std::abs(d.exact_total - d.decoded_total);
        }
    }

    /// Computes the bones' part of the bounds for this pose.
    void bound_bones() {
        for (std::size_t number = 0; number < boxes_.size(); ++number) {
            const Box<glm::dvec3>& box = boxes_[number];
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
    [[nodiscard]] PoseBound bound_of(const Node& node) const {
        PoseBound most;
        const std::vector<std::uint32_t>& entries = entries_[node.entries];
        for (const std::uint32_t entry : entries) {
            const Bone& bone = bones_[entry];
            raise(most.difference, glm::length(bone.difference(node.middle)) + glm::dot(bone.lengths, node.half));
            raise(most.stretch, bone.stretch);
            raise(most.distance, bone.distance);
        }
        if (!(node.worst_case.weights > 0.0) || entries.empty()) return most;
        const Affine& first = decoded_.matrices()[entries[0]];
        const glm::dvec3 place = first(node.middle);
        for (std::size_t k = 1; k < entries.size(); ++k) {
            const Affine& other = decoded_.matrices()[entries[k]];
            raise(most.spread, glm::distance(other(node.middle), place) +
                                   glm::dot(lengths_of(other.linear - first.linear), node.half));
        }
        return most;
    }

    [[nodiscard]] static double bound(const Difference& d, const PoseBound& bones) {
        constexpr double kRounding = 1.0 + 1e-9;
        return kRounding * (d.exact_total * bones.difference + d.decoded_total * bones.stretch * d.place +
                            d.weights * bones.spread + d.weight_sum * bones.distance);
    }

    PosableMesh exact_, decoded_;
    const std::vector<std::uint32_t>* map_;
    std::vector<bool> touched_;  // by a target of either scene
    bool is_measured_ = false;
    bool has_bounds_ = false;
    std::vector<std::vector<std::uint32_t>> entries_;  // lists of palette entries, ascending
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> vertices_;  // those that are compared, node by node
    std::vector<Difference> differences_;  // per vertex
    std::vector<Box<glm::dvec3>> boxes_;   // per bone: bounds of the vertices that it moves, in mesh space
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
    const double most = std::min(kMostSamples, static_cast<double>(limit));
    const double steps = std::min(std::ceil(length * kSamplesPerSecond), most);
    const double step = steps < most ? 1.0 / kSamplesPerSecond : length / steps;
    for (unsigned k = 1; k < steps; ++k) times.push_back(start + k * step);
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

class Comparison {
public:
    Comparison(const Scene& exact, const Scene& decoded, const MeasureOptions& options)
        : exact_(exact), decoded_(decoded), shell_(options.shell), limit_(options.limit) {
        const VertexMaps maps = options.vertex_maps;
        pairs_.reserve(exact.meshes.size());
        for (std::size_t mesh = 0; mesh < exact.meshes.size(); ++mesh) {
            const bool is_mapped = mesh < maps.size() && !maps[mesh].empty();
            pairs_.emplace_back(exact.meshes[mesh], decoded.meshes[mesh], is_mapped ? &maps[mesh] : nullptr);
        }
        loose_ = loose_joints(exact);
        points_ = points_of_joints(exact);
    }

    [[nodiscard]] bool is_possible() const {
        return std::all_of(pairs_.begin(), pairs_.end(), [](const MeshPair& pair) { return pair.can_be_compared(); });
    }

    void measure_rest() {
        evaluate_rest(exact_, exact_pose_);
        evaluate_rest(decoded_, decoded_pose_);
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
    }

private:
    void measure(std::uint32_t clip, double seconds) {
        bool has_risen = false;
        for (std::uint32_t mesh = 0; mesh < pairs_.size(); ++mesh) {
            if (!pairs_[mesh].measure(exact_pose_, decoded_pose_, mesh, worst_)) continue;
            worst_.joint = kNone;
            has_risen = true;
        }
        for (const std::uint32_t joint : loose_) {
            const glm::dmat4 difference = exact_pose_.joints[joint] - decoded_pose_.joints[joint];
            double error = 0.0;
            for (const glm::dvec3& point : points_)
                raise(error, glm::length(glm::dvec3(difference * glm::dvec4(point, 1.0))));
            if (error <= worst_.metres) continue;
            worst_.metres = or_infinite(error);
            worst_.mesh = worst_.vertex = kNone;
            worst_.joint = joint;
            has_risen = true;
        }
        if (measure_shell()) has_risen = true;
        if (!has_risen) return;
        worst_.clip = clip;
        worst_.seconds = seconds;
    }

    /// Updates `worst_` if a point of the shell is above the limit and worse.
    bool measure_shell() {
        bool has_risen = false;
        const double most = std::max(limit_, worst_.metres);
        for (std::uint32_t joint = 0; joint < shell_.size(); ++joint) {
            const glm::dmat4 difference = exact_pose_.joints[joint] - decoded_pose_.joints[joint];
            const double turned = glm::length(difference[0]) + glm::length(difference[1]) + glm::length(difference[2]);
            const double origin = glm::length(glm::dvec3(difference[3]));
            for (const glm::dvec3& point : shell_[joint]) {
                // Each coordinate is at most the point's length.
                if (origin + turned * glm::length(point) <= most) continue;
                const double error = or_infinite(glm::length(glm::dvec3(difference * glm::dvec4(point, 1.0))));
                if (error <= std::max(limit_, worst_.metres)) continue;
                worst_.metres = error;
                worst_.mesh = worst_.vertex = kNone;
                worst_.joint = joint;
                has_risen = true;
            }
        }
        return has_risen;
    }

    const Scene& exact_;
    const Scene& decoded_;
    std::vector<MeshPair> pairs_;
    std::vector<std::uint32_t> loose_;
    std::vector<glm::dvec3> points_;  // per loose joint, see points_of_joints
    std::span<const std::vector<glm::dvec3>> shell_;
    double limit_;  // metres, for the shell
    std::uint32_t clip_ = kNone;
    std::optional<ClipEvaluator> exact_clip_, decoded_clip_;
    EvaluatedPose exact_pose_, decoded_pose_;
    MeasuredError worst_;
};

/// At most one per clip; fewer for large meshes, since every thread copies them.
std::size_t most_threads(const Scene& scene, std::size_t clips) {
    constexpr std::size_t kMostBytes = std::size_t{1} << 30U;
    constexpr std::size_t kVertexBytes = 512;  // in both scenes, roughly
    constexpr std::size_t kShiftBytes = 64;    // per vertex that a target displaces
    std::size_t bytes = 1;
    for (const Mesh& mesh : scene.meshes)
        bytes += mesh.positions.size() * (kVertexBytes + kShiftBytes * mesh.targets.size());
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
    Comparison comparison(exact, decoded, options);
    if (!comparison.is_possible()) return impossible();
    comparison.measure_rest();
    errors.back() = comparison.worst();

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
    std::vector<Comparison> workers;
    workers.reserve(threads);  // large: one for each thread, and no more
    workers.push_back(std::move(comparison));
    while (workers.size() < threads) workers.push_back(workers.front());
    std::mutex guard;
    double known = std::min(std::max(options.known, errors.back().metres), options.limit);
    in_parallel(threads, clips.size(), [&](std::size_t k, std::size_t worker) {
        Comparison& own = workers[worker];
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
