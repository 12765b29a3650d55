// Poses of one model on another one of different build.
#include "calls.h"
#include "fail.h"
#include "fields.h"
#include "handles.h"
#include "lookup.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <utility>

using namespace bendy::capi;

bendy_status bendy::capi::retarget_new(const bendy_model* source, const bendy_model* target,
                                       const bendy_retarget_options& options, bendy_retarget*& made,
                                       bendy_error* error) {
    bendy::RetargetOptions taken;
    from_c(options, taken);
    auto retarget = bendy::Retarget::make(source->get(), target->get(), taken);
    if (!retarget) return fail(error, BENDY_BAD_ARGUMENT, error_text(retarget.error()));
    made = std::make_unique<bendy_retarget>(bendy_retarget{source->character, target->character, *std::move(retarget)})
               .release();
    return BENDY_OK;
}

float bendy_retarget_scale(const bendy_retarget* retarget) {
    return retarget == nullptr ? 0.0f : retarget->retarget.scale();
}

const uint32_t* bendy_retarget_joints(const bendy_retarget* retarget) {
    return retarget == nullptr ? nullptr : first_of(retarget->retarget.joints());
}

const uint32_t* bendy_retarget_morph_targets(const bendy_retarget* retarget) {
    return retarget == nullptr ? nullptr : first_of(retarget->retarget.morph_targets());
}

bendy_status bendy::capi::retarget_state_new(bendy_retarget_state*& made, bendy_error* /*error*/) {
    made = std::make_unique<bendy_retarget_state>().release();
    return BENDY_OK;
}

bendy_status bendy::capi::retarget_state_reset(bendy_retarget_state* state, bendy_error* /*error*/) {
    state->state = {};
    return BENDY_OK;
}

bendy_status bendy::capi::retarget_pose(bendy_pose* pose, bendy_retarget* retarget, bendy_pose* source,
                                        bendy_retarget_state* state, const float* contacts, float seconds,
                                        bendy_retargeted& result, bendy_error* error) {
    if (source->character != retarget->source)
        return fail(error, BENDY_BAD_ARGUMENT, "source is of another model than the source of the retargeting");
    if (pose == source) return fail(error, BENDY_BAD_ARGUMENT, "source is the pose itself");
    std::optional<bendy::ContactWeights> given;
    if (contacts != nullptr) std::copy_n(contacts, bendy::kContacts, given.emplace().begin());
    const auto retargeted = bendy::retarget(pose->pose, retarget->retarget, source->pose, state->state, given, seconds);
    if (!retargeted) return fail(error, BENDY_BAD_ARGUMENT, error_text(retargeted.error()));
    to_c(*retargeted, result);
    return BENDY_OK;
}
