#include <bendy/runtime/body_reach.h>

#include "damped_step.h"
#include "ik_problem.h"
#include "math/rigid_part.h"
#include "math/rotation.h"
#include "pose/pose_state.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace bendy {

/// A joint between the root and an effector. Lengths are in sizes of the body, rotations and positions in model space.
struct BodyLink : IkLink {
    std::uint32_t parent = kNone;  ///< among the links
    std::uint32_t effectors = 0;   ///< a bit for each that it moves
    std::size_t group = 0;
    glm::dvec3 offset{0.0};  ///< from the parent, in its orientation
    glm::dvec3 force{0.0};   ///< the sum over its effectors
    glm::dvec3 torque{0.0};  ///< about model space's origin
};

/// Links that move the same effectors, and sums over them, with positions p relative to the root's.
struct BodyGroup {
    std::uint32_t effectors = 0;
    glm::dmat3 turns{0.0};   ///< of mobility
    glm::dmat3 first{0.0};   ///< of mobility [p]x
    glm::dmat3 second{0.0};  ///< of [p]x mobility [p]x
};

/// An effector, in the same units.
struct BodyTip {
    std::uint32_t link = 0;
    glm::dvec3 in_joint{0.0};  ///< metres
    glm::dvec3 offset{0.0};    ///< from the link, in its orientation
    glm::dvec3 place{0.0};
    glm::dvec3 target{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< of the target
    double weight = 0.0, rotation_weight = 0.0;
    std::size_t row = 0, rotation_row = 0;  ///< of the unknowns; if they have a weight
};

struct BodyReachPlan {
    explicit BodyReachPlan(Model of) : model(std::move(of)) {}
    static BodyReachPlan& of(BodyReach& body) { return *body.plan_; }
    static Result<BodyReach, CallError> make(const Model& model, std::span<const Effector> effectors,
                                             const BodyReachOptions& options);

    /// Adds the links from the root to the effectors.
    void add_links(std::uint32_t root, std::span<const Effector> effectors);

    Model model;
    BodyReachOptions options;
    std::vector<BodyLink> links;  ///< parents come first
    std::vector<BodyTip> tips;
    std::vector<BodyGroup> groups;
    std::vector<double> A, y;  ///< work memory: a row for each unknown, of six for each effector
};

namespace {

/// Weight of shifting the root relative to turning a joint by a radian: the whole body moves only if turns do not do.
constexpr double kRootFreedom = 0.25;

double weight_of(float weight) {
    return weight > 0.0f ? std::min(double{weight}, 1.0) : 0.0;
}

double square(double x) {
    return x * x;
}

/// One call of reach.
class ReachingBody {
public:
    ReachingBody(BodyReachPlan& plan, Pose& pose)
        : plan_(plan), state_(PoseState::of(pose)), links_(plan.links), tips_(plan.tips) {}

    Result<BodyReached, CallError> run(std::span<const EffectorTarget> targets) {
        if (!read_targets(targets) || !gather()) return CallError::not_finite;
        std::uint32_t iterations = 0;
        constexpr int kCorrections = 16;  // of bones that change length as they turn
        for (int k = 0; k < kCorrections; ++k) {
            iterations += solve();
            const bool seems_reached = is_reached();
            scatter();
            gather_places();
            if (is_reached() || !seems_reached) break;
        }
        return measure(iterations);
    }

    // The problem of descend_damped.
    [[nodiscard]] bool is_reached() const {
        return std::all_of(tips_.begin(), tips_.end(), [&](const BodyTip& tip) { return is_there(tip); });
    }
    [[nodiscard]] double cost() const {
        double sum = 0.0;
        for (const BodyTip& tip : tips_) {
            const glm::dvec3 left = tip.target - tip.place;
            sum += tip.weight * glm::dot(left, left);
            if (tip.rotation_weight > 0.0) sum += tip.rotation_weight * square(angle_left(tip));
        }
        return sum;
    }
    [[nodiscard]] Measured measure() const {
        Measured now = measured(links_, cost());
        now.turns += glm::dot(shift_, shift_) / kRootFreedom;
        return now;
    }
    void take_step(double spring, double damping) {
        gather_errors();
        sum_forces();
        open_ways(spring);
        gather_matrix();
        solve_damped(plan_.A.data(), stride_, rows_, damping, plan_.y.data());
        apply();
    }
    void take_back_step() {
        for (BodyLink& link : links_) bendy::take_back_step(link);
        shift_ = shift_before_;
        place();
    }

private:
    /// Returns false if a number is not finite.
    bool read_targets(std::span<const EffectorTarget> targets) {
        rows_ = 0;
        double sum = 0.0;
        for (std::size_t k = 0; k < tips_.size(); ++k) {
            BodyTip& tip = tips_[k];
            const EffectorTarget& target = targets[k];
            tip.target = glm::dvec3(target.position);
            tip.weight = weight_of(target.weight);
            tip.rotation_weight = target.rotation ? weight_of(target.rotation_weight) : 0.0;
            sum += tip.target.x + tip.target.y + tip.target.z + double{target.weight};
            if (tip.weight > 0.0) tip.row = std::exchange(rows_, rows_ + 3);
            if (!target.rotation) continue;
            tip.rotation = glm::dquat(*target.rotation);
            if (!(std::abs(glm::length(tip.rotation) - 1.0) < 1e-2)) return false;
            tip.rotation = glm::normalize(tip.rotation);
            sum += double{target.rotation_weight};
            if (tip.rotation_weight > 0.0) tip.rotation_row = std::exchange(rows_, rows_ + 3);
        }
        return std::isfinite(sum);
    }

    /// Fills the links and tips from the pose. Returns false if a number is not finite.
    bool gather() {
        base_ = rigid_rotation(state_.fresh_matrix(plan_.model.parents()[links_[0].joint]));
        gather_places();
        double longest = 0.0;
        for (const BodyTip& tip : tips_) longest = std::max(longest, length_to(tip));
        if (longest > 0.0) size_ = longest;
        gather_places();
        for (BodyTip& tip : tips_) tip.target /= size_;
        const float tolerance = plan_.options.tolerance;
        if (tolerance > 0.0f) tolerance_ = std::max(double{tolerance} / size_, 1e-9);
        for (BodyLink& link : links_) gather_link(link);
        links_[0].chart.begin_within(links_[0], plan_.options.root_turn, links_[0].local);
        start_translation_ = glm::dvec3(state_.local_of(links_[0].joint).translation);
        origin_ = links_[0].position;
        most_shift_ = glm::dvec3(plan_.options.root_shift) / size_;
        place();
        return std::isfinite(cost() + glm::dot(origin_, origin_) + glm::length(base_));
    }

    void gather_link(BodyLink& link) const {
        const Joint& joint = plan_.model.joints()[link.joint];
        const std::uint32_t number = plan_.options.obey_constraints ? state_.data->ik_constraint(link.joint) : kNone;
        link.constraint = number == kNone ? nullptr : &state_.data->constraints[number];
        link.frame = link.constraint == nullptr ? glm::dquat(1.0, 0.0, 0.0, 0.0) : link.constraint->frame;
        link.rest_frame = link.constraint == nullptr ? glm::normalize(glm::dquat(joint.rest.rotation))
                                                     : state_.data->rest_frames[number];
        link.freedom = link.constraint == nullptr ? glm::dvec3(1.0) : glm::dvec3(1.0) - link.constraint->stiffness;
        const bool is_locked = link.constraint != nullptr && link.constraint->model() == ConstraintModel::locked;
        const bool is_fixed_root = link.parent == kNone && !(plan_.options.root_turn > 0.0f);
        link.is_fixed = is_locked || is_fixed_root || link.freedom == glm::dvec3(0.0);
        link.local = legal_local(link, glm::normalize(glm::dquat(state_.local_of(link.joint).rotation)));
        link.saved = link.local;
        link.chart.begin(link);
    }

    /// Sets places and offsets from the pose's matrices.
    void gather_places() {
        for (BodyLink& link : links_) {
            const BodyLink* const parent = link.parent == kNone ? nullptr : &links_[link.parent];
            const glm::dquat local = glm::normalize(glm::dquat(state_.local_of(link.joint).rotation));
            link.global = (parent == nullptr ? base_ : parent->global) * local;
            link.position = glm::dvec3(state_.fresh_matrix(link.joint)[3]) / size_;
            if (parent != nullptr) link.offset = glm::conjugate(parent->global) * (link.position - parent->position);
        }
        for (BodyTip& tip : tips_) {
            const BodyLink& link = links_[tip.link];
            tip.place = glm::dvec3(state_.fresh_matrix(link.joint) * glm::dvec4(tip.in_joint, 1.0)) / size_;
            tip.offset = glm::conjugate(link.global) * (tip.place - link.position);
        }
    }

    [[nodiscard]] double length_to(const BodyTip& tip) const {
        double length = glm::length(tip.offset);
        for (std::uint32_t link = tip.link; links_[link].parent != kNone; link = links_[link].parent)
            length += glm::length(links_[link].offset);
        return length;
    }

    /// Computes orientations and positions from the links' rotations and the root's shift.
    void place() {
        for (BodyLink& link : links_) {
            if (link.parent == kNone) {
                link.global = base_ * link.local;
                link.position = origin_ + shift_;
                continue;
            }
            const BodyLink& parent = links_[link.parent];
            link.global = parent.global * link.local;
            link.position = parent.position + parent.global * link.offset;
        }
        for (BodyTip& tip : tips_) tip.place = links_[tip.link].position + links_[tip.link].global * tip.offset;
    }

    [[nodiscard]] double angle_left(const BodyTip& tip) const {
        return angle_between(links_[tip.link].global, tip.rotation);
    }

    [[nodiscard]] bool is_there(const BodyTip& tip) const {
        const glm::dvec3 left = tip.target - tip.place;
        return (tip.weight == 0.0 || glm::dot(left, left) <= square(tolerance_)) &&
               (tip.rotation_weight == 0.0 || angle_left(tip) <= tolerance_);
    }

    std::uint32_t solve() {
        std::uint32_t iterations = 0;
        double best = std::numeric_limits<double>::infinity();
        for (std::uint32_t attempt = 0; attempt <= plan_.options.restarts && !is_reached(); ++attempt) {
            if (attempt > 0) begin_anew(attempt);
            for (BodyLink& link : links_) link.chart.read(link, link.local);
            iterations += descend_damped(*this, plan_.options.iterations);
            // If two results are nearly equal, the first counts: rounding must not choose between them.
            constexpr double kNearer = 0.99;
            const bool is_best = is_reached() || cost() < kNearer * best;
            if (is_best) best = cost();
            (is_best ? best_shift_ : shift_) = is_best ? shift_ : best_shift_;
            for (BodyLink& link : links_) (is_best ? link.best : link.local) = is_best ? link.local : link.best;
            if (!is_best) place();
        }
        return iterations;
    }

    /// Sets the links that move only effectors that are short of their targets to the middle of their limits or to
    /// rest, and in every second attempt all that move one of them.
    void begin_anew(std::uint32_t attempt) {
        std::uint32_t short_of = 0;
        for (std::size_t k = 0; k < tips_.size(); ++k) short_of |= is_there(tips_[k]) ? 0u : 1u << k;
        for (BodyLink& link : links_) {
            const bool is_chosen =
                attempt % 2 == 1 ? (link.effectors & ~short_of) == 0 : (link.effectors & short_of) != 0;
            if (is_chosen && !link.is_fixed && link.parent != kNone) link.local = middle_local(link);
        }
        place();
    }

    /// Adds to the matrix, at the rows of one block and the columns of another.
    void add(std::size_t row, std::size_t column, double weight, const glm::dmat3& block) {
        for (int r = 0; r < 3; ++r) {
            double* const out = &plan_.A[(row + static_cast<std::size_t>(r)) * stride_ + column];
            for (int c = 0; c < 3; ++c) out[c] += weight * block[c][r];
        }
    }

    /// Sums J mobility J^T over the links, J of each: a rotation w moves a tip by cross(w, arm), and rotates it by w.
    void gather_matrix() {
        for (std::size_t row = 0; row < rows_; ++row) std::fill_n(&plan_.A[row * stride_], row + 1, 0.0);
        glm::dmat3 shifts(0.0);
        for (int axis = 0; axis < 3; ++axis) shifts[axis][axis] = root_mobility_[axis];
        for (const BodyTip& tip : tips_) {
            for (const BodyTip* other = tips_.data(); other <= &tip; ++other) {
                if (tip.weight * other->weight > 0.0)
                    add(tip.row, other->row, std::sqrt(tip.weight * other->weight), shifts);
            }
        }
        for (BodyGroup& group : plan_.groups) group.turns = group.first = group.second = glm::dmat3(0.0);
        for (const BodyLink& link : links_) {
            if (link.way_count == 0) continue;
            BodyGroup& group = plan_.groups[link.group];
            const glm::dvec3 arm = link.position - links_[0].position;
            const glm::dmat3 moved = link.mobility * cross_matrix(arm);
            group.turns += link.mobility;
            group.first += moved;
            group.second += cross_matrix(arm) * moved;
        }
        for (const BodyGroup& group : plan_.groups) {
            for (std::uint32_t bits = group.effectors; bits != 0; bits &= bits - 1) add_effector(group, bits);
        }
    }

    /// Adds the blocks of the lowest effector of `bits` and those from it on: with arm a = tip - p and J = -[a]x, J
    /// mobility J^T is -[a]x mobility [b]x, whose sum over p follows from the group's.
    void add_effector(const BodyGroup& group, std::uint32_t bits) {
        const auto number = [](std::uint32_t of) { return static_cast<std::size_t>(std::countr_zero(of)); };
        const auto weight = [](double a, double b) { return std::sqrt(a * b); };
        const BodyTip& other = tips_[number(bits)];
        const glm::dvec3 arm = other.place - links_[0].position;
        const glm::dmat3 first = glm::transpose(group.first);
        const glm::dmat3 turned = group.turns * cross_matrix(arm) - group.first;
        const glm::dmat3 rest = first * cross_matrix(arm) + group.second;
        for (; bits != 0; bits &= bits - 1) {
            const BodyTip& tip = tips_[number(bits)];
            const glm::dvec3 tip_arm = tip.place - links_[0].position;
            if (tip.weight > 0.0 && other.weight > 0.0)
                add(tip.row, other.row, -weight(tip.weight, other.weight), cross_matrix(tip_arm) * turned + rest);
            if (tip.rotation_weight > 0.0 && other.weight > 0.0)
                add(tip.rotation_row, other.row, weight(tip.rotation_weight, other.weight), turned);
            if (tip.rotation_weight > 0.0 && other.rotation_weight > 0.0) {
                add(tip.rotation_row, other.rotation_row, weight(tip.rotation_weight, other.rotation_weight),
                    group.turns);
            }
            if (&tip != &other && tip.weight > 0.0 && other.rotation_weight > 0.0) {
                add(tip.row, other.rotation_row, -weight(tip.weight, other.rotation_weight),
                    cross_matrix(tip_arm) * group.turns + first);
            }
        }
    }

    /// Returns the way to the target, or part of it: a derivative says nothing about a point far away.
    static glm::dvec3 step_of(const BodyTip& tip) {
        constexpr double kLongest = 0.5;
        const glm::dvec3 way = tip.target - tip.place;
        const double length = glm::length(way);
        return length > kLongest ? way * (kLongest / length) : way;
    }

    void gather_errors() {
        const auto set = [&](std::size_t row, double weight, const glm::dvec3& error) {
            for (int axis = 0; axis < 3; ++axis)
                plan_.y[row + static_cast<std::size_t>(axis)] = std::sqrt(weight) * error[axis];
        };
        for (const BodyTip& tip : tips_) {
            if (tip.weight > 0.0) set(tip.row, tip.weight, step_of(tip));
            if (tip.rotation_weight > 0.0) {
                const glm::dquat turn = tip.rotation * glm::conjugate(links_[tip.link].global);
                set(tip.rotation_row, tip.rotation_weight, to_vector(turn));
            }
        }
    }

    [[nodiscard]] static glm::dvec3 torque_of(const BodyLink& link) {
        return link.torque - glm::cross(link.position, link.force);
    }

    /// Sets what can move: an axis of the root's box that is at its end and would leave it stays there.
    void open_ways(double spring) {
        for (BodyLink& link : links_)
            bendy::open_ways(link, link.parent == kNone ? base_ : links_[link.parent].global, torque_of(link), spring);
        for (int axis = 0; axis < 3; ++axis) {
            const double pull = links_[0].force[axis] - spring * shift_[axis] / kRootFreedom;
            const bool is_stopped = std::abs(shift_[axis]) >= most_shift_[axis] && pull * shift_[axis] >= 0.0;
            root_mobility_[axis] = is_stopped ? 0.0 : kRootFreedom;
        }
    }

    /// Applies mobility J^T y to every link and to the root.
    void apply() {
        sum_forces();
        for (BodyLink& link : links_) bendy::take_step(link, torque_of(link));
        shift_before_ = shift_;
        shift_ = glm::clamp(shift_ + root_mobility_ * links_[0].force, -most_shift_, most_shift_);
        place();
    }

    void sum_forces() {
        for (BodyLink& link : links_) link.force = link.torque = glm::dvec3(0.0);
        const auto at = [&](std::size_t row, double weight) {
            return std::sqrt(weight) * glm::dvec3(plan_.y[row], plan_.y[row + 1], plan_.y[row + 2]);
        };
        for (const BodyTip& tip : tips_) {
            BodyLink& link = links_[tip.link];
            if (tip.weight > 0.0) {
                const glm::dvec3 force = at(tip.row, tip.weight);
                link.force += force;
                link.torque += glm::cross(tip.place, force);
            }
            if (tip.rotation_weight > 0.0) link.torque += at(tip.rotation_row, tip.rotation_weight);
        }
        for (std::size_t k = links_.size(); k-- > 1;) {
            BodyLink& parent = links_[links_[k].parent];
            parent.force += links_[k].force;
            parent.torque += links_[k].torque;
        }
    }

    /// Writes rotations and the root's place into the pose.
    void scatter() {
        for (const BodyLink& link : links_) state_.set_rotation(link.joint, glm::quat(link.local));
        if (most_shift_ == glm::dvec3(0.0)) return;
        const glm::dmat3 space(state_.fresh_matrix(plan_.model.parents()[links_[0].joint]));
        if (!(std::abs(glm::determinant(space)) > 1e-30)) return;
        JointTransform root = state_.local_of(links_[0].joint);
        root.translation = glm::vec3(start_translation_ + glm::inverse(space) * (shift_ * size_));
        state_.set_local(links_[0].joint, root);
    }

    [[nodiscard]] BodyReached measure(std::uint32_t iterations) const {
        BodyReached result;
        result.is_reached = is_reached();
        result.iterations = iterations;
        double farthest = -1.0;
        for (std::size_t k = 0; k < tips_.size(); ++k) {
            const BodyTip& tip = tips_[k];
            const double distance = glm::length(tip.target - tip.place);
            if (tip.weight > 0.0 && distance > farthest) {
                farthest = distance;
                result.farthest = static_cast<std::uint32_t>(k);
                result.distance = static_cast<float>(distance * size_);
            }
            if (tip.rotation_weight > 0.0) result.angle = std::max(result.angle, static_cast<float>(angle_left(tip)));
        }
        return result;
    }

    BodyReachPlan& plan_;
    PoseState& state_;
    std::span<BodyLink> links_;
    std::span<BodyTip> tips_;
    std::size_t stride_ = plan_.y.size();
    std::size_t rows_ = 0;                             ///< unknowns of this call
    glm::dquat base_{1.0, 0.0, 0.0, 0.0};              ///< orientation of the root's parent
    glm::dvec3 origin_{0.0}, start_translation_{0.0};  ///< of the root
    glm::dvec3 most_shift_{0.0}, shift_{0.0}, shift_before_{0.0}, best_shift_{0.0}, root_mobility_{0.0};
    double size_ = 1.0;  ///< metres
    double tolerance_ = 1e-4;
};

}  // namespace

void BodyReachPlan::add_links(std::uint32_t root, std::span<const Effector> effectors) {
    const auto parents = model.parents();
    std::vector<std::uint32_t> moves(parents.size(), 0);
    for (std::size_t k = 0; k < effectors.size(); ++k) {
        for (std::uint32_t joint = effectors[k].joint;; joint = parents[joint]) {
            moves[joint] |= 1u << k;
            if (joint == root) break;
        }
    }
    std::vector<std::uint32_t> numbers(parents.size(), kNone);
    for (std::uint32_t joint = 0; joint < parents.size(); ++joint) {
        if (moves[joint] == 0) continue;
        numbers[joint] = static_cast<std::uint32_t>(links.size());
        BodyLink link;
        link.joint = joint;
        link.parent = joint == root ? kNone : numbers[parents[joint]];
        link.effectors = moves[joint];
        const auto group = std::find_if(groups.begin(), groups.end(),
                                        [&](const BodyGroup& one) { return one.effectors == link.effectors; });
        link.group = static_cast<std::size_t>(group - groups.begin());
        if (group == groups.end()) groups.push_back({link.effectors});
        links.push_back(link);
    }
    for (const Effector& effector : effectors) {
        BodyTip tip;
        tip.link = numbers[effector.joint];
        tip.in_joint = glm::dvec3(effector.tip_offset);
        tips.push_back(tip);
    }
}

namespace {

bool is_at_or_above(std::span<const std::uint32_t> parents, std::uint32_t root, std::uint32_t joint) {
    while (joint != kNone && joint != root) joint = parents[joint];
    return joint == root;
}

/// Returns the nearest joint at or above all effectors, or kNone.
std::uint32_t shared_root(std::span<const std::uint32_t> parents, std::span<const Effector> effectors) {
    std::uint32_t root = effectors[0].joint;
    const auto is_above_all = [&] {
        return std::all_of(effectors.begin(), effectors.end(),
                           [&](const Effector& one) { return is_at_or_above(parents, root, one.joint); });
    };
    while (root != kNone && !is_above_all()) root = parents[root];
    return root;
}

bool is_finite(const glm::vec3& v) {
    return std::isfinite(v.x + v.y + v.z);
}

}  // namespace

Result<BodyReach, CallError> BodyReachPlan::make(const Model& model, std::span<const Effector> effectors,
                                                 const BodyReachOptions& options) {
    if (effectors.empty()) return CallError::missing;
    if (effectors.size() > BodyReach::kMostEffectors) return CallError::wrong_size;
    const auto parents = model.parents();
    for (const Effector& effector : effectors) {
        if (effector.joint >= parents.size()) return CallError::out_of_range;
        if (!is_finite(effector.tip_offset)) return CallError::not_finite;
    }
    if (!is_finite(options.root_shift) || !std::isfinite(options.root_turn)) return CallError::not_finite;
    const std::uint32_t root = options.root == kNone ? shared_root(parents, effectors) : options.root;
    const bool is_above = root < parents.size() &&
                          std::all_of(effectors.begin(), effectors.end(),
                                      [&](const Effector& one) { return is_at_or_above(parents, root, one.joint); });
    if (!is_above) return CallError::out_of_range;
    auto plan = std::make_unique<BodyReachPlan>(model);
    plan->options = options;
    plan->options.root = root;
    plan->options.root_shift = glm::max(options.root_shift, glm::vec3(0.0f));
    plan->add_links(root, effectors);
    constexpr std::size_t kUnknowns = 6;  // of an effector
    plan->y.resize(kUnknowns * effectors.size());
    plan->A.resize(plan->y.size() * plan->y.size());
    return BodyReach(std::move(plan));
}

Result<BodyReach, CallError> BodyReach::make(const Model& model, std::span<const Effector> effectors,
                                             const BodyReachOptions& options) {
    return BodyReachPlan::make(model, effectors, options);
}

BodyReach::BodyReach(std::unique_ptr<BodyReachPlan> plan) : plan_(std::move(plan)) {}

BodyReach::BodyReach(const BodyReach& other) : plan_(std::make_unique<BodyReachPlan>(*other.plan_)) {}

BodyReach::BodyReach(BodyReach&& other) noexcept = default;

BodyReach& BodyReach::operator=(const BodyReach& other) {
    if (this != &other) plan_ = std::make_unique<BodyReachPlan>(*other.plan_);
    return *this;
}

BodyReach& BodyReach::operator=(BodyReach&& other) noexcept = default;

BodyReach::~BodyReach() = default;

const Model& BodyReach::model() const {
    return plan_->model;
}

std::uint32_t BodyReach::root() const {
    return plan_->options.root;
}

Result<BodyReached, CallError> reach(Pose& pose, BodyReach& body, std::span<const EffectorTarget> targets) {
    BodyReachPlan& plan = BodyReachPlan::of(body);
    if (pose.model() != plan.model) return CallError::other_model;
    if (targets.size() != plan.tips.size()) return CallError::wrong_size;
    return ReachingBody(plan, pose).run(targets);
}

}  // namespace bendy
