#include "measure_error.h"

#include "evaluate.h"
#include "frame_shapes.h"
#include "in_parallel.h"
#include "near_mesh.h"
#include "near_poses.h"
#include "space.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace bendy::converter {
namespace {

constexpr double kSamplesPerSecond = 240.0;
constexpr double kMostSamples = 100'800.0;  // of one clip: 7 minutes
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Influence {
    std::uint32_t entry = 0;
    double weight = 0.0;
};

struct Displacement {
    std::uint32_t vertex = 0;
    glm::dvec3 by{0.0};
};

/// A mesh made ready to be posed many times. A rigid one is one with a single bone.
class PosableMesh {
public:
    explicit PosableMesh(const Mesh& mesh)
        : base_(mesh.positions.begin(), mesh.positions.end()), positions_(base_), weights_(mesh.targets.size(), 0.0) {
        if (mesh.influences == 0) {
            joints_ = {mesh.joint};
            inverse_bind_ = {glm::dmat4(1.0)};
        } else {
            joints_ = mesh.palette.joints;
            inverse_bind_.assign(mesh.palette.inverse_bind.begin(), mesh.palette.inverse_bind.end());
        }
        first_.reserve(base_.size() + 1);
        first_.push_back(0);
        for (std::size_t vertex = 0; vertex < base_.size(); ++vertex) {
            if (mesh.influences == 0) influences_.push_back({0, 1.0});
            for (std::size_t k = 0; k < mesh.influences; ++k) {
                const std::size_t at = vertex * mesh.influences + k;
                if (mesh.weights[at] != 0.0f) influences_.push_back({mesh.bones[at], mesh.weights[at]});
            }
            first_.push_back(influences_.size());
        }
        for (const MorphTarget& target : mesh.targets) {
            std::vector<Displacement>& list = targets_.emplace_back();
            for (std::size_t vertex = 0; vertex < target.positions.size(); ++vertex) {
                const glm::dvec3 shift = shift_of(target, target.positions, mesh.positions, vertex);
                if (shift != glm::dvec3(0.0)) list.push_back({static_cast<std::uint32_t>(vertex), shift});
            }
        }
        matrices_.resize(joints_.size());
    }

    /// Takes a pose over; false if nothing has changed since the last one.
    bool set_pose(const std::vector<glm::dmat4>& joints, const std::vector<double>& weights) {
        bool has_changed = false;
        for (std::size_t entry = 0; entry < joints_.size(); ++entry) {
            const std::uint32_t joint = joints_[entry];
            const Affine matrix(joint == kNone ? inverse_bind_[entry] : joints[joint] * inverse_bind_[entry]);
            has_changed = has_changed || !(matrix == matrices_[entry]);
            matrices_[entry] = matrix;
        }
        if (weights == weights_) return has_changed;
        for (std::size_t target = 0; target < targets_.size(); ++target) {
            if (weights_[target] == 0.0) continue;
            for (const Displacement& d : targets_[target]) positions_[d.vertex] = base_[d.vertex];
        }
        weights_ = weights;
        for (std::size_t target = 0; target < targets_.size(); ++target) {
            if (weights_[target] == 0.0) continue;
            for (const Displacement& d : targets_[target]) positions_[d.vertex] += weights_[target] * d.by;
        }
        return true;
    }

    [[nodiscard]] glm::dvec3 place(std::size_t vertex) const {
        glm::dvec3 sum(0.0);
        for (const Influence& influence : influences(vertex))
            sum += influence.weight * matrices_[influence.entry](positions_[vertex]);
        return sum;
    }

    [[nodiscard]] std::size_t size() const { return base_.size(); }
    [[nodiscard]] const std::vector<std::uint32_t>& joints() const { return joints_; }
    [[nodiscard]] const std::vector<Affine>& matrices() const { return matrices_; }
    [[nodiscard]] const glm::dvec3& base(std::size_t vertex) const { return base_[vertex]; }
    [[nodiscard]] std::span<const Influence> influences(std::size_t vertex) const {
        return std::span(influences_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
    }
    [[nodiscard]] bool is_displaced() const {
        return std::any_of(weights_.begin(), weights_.end(), [](double weight) { return weight != 0.0; });
    }
    void mark_touched(std::vector<bool>& touched) const {
        for (const auto& target : targets_) {
            for (const Displacement& d : target) touched[d.vertex] = true;
        }
    }

private:
    std::vector<std::uint32_t> joints_;
    std::vector<glm::dmat4> inverse_bind_;
    std::vector<Affine> matrices_;
    std::vector<glm::dvec3> base_, positions_;
    std::vector<std::size_t> first_;
    std::vector<Influence> influences_;
    std::vector<std::vector<Displacement>> targets_;
    std::vector<double> weights_;
};

/// What is no number is larger than any.
double or_infinite(double value) {
    if (std::isnan(value)) return kInfinity;
    return value;
}

/// Makes `most` the larger of the two.
void raise(double& most, double value) {
    if (!(value <= most)) most = or_infinite(value);
}

/// At least the largest factor by which the matrix stretches a vector.
double stretch_of(const glm::dmat3& m) {
    double largest = 0.0;  // of the sums of rows of its transpose times itself, whose eigenvalues are squared stretches
    for (int row = 0; row < 3; ++row) {
        double sum = 0.0;
        for (int column = 0; column < 3; ++column) sum += std::abs(glm::dot(m[row], m[column]));
        raise(largest, sum);
    }
    return std::sqrt(largest);
}

/// A mesh in both scenes. With P and Q the bones' matrices, p and p' the places, w and w' the weights of the exact and
/// of the decoded one, a vertex is displaced by
///     sum w P p - sum w' Q p' = sum w (P - Q) p + sum (w - w') (Q p - c) + sum (w - w') c + sum w' Q (p - p')
/// for any c; each of the four is bounded by what is known of the vertex and, once a pose, of the bones.
class MeshPair {
public:
    MeshPair(const Mesh& exact, const Mesh& decoded, const std::vector<std::uint32_t>* map)
        : exact_(exact), decoded_(decoded), map_(map) {
        touched_.resize(exact_.size());
        std::vector<bool> touched_there(decoded_.size());
        exact_.mark_touched(touched_);
        decoded_.mark_touched(touched_there);
        for (std::size_t vertex = 0; vertex < exact_.size(); ++vertex) {
            const std::uint32_t there = place_in_decoded(vertex);
            if (there != kNone && touched_there[there]) touched_[vertex] = true;
        }
        has_bounds_ = exact_.joints() == decoded_.joints();
        if (has_bounds_) prepare_bounds();
    }

    /// Raises `worst` to the worst vertex of a pose, if that is worse, and says so.
    bool measure(const EvaluatedPose& exact_pose, const EvaluatedPose& decoded_pose, std::uint32_t mesh,
                 MeasuredError& worst) {
        const bool moved_here = exact_.set_pose(exact_pose.joints, exact_pose.morph_weights[mesh]);
        const bool moved_there = decoded_.set_pose(decoded_pose.joints, decoded_pose.morph_weights[mesh]);
        if (!moved_here && !moved_there && is_measured_) return false;
        is_measured_ = true;
        const bool is_displaced = exact_.is_displaced() || decoded_.is_displaced();
        if (has_bounds_) {
            bound_bones();
            if (!is_displaced && bound(worst_case_, largest_difference_) <= worst.metres) return false;
        }
        bool has_risen = false;
        for (std::size_t vertex = 0; vertex < exact_.size(); ++vertex) {
            const std::uint32_t there = place_in_decoded(vertex);
            if (there == kNone) continue;
            if (has_bounds_ && !(is_displaced && touched_[vertex]) && bound_of(vertex) <= worst.metres) continue;
            const double error = glm::distance(exact_.place(vertex), decoded_.place(there));
            if (error <= worst.metres) continue;
            worst.metres = or_infinite(error);
            worst.mesh = mesh;
            worst.vertex = static_cast<std::uint32_t>(vertex);
            has_risen = true;
        }
        return has_risen;
    }

    [[nodiscard]] bool can_be_compared() const {
        if (map_ == nullptr) return exact_.size() == decoded_.size();
        return map_->size() == exact_.size() && std::all_of(map_->begin(), map_->end(), [&](std::uint32_t vertex) {
                   return vertex == kNone || vertex < decoded_.size();
               });
    }

private:
    /// How far a vertex's data in the two scenes are apart.
    struct Difference {
        double place = 0.0;          // metres, in mesh space
        double weights = 0.0;        // sum of |w - w'|
        double weight_sum = 0.0;     // |sum of w - w'|
        double exact_total = 0.0;    // sum of w
        double decoded_total = 0.0;  // sum of w'
    };

    [[nodiscard]] std::uint32_t place_in_decoded(std::size_t vertex) const {
        if (map_ != nullptr)
            return vertex < map_->size() && (*map_)[vertex] < decoded_.size() ? (*map_)[vertex] : kNone;
        return vertex < decoded_.size() ? static_cast<std::uint32_t>(vertex) : kNone;
    }

    void prepare_bounds() {
        boxes_.resize(exact_.joints().size());
        differences_.resize(exact_.size());
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
            raise(worst_case_.place, d.place);
            raise(worst_case_.weights, d.weights);
            raise(worst_case_.weight_sum, d.weight_sum);
            raise(worst_case_.exact_total, d.exact_total);
            raise(worst_case_.decoded_total, d.decoded_total);
        }
        bone_differences_.resize(boxes_.size());
    }

    /// What the bones' matrices add to the bounds in this pose.
    void bound_bones() {
        stretch_ = 0.0;
        largest_difference_ = 0.0;
        spread_ = 0.0;
        centre_ = glm::dvec3(0.0);
        const auto first =
            std::find_if(boxes_.begin(), boxes_.end(), [](const Box<glm::dvec3>& box) { return !box.is_empty(); });
        if (first == boxes_.end()) return;
        centre_ =
            decoded_.matrices()[static_cast<std::size_t>(first - boxes_.begin())]((first->low + first->high) * 0.5);
        for (std::size_t bone = 0; bone < boxes_.size(); ++bone) {
            if (boxes_[bone].is_empty()) continue;
            const Affine& p = exact_.matrices()[bone];
            const Affine& q = decoded_.matrices()[bone];
            raise(stretch_, stretch_of(q.linear));
            double largest = 0.0;
            // Distances are convex: over a box they are largest at a corner.
            for (const glm::dvec3& corner : boxes_[bone].corners()) {
                const glm::dvec3 there = q(corner);
                raise(largest, glm::distance(p(corner), there));
                raise(spread_, glm::distance(there, centre_));
            }
            bone_differences_[bone] = largest;
            raise(largest_difference_, largest);
        }
    }

    [[nodiscard]] double bound(const Difference& d, double bone_difference) const {
        constexpr double kRounding = 1.0 + 1e-9;
        return kRounding * (d.exact_total * bone_difference + d.decoded_total * stretch_ * d.place +
                            d.weights * spread_ + d.weight_sum * glm::length(centre_));
    }

    [[nodiscard]] double bound_of(std::size_t vertex) const {
        double bone_difference = 0.0;
        for (const Influence& influence : exact_.influences(vertex))
            raise(bone_difference, bone_differences_[influence.entry]);
        return bound(differences_[vertex], bone_difference);
    }

    PosableMesh exact_, decoded_;
    const std::vector<std::uint32_t>* map_;
    std::vector<bool> touched_;  // by a target of either scene
    bool is_measured_ = false;
    bool has_bounds_ = false;
    std::vector<Difference> differences_;
    Difference worst_case_;
    std::vector<Box<glm::dvec3>> boxes_;  // of each bone: the vertices that it moves, in mesh space
    std::vector<double> bone_differences_;
    double largest_difference_ = 0.0;
    double stretch_ = 0.0;
    double spread_ = 0.0;  // metres from the centre, of what the bones move
    glm::dvec3 centre_{0.0};
};

/// Joints that no vertex hangs on.
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

/// Per mesh: targets may displace it in a clip. Frames of PLAY are targets, too.
std::vector<bool> displaced_meshes(const Scene& scene, const Clip& clip) {
    std::vector<bool> displaced;
    for (const Mesh& mesh : scene.meshes) {
        displaced.push_back(std::any_of(mesh.targets.begin(), mesh.targets.end(),
                                        [](const MorphTarget& target) { return target.rest_weight != 0.0f; }));
    }
    for (const Track& track : clip.tracks) {
        if (track.path == TrackPath::weights) displaced[track.target] = true;
    }
    for (const Play& play : clip.plays) displaced[play.mesh] = true;
    return displaced;
}

/// Points of a joint, in its own space, that show how it moves: its origin and, where the scene has no vertex at all
/// that would show how it turns and stretches, one on each axis.
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

std::vector<double> sample_times(const Clip& exact, const Clip& decoded) {
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
    if (times.empty()) return times;
    const double start = times.front();
    const double length = times.back() - start;
    const double steps = std::min(std::ceil(length * kSamplesPerSecond), kMostSamples);
    const double step = steps < kMostSamples ? 1.0 / kSamplesPerSecond : length / steps;
    for (unsigned k = 1; k < steps; ++k) times.push_back(start + k * step);
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

class Comparison {
public:
    Comparison(const Scene& exact, const Scene& decoded, VertexMaps maps) : exact_(exact), decoded_(decoded) {
        pairs_.reserve(exact.meshes.size());
        for (std::size_t mesh = 0; mesh < exact.meshes.size(); ++mesh) {
            const bool is_mapped = mesh < maps.size() && !maps[mesh].empty();
            pairs_.emplace_back(exact.meshes[mesh], decoded.meshes[mesh], is_mapped ? &maps[mesh] : nullptr);
            near_meshes_.emplace_back(exact.meshes[mesh], decoded.meshes[mesh], is_mapped ? &maps[mesh] : nullptr);
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

    void measure_at(std::uint32_t clip, double seconds) {
        if (!may_be_worse(clip, seconds)) return;
        evaluate(exact_, exact_.clips[clip], seconds, exact_pose_);
        evaluate(decoded_, decoded_.clips[clip], seconds, decoded_pose_);
        measure(clip, seconds);
    }

    [[nodiscard]] const MeasuredError& worst() const { return worst_; }
    void take_worst(const MeasuredError& worst) { worst_ = worst; }

private:
    /// False if nothing is farther off than the worst: places that are nearly right leave no doubt.
    bool may_be_worse(std::uint32_t clip, double seconds) {
        if (clip != near_clip_) {
            near_clip_ = clip;
            near_exact_.emplace(exact_, exact_.clips[clip], NearPoses::Rotations::as_they_are);
            near_decoded_.emplace(decoded_, decoded_.clips[clip], NearPoses::Rotations::as_they_are);
            is_displaced_ = displaced_meshes(exact_, exact_.clips[clip]);
            const std::vector<bool> there = displaced_meshes(decoded_, decoded_.clips[clip]);
            for (std::size_t mesh = 0; mesh < there.size(); ++mesh)
                is_displaced_[mesh] = is_displaced_[mesh] || there[mesh];
        }
        if (std::find(is_displaced_.begin(), is_displaced_.end(), true) != is_displaced_.end()) return true;
        near_exact_->set(seconds);
        near_decoded_->set(seconds);
        for (NearMesh& mesh : near_meshes_) {
            if (mesh.may_be_farther(*near_exact_, *near_decoded_, worst_.metres)) return true;
        }
        return std::any_of(loose_.begin(), loose_.end(), [&](std::uint32_t joint) {
            const Affine& here = near_exact_->places()[joint];
            const Affine& there = near_decoded_->places()[joint];
            const Doubt& doubt = near_exact_->doubts()[joint];
            const Doubt& doubt_there = near_decoded_->doubts()[joint];
            return std::any_of(points_.begin(), points_.end(), [&](const glm::dvec3& point) {
                const double open =
                    (doubt.linear + doubt_there.linear) * glm::length(point) + doubt.origin + doubt_there.origin;
                return !(glm::distance(here(point), there(point)) + open <= worst_.metres);
            });
        });
    }

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
        if (!has_risen) return;
        worst_.clip = clip;
        worst_.seconds = seconds;
    }

    const Scene& exact_;
    const Scene& decoded_;
    std::vector<MeshPair> pairs_;
    std::vector<NearMesh> near_meshes_;
    std::uint32_t near_clip_ = kNone;
    std::optional<NearPoses> near_exact_, near_decoded_;  // of this clip
    std::vector<bool> is_displaced_;                      // by targets, at any time of this clip
    std::vector<std::uint32_t> loose_;
    std::vector<glm::dvec3> points_;  // of each of these, see points_of_joints
    EvaluatedPose exact_pose_, decoded_pose_;
    MeasuredError worst_;
};

struct Moment {
    std::uint32_t clip = 0;
    double seconds = 0.0;
};

/// The first of those that are worst, whatever the number of threads: each measures a part in order, and a later part
/// counts only where it is worse.
void measure_moments(Comparison& comparison, std::span<const Moment> moments, std::size_t threads,
                     SharedProgress& progress) {
    constexpr std::size_t kTold = 256;  // moments at a time
    const std::size_t parts = std::max<std::size_t>(std::min(threads, moments.size()), 1);
    std::vector<Comparison> others(parts - 1, comparison);
    in_parallel(parts, parts, [&](std::size_t part) {
        Comparison& own = part == 0 ? comparison : others[part - 1];
        const std::size_t first = part * moments.size() / parts;
        const std::size_t end = (part + 1) * moments.size() / parts;
        for (std::size_t k = first; k < end; ++k) {
            own.measure_at(moments[k].clip, moments[k].seconds);
            if ((k + 1 - first) % kTold == 0) progress.add(kTold);
        }
        if ((end - first) % kTold != 0) progress.add(static_cast<double>((end - first) % kTold));
    });
    for (const Comparison& other : others) {
        if (other.worst().metres > comparison.worst().metres) comparison.take_worst(other.worst());
    }
}

}  // namespace

MeasuredError measure_error(const Scene& exact, const Scene& decoded, VertexMaps vertex_maps,
                            const std::function<void(double)>& progress, std::size_t threads) {
    MeasuredError impossible;
    impossible.metres = kInfinity;
    if (exact.joints.size() != decoded.joints.size() || exact.meshes.size() != decoded.meshes.size() ||
        exact.clips.size() != decoded.clips.size())
        return impossible;
    for (std::size_t mesh = 0; mesh < exact.meshes.size(); ++mesh) {
        if (exact.meshes[mesh].targets.size() != decoded.meshes[mesh].targets.size()) return impossible;
    }
    Comparison comparison(exact, decoded, vertex_maps);
    if (!comparison.is_possible()) return impossible;
    comparison.measure_rest();

    // Far apart first: what is found early spares the work of what is less.
    constexpr std::size_t kCoarse = 64;
    std::vector<Moment> coarse;
    std::vector<Moment> fine;
    for (std::uint32_t clip = 0; clip < exact.clips.size(); ++clip) {
        const std::vector<double> times = sample_times(exact.clips[clip], decoded.clips[clip]);
        for (std::size_t k = 0; k < times.size(); ++k) (k % kCoarse == 0 ? coarse : fine).push_back({clip, times[k]});
    }
    SharedProgress shared(progress, static_cast<double>(coarse.size() + fine.size()));
    for (const auto& moments : {std::span(coarse), std::span(fine)})
        measure_moments(comparison, moments, std::max<std::size_t>(threads, 1), shared);
    return comparison.worst();
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
