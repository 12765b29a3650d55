// Constraints and inverse kinematics.
#include "fail.h"
#include "handles.h"

#include <bendy/runtime/constrain.h>
#include <bendy/runtime/ik.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace bendy::capi {
namespace {

bendy_status check_fraction(float number, const char* name, bendy_error* error) {
    if (number >= 0.0f && number <= 1.0f) return BENDY_OK;
    return fail(error, BENDY_BAD_ARGUMENT, std::string(name) + " must lie between 0 and 1");
}

bendy_status take_options(const bendy_reach_options* options, ReachOptions& taken, bendy_error* error) {
    bendy_reach_options values = BENDY_REACH_OPTIONS_INIT;
    if (const bendy_status status = take(options, "options", values, error)) return status;
    if (const bendy_status status = check_value(values.solver, kSolvers, "solver", error)) return status;
    if (const bendy_status status = check_fraction(values.influence, "influence", error)) return status;
    if (const bendy_status status = check_fraction(values.softness, "softness", error)) return status;
    const float numbers[]{values.tolerance, values.gain, values.step_limit};
    if (const bendy_status status = check_finite(numbers, "options", error)) return status;
    taken.solver = static_cast<Solver>(values.solver);
    taken.iterations = values.iterations;
    taken.tolerance = values.tolerance;
    taken.influence = values.influence;
    taken.softness = values.softness;
    taken.gain = values.gain;
    taken.step_limit = values.step_limit;
    taken.restarts = values.restarts;
    taken.obey_constraints = values.ignore_constraints == 0;
    taken.carry_target = values.carry_target != 0;
    if (values.has_pole == 0) return BENDY_OK;
    if (const bendy_status status = check_finite(values.pole, "pole", error)) return status;
    taken.pole = glm::vec3(values.pole[0], values.pole[1], values.pole[2]);
    return BENDY_OK;
}

bendy_status take_target(const float* position, const float* rotation, ReachTarget& target, bendy_error* error) {
    if (const bendy_status status = check_pointer(position, "position", error)) return status;
    if (const bendy_status status = check_finite({position, 3}, "position", error)) return status;
    target.position = {position[0], position[1], position[2]};
    if (rotation == nullptr) return BENDY_OK;
    if (const bendy_status status = check_rotation(rotation, error)) return status;
    target.rotation = glm::quat(rotation[3], rotation[0], rotation[1], rotation[2]);
    return BENDY_OK;
}

bendy_reach_result to_c(const ReachResult& from) {
    return {0, static_cast<std::uint32_t>(from.status), from.distance, from.angle, from.iterations};
}

/// Request `number` of the caller's array.
bendy_status take_request(const Model& model, const bendy_reach_request* requests, std::size_t number,
                          ReachRequest& taken, bendy_error* error) {
    bendy_reach_request values = BENDY_REACH_REQUEST_INIT;
    if (const bendy_status status = take(at(requests, number), "requests", values, error)) return status;
    if (const bendy_status status = check_index(values.chain, model.chains().size(), "chain", error)) return status;
    taken = {&model.chains()[values.chain], {}, {}};
    const float* const rotation = values.has_rotation != 0 ? values.rotation : nullptr;
    if (const bendy_status status = take_target(values.position, rotation, taken.target, error)) return status;
    return take_options(values.options, taken.options, error);
}

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy_constrain(bendy_pose* pose, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        bendy::constrain(pose->pose);
        return BENDY_OK;
    });
}

bendy_status bendy_reach(bendy_pose* pose, uint32_t chain, const float* position, const float* rotation,
                         const bendy_reach_options* options, bendy_reach_result* result, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        const auto chains = pose->pose.model().chains();
        if (const bendy_status status = check_index(chain, chains.size(), "chain", error)) return status;
        bendy::ReachTarget target;
        if (const bendy_status status = take_target(position, rotation, target, error)) return status;
        bendy::ReachOptions taken;
        if (const bendy_status status = take_options(options, taken, error)) return status;
        if (result != nullptr) {
            if (const bendy_status status = check_out(result, "result", error)) return status;
        }
        const auto reached = bendy::reach(pose->pose, &chains[chain], target, taken);
        if (!reached)
            return fail(error, BENDY_BAD_ARGUMENT, "the pose, or the chain, holds numbers that are not finite");
        if (result != nullptr) put(*result, to_c(*reached));
        return BENDY_OK;
    });
}

bendy_status bendy_reach_chains(bendy_pose* pose, const bendy_reach_request* requests, size_t count,
                                bendy_reach_result* results, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        if (const bendy_status status = check_array(requests, count, "requests", error)) return status;
        if (results != nullptr) {
            if (const bendy_status status = check_array(results, count, "results", error)) return status;
        }
        constexpr std::size_t kAtOnce = 16;  // in the order of the requests: to split them changes no pose
        std::array<bendy::ReachRequest, kAtOnce> taken;
        for (std::size_t k = 0; k < count; ++k) {  // all checks come before the first chain moves
            if (const bendy_status status = take_request(pose->pose.model(), requests, k, taken[0], error))
                return status;
        }
        std::array<bendy::ReachResult, kAtOnce> reached;
        for (std::size_t first = 0; first < count; first += kAtOnce) {
            const std::size_t size = std::min(kAtOnce, count - first);
            for (std::size_t k = 0; k < size; ++k)
                (void)take_request(pose->pose.model(), requests, first + k, taken[k], error);
            const std::span<bendy::ReachResult> out(reached.data(), size);
            if (!bendy::reach(pose->pose, std::span(taken.data(), size), out))
                return fail(error, BENDY_BAD_ARGUMENT, "the pose, or a chain, holds numbers that are not finite");
            for (std::size_t k = 0; results != nullptr && k < size; ++k) put(*at(results, first + k), to_c(reached[k]));
        }
        return BENDY_OK;
    });
}

bendy_status bendy_reach_all(bendy_pose* pose, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        bendy::reach_all(pose->pose);
        return BENDY_OK;
    });
}
