#include <bendy/runtime/ik.h>

#include <bendy/runtime/constrain.h>

#include "ik_carry.h"
#include "ik_over_time.h"
#include "ik_problem.h"
#include "ik_quick.h"
#include "math/rigid_part.h"
#include "math/rotation.h"
#include "one_limb.h"
#include "pose/pose_state.h"

#include <glm/gtc/matrix_inverse.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

namespace bendy {

namespace {

/// One call of reach: converts between the model and the problem.
class Reach {
public:
    Reach(const Chain& chain, const ReachTarget& target, Pose& pose, const ReachOptions& options,
          const ReachStart* start)
        : chain_(chain),
          target_(target),
          model_(pose.model()),
          joints_(model_.joints()),
          state_(PoseState::of(pose)),
          options_(options),
          start_(start),
          links_(std::span(state_.ik_links).first(chain.links)) {}

    /// Returns nothing, and leaves the pose unchanged, if a number is not finite, or if another start than the pose
    /// makes no difference.
    std::optional<ReachResult> run() {
        if (!gather()) return std::nullopt;
        if (start_ != nullptr && start_->use == ReachStart::Use::start && problem_.has_pole) return std::nullopt;
        const bool is_aim = solver() == Solver::aim;
        ReachResult result;
        result.iterations = solve();
        if (!is_aim && !problem_.is_uneven && chain_can_change_length() && !problem_.is_reached()) {
            fit_length();
            result.iterations += solve();
        }
        scatter();
        measure(result);
        return result;
    }

private:
    [[nodiscard]] JointTransform local(std::uint32_t joint) const { return state_.local_of(joint); }

    [[nodiscard]] Solver solver() const {
        const Solver wanted = solver_of(chain_, options_);
        if (wanted != Solver::any) return wanted;
        const auto bones =
            std::count_if(links_.begin(), links_.end(), [](const IkLink& link) { return link.bone_length > 0.0; });
        return bones == 2 ? Solver::two_bone : Solver::least_squares;
    }

    [[nodiscard]] bool chain_can_change_length() const {
        return chain_.record.stretch > 0.0f || chain_.record.compress > 0.0f;
    }

    [[nodiscard]] glm::dvec3 to_base(const glm::dvec3& point) const {
        return glm::dvec3(inverse_base_ * glm::dvec4(point, 1.0)) / problem_.scale;
    }

    /// Fills the links and the problem from the pose. Returns false if a number is not finite.
    bool gather() {
        std::uint32_t joint = chain_.record.effector;
        for (std::size_t i = links_.size(); i-- > 0; joint = joints_[joint].parent) links_[i].joint = joint;
        base_ = state_.fresh_matrix(joints_[chain_.record.start].parent);
        inverse_base_ = glm::affineInverse(base_);
        gather_links();
        gather_weights();
        return gather_problem();
    }

    void gather_links() {
        double scale = 1.0;   // product over the links so far
        double length = 0.0;  // in base space
        for (std::size_t i = 0; i < links_.size(); ++i) {
            IkLink& link = links_[i];
            const JointTransform transform = local(link.joint);
            const Joint& joint = joints_[link.joint];
            link.bone = scale * (scale_and_shear(transform, joint.shear) * end_of(i));
            link.bone_length = glm::length(link.bone);
            link.shape = scale_and_shear(transform, joint.shear);
            link.end = end_of(i);
            length += link.bone_length;
            problem_.is_uneven = problem_.is_uneven || (i + 1 < links_.size() && is_uneven(transform, joint.shear));
            scale *= mean_scale(transform.scale);
            const std::uint32_t number = options_.obey_constraints ? state_.data->ik_constraint(link.joint) : kNone;
            const bool is_free = number == kNone;
            link.constraint = is_free ? nullptr : &state_.data->constraints[number];
            link.frame = is_free ? glm::dquat(1.0, 0.0, 0.0, 0.0) : link.constraint->frame;
            link.rest_frame =
                is_free ? glm::normalize(glm::dquat(joint.rest.rotation)) : state_.data->rest_frames[number];
            link.freedom = link.constraint == nullptr ? glm::dvec3(1.0) : glm::dvec3(1.0) - link.constraint->stiffness;
            link.saved = glm::normalize(glm::dquat(transform.rotation));
            link.local = legal_local(link, start_ == nullptr ? link.saved : glm::normalize(glm::dquat(start_->at(i))));
            if (start_ != nullptr && start_->use == ReachStart::Use::stay_near) link.saved = link.local;
        }
        problem_.scale = length > 0.0 ? length : 1.0;
        problem_.reach = length > 0.0 ? 1.0 : 0.0;
        if (problem_.is_uneven) find_longest();
        for (IkLink& link : links_) {
            link.end /= problem_.scale;
            link.bone /= problem_.scale;
            link.bone_length /= problem_.scale;
        }
    }

    void find_longest() {
        double scale = 1.0;  // product over the links so far, along their longest axes
        for (std::size_t i = 0; i < links_.size(); ++i) {
            const glm::vec3 axes = glm::abs(local(links_[i].joint).scale);
            const glm::vec3 shear = glm::abs(joints_[links_[i].joint].shear);
            scale *= std::max({axes.x, axes.y, axes.z}) + shear.x + shear.y + shear.z;
            problem_.longest += scale * glm::length(end_of(i)) / problem_.scale;
        }
    }

    void gather_weights() {
        for (const ChainWeightView& chain_weight : model_.chain_weights(chain_)) {
            // Joint numbers ascend along the chain.
            const auto link = std::lower_bound(links_.begin(), links_.end(), chain_weight.joint,
                                               [](const IkLink& l, std::uint32_t joint) { return l.joint < joint; });
            if (link != links_.end() && link->joint == chain_weight.joint) {
                link->freedom *= clamped(chain_weight.weight, 0.0, 1.0, 1.0);
            }
        }
        for (IkLink& link : links_) {
            const bool is_locked = link.constraint != nullptr && link.constraint->model() == ConstraintModel::locked;
            link.is_fixed = is_locked || link.freedom == glm::dvec3(0.0);
        }
    }

    bool gather_problem() {
        const ChainRecord& record = chain_.record;
        problem_.links = links_;
        problem_.options = &options_;
        problem_.origin = glm::dvec3(local(chain_.record.start).translation) / problem_.scale;
        problem_.target = to_base(target_.position);
        problem_.tip_rotation = unit_or_identity(record.tip_rotation);
        problem_.position_weight = clamped(record.position_weight, 0.0, 1.0, 1.0);
        problem_.has_rotation = target_.rotation.has_value();
        problem_.rotation_weight = clamped(record.rotation_weight, 0.0, 1.0, 0.0);
        if (problem_.rotation_weight == 0.0) problem_.rotation_weight = 1.0;
        if (problem_.has_rotation) {
            const glm::dquat wanted(*target_.rotation);
            if (!(std::abs(glm::length(wanted) - 1.0) < 1e-2)) return false;
            problem_.target_rotation = glm::conjugate(rigid_rotation(base_)) * glm::normalize(wanted);
        } else if (problem_.position_weight == 0.0) {
            problem_.position_weight = 1.0;
        }
        const float tolerance = tolerance_of(chain_, options_);
        problem_.tolerance =
            tolerance > 0.0f ? std::max(double{tolerance} / (problem_.scale * base_scale()), 1e-9) : 1e-4;
        constexpr std::uint16_t kMostIterations = 1000;  // limit, whatever the file asks for
        problem_.iterations =
            options_.iterations != 0 ? options_.iterations : std::min(record.iterations, kMostIterations);
        gather_pole();
        wanted_ = problem_.target;
        find_reach();
        soften();
        problem_.place();
        const double sum = glm::dot(problem_.target, problem_.target) + glm::dot(problem_.tip, problem_.tip) +
                           glm::dot(problem_.origin, problem_.origin) + glm::length(problem_.tip_global) +
                           glm::dot(problem_.pole, problem_.pole) + problem_.pole_angle;
        return std::isfinite(sum);
    }

    void find_reach() {
        const double distance = glm::length(wanted_ - problem_.origin);
        constexpr double kStraight = 1e-6;  // chain lengths: a bend too small to see
        is_far_ = distance > problem_.reach - kStraight;
        problem_.is_out_of_reach = distance > std::max(problem_.reach, problem_.longest) + problem_.tolerance;
    }

    /// Moves the target nearer by the softness.
    void soften() {
        const Solver chosen = solver();
        const glm::dvec3 way = wanted_ - problem_.origin;
        const double distance = glm::length(way);
        const double zone = problem_.reach * softness_of(chain_, options_);
        if (chosen == Solver::aim || chosen == Solver::pull || !(zone > 0.0) || !(distance > 0.0)) return;
        problem_.target = problem_.origin + way * (one_limb::softened(distance, problem_.reach, zone) / distance);
        is_far_ = false;
    }

    void gather_pole() {
        const Pole pole = find_pole(chain_, state_, options_);
        problem_.pole_angle = chain_.record.pole_angle;
        problem_.has_pole = pole.is_there;
        constexpr double kFar = 1e3;  // chain lengths: a direction becomes a distant point
        if (pole.is_there) problem_.pole = pole.is_point ? to_base(pole.place) : problem_.origin + kFar * pole.place;
    }

    /// Returns metres in model space per unit of base space, for the longest axis if the axes differ.
    [[nodiscard]] double base_scale() const {
        const glm::dmat3 axes(base_);
        const double scale = std::max({glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])});
        return scale > 0.0 ? scale : 1.0;
    }

    /// Returns where a link's bone ends, relative to its joint: the next joint, or the tip.
    [[nodiscard]] glm::dvec3 end_of(std::size_t link) const {
        return link + 1 == links_.size() ? tip_offset(chain_) : glm::dvec3(local(links_[link + 1].joint).translation);
    }

    static glm::dmat3 scale_and_shear(const JointTransform& transform, const glm::vec3& shear) {
        return {glm::dvec3(transform.scale.x, 0.0, 0.0), glm::dvec3(shear.x, transform.scale.y, 0.0),
                glm::dvec3(shear.y, shear.z, transform.scale.z)};
    }

    [[nodiscard]] bool is_uneven(const JointTransform& transform, const glm::vec3& shear) const {
        const float same = same_scale(chain_, options_);
        const glm::vec3& s = transform.scale;
        return shear != glm::vec3(0.0f) || std::abs(s.x - s.y) > same * std::abs(s.x) ||
               std::abs(s.x - s.z) > same * std::abs(s.x) || s.x < 0.0f;
    }

    static double mean_scale(const glm::vec3& scale) {
        if (scale.x == scale.y && scale.x == scale.z) return std::abs(scale.x);
        return (std::abs(double{scale.x}) + std::abs(scale.y) + std::abs(scale.z)) / 3.0;
    }

    std::uint32_t solve() {
        if (start_ != nullptr && start_->use == ReachStart::Use::finish) return 0;
        const Solver chosen = solver();
        if (chosen == Solver::aim) return solve_aim(problem_);
        if (chosen == Solver::pull) return solve_pull(problem_);
        if (start_ != nullptr) return solve_again(problem_);
        if (is_far_ && problem_.position_weight > 0.0) point_at_target(problem_);
        // Two bones turn to their pole even if the tip is already there.
        const bool is_closed = chosen == Solver::two_bone;
        if (!is_closed && (problem_.is_reached() || problem_.is_stretched_out())) return 0;
        return solve_from(problem_, is_closed);
    }

    /// Scales all bones by the same factor, within the range that the chain allows.
    void fit_length() {
        const double reached = glm::length(problem_.tip - problem_.origin);
        if (reached < 1e-9) return;
        const double wanted = glm::length(problem_.target - problem_.origin) / reached;
        stretch_ = std::clamp(wanted, 1.0 - clamped(chain_.record.compress, 0.0, 1.0, 0.0),
                              1.0 + std::max(0.0, double{chain_.record.stretch}));
        // The tip's offset is inside the effector and is not scaled.
        for (std::size_t i = 0; i + 1 < links_.size(); ++i) {
            links_[i].bone *= stretch_;
            links_[i].bone_length *= stretch_;
        }
        problem_.reach *= stretch_;
        problem_.is_out_of_reach = problem_.is_out_of_reach && wanted > stretch_;
        is_far_ = is_far_ && problem_.is_out_of_reach;
        problem_.place();
    }

    /// Writes the links' rotations into the pose.
    void scatter() {
        const double influence = clamped(options_.influence, 0.0, 1.0, 0.0);
        for (const IkLink& link : links_) {
            JointTransform joint = local(link.joint);
            const glm::dquat mixed = influence == 1.0
                                         ? link.local
                                         : between(glm::normalize(glm::dquat(joint.rotation)), link.local, influence);
            joint.rotation = glm::quat(glm::normalize(mixed));
            if (stretch_ != 1.0 && link.joint != chain_.record.start)
                joint.translation *= static_cast<float>(1.0 + influence * (stretch_ - 1.0));
            state_.set_local(link.joint, joint);
        }
    }

    void measure(ReachResult& result) const {
        const glm::dvec3 left = wanted_ - problem_.tip;
        result.distance = static_cast<float>(glm::length(glm::dmat3(base_) * (left * problem_.scale)));
        if (solver() == Solver::aim) {
            const glm::dvec3 forward = problem_.tip_global * glm::dvec3(0.0, 0.0, 1.0);
            result.angle = static_cast<float>(glm::length(to_vector(between(forward, problem_.target - problem_.tip))));
            result.status = result.angle <= problem_.tolerance ? ReachStatus::aimed : ReachStatus::not_reached;
            return;
        }
        result.angle = static_cast<float>(problem_.rotation_error());
        const double soft = glm::length(wanted_ - problem_.target);
        const bool is_there = problem_.position_weight == 0.0 ||
                              (!problem_.is_out_of_reach && glm::length(left) <= problem_.tolerance + soft);
        if (is_there && problem_.rotation_error() <= problem_.tolerance) {
            result.status = ReachStatus::reached;
        } else {
            result.status = problem_.is_out_of_reach ? ReachStatus::out_of_reach : ReachStatus::not_reached;
        }
    }

    const Chain& chain_;
    const ReachTarget& target_;
    const Model& model_;
    std::span<const Joint> joints_;
    PoseState& state_;
    const ReachOptions& options_;
    const ReachStart* start_;  ///< null: the pose
    std::span<IkLink> links_;
    IkProblem problem_;
    glm::dmat4 base_{1.0};
    glm::dmat4 inverse_base_{1.0};
    glm::dvec3 wanted_{0};  ///< the target, not softened
    double stretch_ = 1.0;
    bool is_far_ = false;  ///< the chain must be straight to reach the target, or cannot reach it
};

}  // namespace

Result<ReachResult, CallError> reach(Pose& pose, const Chain* chain, const ReachTarget& target,
                                     const ReachOptions& options) {
    if (const auto checked = PoseState::of(pose).data->check(chain); !checked) return checked.error();
    if (!std::isfinite(target.position.x + target.position.y + target.position.z)) return CallError::not_finite;
    if (options.state != nullptr && !(options.state->model() == pose.model())) return CallError::other_model;
    ReachOverTime over_time(*chain, target, pose, options);
    std::optional<ReachResult> result = reach_quickly(*chain, target, pose, over_time.options());
    if (!result) result = reach_at_length(*chain, target, pose, over_time.options());
    result = over_time.follow(result);
    if (!result) return CallError::not_finite;
    carry_to_tip(*chain, carried_joint(*chain, pose, options), pose);
    return *result;
}

std::optional<ReachResult> reach_at_length(const Chain& chain, const ReachTarget& target, Pose& pose,
                                           const ReachOptions& options, const ReachStart* start) {
    return Reach(chain, target, pose, options, start).run();
}

}  // namespace bendy
