// Constraints and inverse kinematics.
#include "fail.h"
#include "handles.h"

#include <bendy/runtime/constrain.h>
#include <bendy/runtime/ik.h>

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
        if (result != nullptr) {
            put(*result, {0, static_cast<std::uint32_t>(reached->status), reached->distance, reached->angle,
                          reached->iterations});
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
