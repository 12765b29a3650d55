// Full-body inverse kinematics.
#include "calls.h"
#include "fail.h"
#include "fields.h"
#include "handles.h"
#include "lookup.h"

#include <bendy/runtime/body_reach.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

using namespace bendy::capi;

bendy_status bendy::capi::body_reach_new(const bendy_model* model, const bendy_effector* effectors, size_t count,
                                         const bendy_body_reach_options& options, bendy_body_reach*& made,
                                         bendy_error* error) {
    if (count == 0 || count > BodyReach::kMostEffectors) {
        return fail(error, BENDY_BAD_ARGUMENT,
                    "expected 1 to " + std::to_string(BodyReach::kMostEffectors) + " effectors, found " +
                        std::to_string(count));
    }
    if (const bendy_status status = check_array(effectors, count, "effectors", error)) return status;
    const std::size_t joints = parts(*model).joint();
    std::vector<bendy::Effector> taken(count);
    for (std::size_t k = 0; k < count; ++k) {
        bendy_effector effector = BENDY_EFFECTOR_INIT;
        if (const bendy_status status = take(at(effectors, k), "effectors", effector, error)) return status;
        if (const bendy_status status = check_index(effector.joint, joints, "joint", error)) return status;
        if (const bendy_status status = check_fields(effector, error)) return status;
        from_c(effector, taken[k]);
    }
    if (options.root != BENDY_NONE) {
        if (const bendy_status status = check_index(options.root, joints, "joint", error)) return status;
    }
    bendy::BodyReachOptions wanted;
    from_c(options, wanted);
    auto body = bendy::BodyReach::make(model->get(), taken, wanted);
    if (!body) {
        return fail(error, BENDY_BAD_ARGUMENT,
                    options.root == BENDY_NONE ? "no joint is at or above all effectors"
                                               : "root is not at or above all effectors");
    }
    made = std::make_unique<bendy_body_reach>(bendy_body_reach{model->character, *std::move(body), count}).release();
    return BENDY_OK;
}

uint32_t bendy_body_reach_root(const bendy_body_reach* body) {
    return body == nullptr ? BENDY_NONE : body->body.root();
}

bendy_status bendy::capi::reach_body(bendy_pose* pose, bendy_body_reach* body, const bendy_effector_target* targets,
                                     size_t count, bendy_body_reached& result, bendy_error* error) {
    if (count != body->effectors) {
        return fail(error, BENDY_BAD_ARGUMENT,
                    "expected a target for each of " + std::to_string(body->effectors) + " effectors, found " +
                        std::to_string(count));
    }
    if (const bendy_status status = check_array(targets, count, "targets", error)) return status;
    std::array<bendy::EffectorTarget, BodyReach::kMostEffectors> taken;
    for (std::size_t k = 0; k < count; ++k) {
        bendy_effector_target target = BENDY_EFFECTOR_TARGET_INIT;
        if (const bendy_status status = take(at(targets, k), "targets", target, error)) return status;
        if (const bendy_status status = check_fields(target, error)) return status;
        from_c(target, taken[k]);
    }
    const auto reached = bendy::reach(pose->pose, body->body, std::span(taken.data(), count));
    if (!reached) return fail(error, BENDY_BAD_ARGUMENT, "the pose holds numbers that are not finite");
    to_c(*reached, result);
    return BENDY_OK;
}
