// Constraints and inverse kinematics.
#include "calls.h"
#include "fail.h"
#include "fields.h"
#include "handles.h"

#include <bendy/runtime/constrain.h>
#include <bendy/runtime/ik.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace bendy::capi {
namespace {

constexpr const char* kNotFinite = "the pose, or a chain, holds numbers that are not finite";

void take_target(const float* position, const float* rotation, ReachTarget& to) {
    to.position = {position[0], position[1], position[2]};
    if (rotation != nullptr) to.rotation = glm::quat(rotation[3], rotation[0], rotation[1], rotation[2]);
}

/// Options of the caller, after their fields are checked.
bendy_status take_options(const bendy_pose& pose, const bendy_reach_options& from, ReachOptions& to,
                          bendy_error* error) {
    if (const bendy_status status = check_same_model(from.state, pose, "state", "pose", error)) return status;
    from_c(from, to);
    if (from.state != nullptr) to.state = &from.state->state;
    return BENDY_OK;
}

/// A request of the caller, after its arguments are checked.
bendy_status take_request(const bendy_pose& pose, const bendy_reach_request& from, ReachRequest& to,
                          bendy_error* error) {
    bendy_reach_request taken = BENDY_REACH_REQUEST_INIT;
    if (const bendy_status status = take(&from, "requests", taken, error)) return status;
    if (const bendy_status status = check_index(taken.chain, parts(pose).chain(), "chain", error)) return status;
    if (const bendy_status status = check_fields(taken, error)) return status;
    bendy_reach_options options = BENDY_REACH_OPTIONS_INIT;
    if (const bendy_status status = take(taken.options, "options", options, error)) return status;
    if (const bendy_status status = check_fields(options, error)) return status;
    to = {&pose.pose.model().chains()[taken.chain], {}, {}};
    take_target(taken.position, taken.has_rotation != 0 ? taken.rotation : nullptr, to.target);
    return take_options(pose, options, to.options, error);
}

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy::capi::constrain(bendy_pose* pose, bendy_error* /*error*/) {
    bendy::constrain(pose->pose);
    return BENDY_OK;
}

bendy_status bendy::capi::reach(bendy_pose* pose, uint32_t chain, const float* position, const float* rotation,
                                const bendy_reach_options& options, bendy_reach_result& result, bendy_error* error) {
    bendy::ReachTarget target;
    take_target(position, rotation, target);
    bendy::ReachOptions taken;
    if (const bendy_status status = take_options(*pose, options, taken, error)) return status;
    const auto reached = bendy::reach(pose->pose, &pose->pose.model().chains()[chain], target, taken);
    if (!reached) return fail(error, BENDY_BAD_ARGUMENT, kNotFinite);
    to_c(*reached, result);
    return BENDY_OK;
}

bendy_status bendy::capi::reach_chains(bendy_pose* pose, const bendy_reach_request* requests, size_t count,
                                       bendy_reach_result* results, bendy_error* error) {
    if (const bendy_status status = check_array(requests, count, "requests", error)) return status;
    if (results != nullptr) {
        if (const bendy_status status = check_array(results, count, "results", error)) return status;
    }
    constexpr std::size_t kAtOnce = 16;  // in the order of the requests; splitting them changes no pose
    std::array<bendy::ReachRequest, kAtOnce> taken;
    for (std::size_t k = 0; k < count; ++k) {  // check everything before the first chain moves
        if (const bendy_status status = take_request(*pose, *at(requests, k), taken[0], error)) return status;
    }
    std::array<bendy::ReachResult, kAtOnce> reached;
    for (std::size_t first = 0; first < count; first += kAtOnce) {
        const std::size_t size = std::min(kAtOnce, count - first);
        for (std::size_t k = 0; k < size; ++k) (void)take_request(*pose, *at(requests, first + k), taken[k], error);
        const std::span<bendy::ReachResult> out(reached.data(), size);
        if (!bendy::reach(pose->pose, std::span(taken.data(), size), out))
            return fail(error, BENDY_BAD_ARGUMENT, kNotFinite);
        for (std::size_t k = 0; results != nullptr && k < size; ++k) {
            bendy_reach_result result{};
            to_c(reached[k], result);
            put(*at(results, first + k), result);
        }
    }
    return BENDY_OK;
}

bendy_status bendy::capi::reach_state_new(const bendy_model* model, bendy_reach_state*& made, bendy_error* /*error*/) {
    made = std::make_unique<bendy_reach_state>(model->character).release();
    return BENDY_OK;
}

bendy_status bendy::capi::reach_state_reset(bendy_reach_state* state, bendy_error* /*error*/) {
    state->state.reset();
    return BENDY_OK;
}

bendy_status bendy::capi::reach_state_forget(bendy_reach_state* state, uint32_t chain, bendy_error* /*error*/) {
    (void)state->state.forget(&state->character->model.chains()[chain]);
    return BENDY_OK;
}

bendy_status bendy::capi::reach_all(bendy_pose* pose, bendy_reach_state* state, float seconds, bendy_error* /*error*/) {
    bendy::reach_all(pose->pose, state == nullptr ? nullptr : &state->state, seconds);
    return BENDY_OK;
}
