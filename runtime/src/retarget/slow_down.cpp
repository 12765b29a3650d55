#include "slow_down.h"

#include "settle.h"

#include "pose/pose_state.h"

#include <bendy/runtime/turn.h>

#include <algorithm>
#include <cstddef>

namespace bendy {

void slow_down(const RetargetPlan& plan, const PoseState& source, PoseState& target, RetargetState& state,
               float seconds) {
    if (!(seconds > 0.0f)) return;
    const std::size_t of_source = source.data->joints.size(), all = of_source + target.data->joints.size();
    const bool is_known = state.turns.size() == all;
    state.turns.resize(all);
    double most = 0.0;
    for (std::uint32_t joint = 0; joint < of_source; ++joint) {
        const glm::quat now = source.local_of(joint).rotation;
        if (is_known) most = std::max(most, turn_between(state.turns[joint], now));
        state.turns[joint] = now;
    }
    most = kOfSource * most + kTurnSpeed * std::min(seconds, 1.0f);
    for (std::uint32_t joint = 0; joint < target.data->joints.size(); ++joint) {
        glm::quat& last = state.turns[of_source + joint];
        const glm::quat now = target.local_of(joint).rotation;
        if (is_known && turn_between(last, now) > most) {
            const bool has_limits = plan.options.limits != Limits::off;
            last = turn_towards(has_limits ? plan.target.constraint(joint) : nullptr,
                                target.data->joints[joint].rest.rotation, last, now, most);
            target.set_rotation(joint, last);
        } else {
            last = now;
        }
    }
    place_detached(plan, target);
}

}  // namespace bendy
