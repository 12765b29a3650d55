#include <bendy/runtime/ik.h>

#include "ik_carry.h"
#include "ik_over_time.h"
#include "ik_quick.h"
#include "kernels/kernel_table.h"
#include "math/rigid_part.h"
#include "pose/pose_state.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

// Several chains: those of two bones are solved side by side if none of them moves something that another one depends
// on.
namespace bendy {
namespace {

class Together {
public:
    /// \param results  empty, or one for each request
    Together(Pose& pose, std::span<ReachResult> results)
        : pose_(pose), results_(results), plan_(*PoseState::of(pose).data->pose_plan), kernels_(kernel_table()) {}

    /// Solves a request now or together with later ones.
    void add(const ReachRequest& request, std::size_t number) {
        if (add_limb(request, number)) return;
        solve();  // a pending chain moves what this one depends on
        if (!add_limb(request, number)) solve_alone(request, number);
    }

    /// Returns true if a pending chain moves the joint.
    [[nodiscard]] bool will_move(std::uint32_t joint) const {
        return std::any_of(limbs_.begin(), limbs_.begin() + count_, [&](const Limb& limb) {
            return plan_.is_at_or_below(joint, limb.request.chain->record.start) ||
                   (limb.carried != kNone && plan_.is_at_or_below(joint, limb.carried));
        });
    }

    /// Solves the pending requests.
    void solve() {
        if constexpr (!kSolvesLimbsTogether) return;
        const std::size_t count = std::exchange(count_, 0);
        if (count == 1) return solve_alone(limbs_[0].request, limbs_[0].number);
        if (count == 0) return;
        kernels_.two_bones(block_);
        for (std::size_t k = 0; k < count; ++k) {
            if (!set_limb(k)) solve_alone(limbs_[k].request, limbs_[k].number);
        }
    }

    [[nodiscard]] Result<void, CallError> outcome() const { return outcome_; }

private:
    static constexpr std::size_t kLimbs = TwoBoneBlock::kLimbs;
    struct Limb {
        ReachRequest request;
        std::size_t number = 0;
        std::uint32_t carried = kNone;  ///< see carried_joint
    };

    /// Adds a request to those that are solved side by side, if possible.
    bool add_limb(const ReachRequest& request, std::size_t number) {
        if constexpr (!kSolvesLimbsTogether) return false;
        if (kernels_.two_bones == nullptr || count_ == kLimbs) return false;
        const auto& [chain, target, options] = request;
        const bool is_other = options.state != nullptr && !(options.state->model() == pose_.model());
        if (is_other || !PoseState::of(pose_).data->check(chain) || !is_finite(target) ||
            !is_plain_limb(*chain, target, pose_, options)) {
            return false;
        }
        const bool depends = will_move(chain->record.start) || will_move(chain->record.effector) ||
                             (chain->record.pole != kNone && will_move(chain->record.pole));
        if (depends || !gather_limb(*chain, target, pose_, options, block_.limbs, count_)) return false;
        limbs_[count_++] = {request, number, carried_joint(*chain, pose_, options)};
        return true;
    }

    static bool is_finite(const ReachTarget& target) {
        return std::isfinite(target.position.x + target.position.y + target.position.z);
    }

    /// Applies a limb's solution, if there is one.
    bool set_limb(std::size_t limb) {
        const auto& [chain, target, options] = limbs_[limb].request;
        const double distance = block_.distance[limb];
        const glm::dquat upper = rotation_in(block_.upper, limb), lower = rotation_in(block_.lower, limb);
        const bool has_limits = block_.limbs.has_limits[0][limb] > 0.0;
        if (!(distance >= 0.0) || (has_limits && !are_legal(*chain, pose_, options, upper, lower))) return false;
        PoseState& state = PoseState::of(pose_);
        ReachOverTime over_time(*chain, target, pose_, options);
        state.set_rotation(chain->record.start, glm::quat(upper));
        state.set_rotation(state.data->parents[chain->record.effector], glm::quat(lower));
        if (has_limits) make_end_legal(*chain, pose_, options);
        const ReachStatus status = block_.out_of_reach[limb] > 0.0 ? ReachStatus::out_of_reach : ReachStatus::reached;
        const auto result = over_time.follow(ReachResult{status, static_cast<float>(distance), 0.0f, 1});
        carry_to_tip(*chain, limbs_[limb].carried, pose_);
        note(limbs_[limb].number, *result);
        return true;
    }

    static glm::dquat rotation_in(const double (&numbers)[4][kLimbs], std::size_t limb) {
        return {numbers[3][limb], numbers[0][limb], numbers[1][limb], numbers[2][limb]};
    }

    void solve_alone(const ReachRequest& request, std::size_t number) {
        note(number, reach(pose_, request.chain, request.target, request.options));
    }

    void note(std::size_t number, const Result<ReachResult, CallError>& result) {
        if (!result && outcome_) outcome_ = result.error();
        if (!results_.empty()) results_[number] = result ? *result : ReachResult{};
    }

    Pose& pose_;
    std::span<ReachResult> results_;
    const PosePlan& plan_;
    const KernelTable& kernels_;
    TwoBoneBlock block_{};
    std::array<Limb, kLimbs> limbs_{};  ///< of `block_`
    std::size_t count_ = 0;
    Result<void, CallError> outcome_;
};

}  // namespace

Result<void, CallError> reach(Pose& pose, std::span<const ReachRequest> requests, std::span<ReachResult> results) {
    if (!results.empty() && results.size() < requests.size()) return CallError::output_too_short;
    Together together(pose, results);
    for (std::size_t number = 0; number < requests.size(); ++number) together.add(requests[number], number);
    together.solve();
    return together.outcome();
}

void reach_all(Pose& pose, ReachState* state, float seconds) {
    const Model& model = pose.model();
    PoseState& pose_state = PoseState::of(pose);
    Together together(pose, {});
    if (state != nullptr && !(state->model() == model)) state = nullptr;
    for (const std::uint32_t number : model.chain_order()) {
        const Chain& chain = model.chains()[number];
        if (chain.record.target == kNone || !(chain.record.influence > 0.0f)) continue;
        if (together.will_move(chain.record.target)) together.solve();
        const glm::dmat4 followed = pose_state.fresh_matrix(chain.record.target);
        ReachRequest request{&chain, glm::vec3(followed[3]), {}};
        if (chain.record.rotation_weight > 0.0f) request.target.rotation = glm::quat(rigid_rotation(followed));
        request.options.influence = chain.record.influence;
        request.options.state = state;
        request.options.seconds = seconds;
        request.options.carry_target = false;  // what the chain follows is its goal
        together.add(request, number);
    }
    together.solve();
}

}  // namespace bendy
