#include "ik_over_time.h"

#include <bendy/runtime/constrain.h>

#include "ik_carry.h"
#include "ik_problem.h"
#include "ik_quick.h"
#include "math/rigid_part.h"
#include "math/rotation.h"
#include "pose/pose_state.h"

#include <bendy/format/trig.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

// Without a state, a pose is a function of the pose that comes in and the target. It jumps where two poses are equally
// good, or where a detail decides what is reached. With a state, if that pose is farther from the last one than pose
// and target have moved, the solver also starts from the last one, and that counts as long as it is as good. The chain
// then turns towards the chosen pose in the coordinates of its limits, and so stays inside them.
namespace bendy {

ReachState::ReachState(const Model& model) : model_(model), chains_(model.chains().size()) {
    for (std::size_t number = 0; number < chains_.size(); ++number) {
        const ChainRecord& record = model.chains()[number].record;
        const std::size_t first = links_.size();
        chains_[number].first = static_cast<std::uint32_t>(first);
        links_.resize(first + model.chains()[number].links);
        std::uint32_t joint = record.effector;
        for (std::size_t i = links_.size(); i-- > first; joint = model.parents()[joint]) links_[i].joint = joint;
    }
}

void ReachState::reset() {
    for (ChainMemory& chain : chains_) chain.is_known = false;
}

Result<void, CallError> ReachState::forget(const Chain* chain) {
    if (chain == nullptr) return CallError::missing;
    const std::span<const Chain> chains = model_.chains();
    for (std::size_t number = 0; number < chains.size(); ++number) {
        if (chain != &chains[number]) continue;
        chains_[number].is_known = false;
        return {};
    }
    return CallError::other_model;
}

namespace {

/// The largest angle between two poses of a chain.
class LargestTurn {
public:
    LargestTurn() = default;
    /// \param a, b  rotations of the parent of the chain's start
    LargestTurn(const glm::dquat& a, const glm::dquat& b) : a_(a), b_(b) {}

    void add(const glm::dquat& a, const glm::dquat& b) {
        a_ = a_ * a;
        b_ = b_ * b;
        const double dot = glm::dot(a_, b_), lengths = glm::dot(a_, a_) * glm::dot(b_, b_);
        if (lengths > 0.0) least_ = std::min(least_, dot * dot / lengths);
    }
    [[nodiscard]] double angle() const {
        return 2.0 * trig::atan2(std::sqrt(std::max(0.0, 1.0 - least_)), std::sqrt(least_));
    }

private:
    glm::dquat a_{1.0, 0.0, 0.0, 0.0}, b_{1.0, 0.0, 0.0, 0.0};
    double least_ = 1.0;  ///< square of the cosine of half the angle
};

glm::quat to_floats(const glm::dquat& q) {
    return {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};
}

/// Returns a link's rotation on the way from one to another, inside its limits.
glm::quat on_the_way(const IkLink& link, const glm::quat& from, const glm::quat& to, double share) {
    const glm::dquat a = glm::normalize(glm::dquat(from)), b = glm::normalize(glm::dquat(to));
    if (link.constraint == nullptr) return to_floats(between(a, b, share));
    const glm::dquat back = glm::conjugate(link.rest_frame);
    const glm::dquat R = between_legal(*link.constraint, back * a * link.frame, back * b * link.frame, share);
    return to_floats(glm::normalize(link.rest_frame * R * glm::conjugate(link.frame)));
}

}  // namespace

ReachMemory::ReachMemory(const Chain& of, const ReachOptions& options) {
    if (options.state == nullptr || solver_of(of, options) == Solver::pull) return;
    ReachState& state = *options.state;
    chain = &state.chains_[static_cast<std::size_t>(&of - state.model_.chains().data())];
    links = std::span(state.links_).subspan(chain->first, of.links);
}

ReachOverTime::ReachOverTime(const Chain& chain, const ReachTarget& target, Pose& pose, const ReachOptions& options)
    : chain_(chain), target_(target), pose_(pose), options_(options), stateless_(options), memory_(chain, options) {
    stateless_.state = nullptr;
    if (memory_.chain == nullptr) return;
    stateless_.influence = 1.0f;
    read_pose();
}

void ReachOverTime::read_pose() {
    PoseState& state = PoseState::of(pose_);
    auto& memory = *memory_.chain;
    const glm::dmat4 base = state.fresh_matrix(state.data->parents[chain_.record.start]);
    const glm::dquat rotation = rigid_rotation(base);
    LargestTurn turn(memory.base, rotation);
    length_ = glm::length(tip_offset(chain_));
    for (ReachMemory::Link& link : memory_.links) {
        const JointTransform now = state.local_of(link.joint);
        turn.add(glm::dquat(link.posed.rotation), glm::dquat(now.rotation));
        if (link.joint != chain_.record.start) length_ += glm::length(glm::dvec3(now.translation));
        link.posed = now;
    }
    const glm::dvec3 start(base * glm::dvec4(memory_.links.front().posed.translation, 1.0));
    const glm::dvec3 way = glm::dvec3(target_.position) - start;
    length_ *= glm::length(glm::dvec3(base[0]));
    seconds_ = clamped(options_.seconds, 0.0, 1.0, 0.0);
    allowed_ = clamped(options_.speed_limit, 0.0, 1e3, 0.0) * seconds_ + turn.angle();
    // Near its start a chain turns much farther than its target moves.
    constexpr double kTurns = 3.0;
    const double away = glm::length(way);
    if (away > 0.0) allowed_ += kTurns * glm::length(way - memory.way) / away;
    memory.is_known = memory.is_known && std::isfinite(allowed_);
    memory.way = way;
    // The last pose keeps its rotation in model space.
    const glm::dquat held = glm::conjugate(rotation) * memory.base;
    memory.base = rotation;
    Link& first = memory_.links.front();
    first.wanted = glm::quat(held * glm::dquat(first.wanted));
    first.done = glm::quat(held * glm::dquat(first.done));
}

std::optional<ReachResult> ReachOverTime::follow(const std::optional<ReachResult>& found) {
    if (memory_.chain == nullptr) return found;
    if (!found) {
        memory_.chain->is_known = false;
        return found;
    }
    auto& memory = *memory_.chain;
    read_rotations(&Link::found);
    bool is_in_pose = true;
    if (memory.is_known) {
        is_in_pose = choose(*found);
        memory.is_on_its_way = !(is_in_pose && !memory.is_on_its_way) && !approach();
    } else {
        keep(&Link::wanted, &Link::found);
        memory.is_known = true;
        memory.is_on_its_way = false;
        memory.waited = 0.0;
    }
    if (!memory.is_on_its_way) keep(&Link::done, &Link::wanted);
    if (is_in_pose && !memory.is_on_its_way && options_.influence == 1.0f) return found;
    restore();
    ReachOptions options = options_;
    options.state = nullptr;
    return begin_with(&Link::done, ReachStart::Use::finish, options);
}

/// Sets `wanted`, to what the call without a state found, or to what becomes of the last one. Returns whether that is
/// still in the pose.
bool ReachOverTime::choose(const ReachResult& found) {
    double& waited = memory_.chain->waited;
    if (turn_between(&Link::found, &Link::wanted) <= allowed_) {
        waited = 0.0;
        keep(&Link::wanted, &Link::found);
        return true;
    }
    restore();
    const std::optional<ReachResult> kept = begin_with(&Link::wanted, ReachStart::Use::start, stateless_);
    if (kept) {
        constexpr double kPatience = 0.1;  // seconds
        constexpr double kNearer = 1e-3;   // chain lengths and radians: worth a turn
        constexpr double kFarther = 1.5;   // how much farther from the pose that came in a pose may be and be kept
        read_rotations(&Link::wanted);
        const double nearer = miss_of(*kept) - miss_of(found);
        const bool is_better = nearer > kNearer || (nearer > -kNearer && turn_from_posed(&Link::wanted) >
                                                                             kFarther * turn_from_posed(&Link::found));
        waited = is_better ? waited + seconds_ : 0.0;
        if (waited <= kPatience) return false;
    }
    waited = 0.0;
    keep(&Link::wanted, &Link::found);
    return false;
}

/// Turns `done` towards `wanted`; returns true, and does nothing, if it may go all the way.
bool ReachOverTime::approach() {
    if (turn_between(&Link::done, &Link::wanted) <= allowed_) return true;
    restore();
    (void)begin_with(&Link::done, ReachStart::Use::finish, stateless_);  // fills the links
    const std::span<IkLink> links = PoseState::of(pose_).ik_links;
    const auto go = [&](double share) {
        LargestTurn turn;
        for (std::size_t i = 0; i < memory_.links.size(); ++i) {
            Link& link = memory_.links[i];
            link.trial = on_the_way(links[i], link.done, link.wanted, share);
            turn.add(glm::dquat(link.done), glm::dquat(link.trial));
        }
        return turn.angle();
    };
    constexpr int kHalvings = 12;
    double low = 0.0, high = 1.0;
    for (int k = 0; k < kHalvings; ++k) {
        const double middle = 0.5 * (low + high);
        (go(middle) <= allowed_ ? low : high) = middle;
    }
    (void)go(low);
    // Reaches on the way, if that does not lead back.
    restore();
    if (begin_with(&Link::trial, ReachStart::Use::stay_near, stateless_)) {
        read_rotations(&Link::found);
        const double left = turn_between(&Link::done, &Link::wanted);
        if (turn_between(&Link::done, &Link::found) <= allowed_ &&
            turn_between(&Link::found, &Link::wanted) < left - 0.5 * turn_between(&Link::done, &Link::trial)) {
            keep(&Link::trial, &Link::found);
        }
    }
    keep(&Link::done, &Link::trial);
    return false;
}

std::optional<ReachResult> ReachOverTime::begin_with(Turn rotation, ReachStart::Use use, const ReachOptions& options) {
    const ReachStart start{memory_.links, rotation, use};
    return reach_at_length(chain_, target_, pose_, options, &start);
}

void ReachOverTime::keep(Turn to, Turn from) {
    for (Link& link : memory_.links) link.*to = link.*from;
}

void ReachOverTime::read_rotations(Turn to) {
    const PoseState& state = PoseState::of(pose_);
    for (Link& link : memory_.links) link.*to = state.local_of(link.joint).rotation;
}

/// Puts the pose back that came in.
void ReachOverTime::restore() {
    for (const Link& link : memory_.links) PoseState::of(pose_).set_local(link.joint, link.posed);
}

double ReachOverTime::turn_between(Turn a, Turn b) const {
    LargestTurn turn;
    for (const Link& link : memory_.links) turn.add(glm::dquat(link.*a), glm::dquat(link.*b));
    return turn.angle();
}

/// Returns how far a pose is from the one that came in, in turns of the joints.
double ReachOverTime::turn_from_posed(Turn to) const {
    double sum = 0.0;
    for (const Link& link : memory_.links) {
        LargestTurn turn;
        turn.add(glm::dquat(link.posed.rotation), glm::dquat(link.*to));
        sum += turn.angle() * turn.angle();
    }
    return std::sqrt(sum);
}

/// Returns how far a result is from the target, in chain lengths and radians.
double ReachOverTime::miss_of(const ReachResult& result) const {
    const bool is_aim = solver_of(chain_, options_) == Solver::aim;
    return double{result.angle} + (is_aim || !(length_ > 0.0) ? 0.0 : double{result.distance} / length_);
}

}  // namespace bendy
