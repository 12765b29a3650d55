// Clips of one model on another.
#include "calls.h"
#include "fail.h"
#include "fields.h"
#include "handles.h"
#include "lookup.h"

#include <memory>
#include <span>

namespace bendy::capi {
namespace {

using NumberList = std::span<const std::uint32_t> (Binding::*)() const;

const std::uint32_t* numbers_of(const bendy_binding* binding, NumberList list) {
    return binding == nullptr ? nullptr : first_of((binding->binding.*list)());
}

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy::capi::binding_new(const bendy_model* animated, const bendy_model* posed,
                                      const bendy_binding_options& options, bendy_binding*& made, bendy_error* error) {
    bendy::BindingOptions taken;
    from_c(options, taken);
    if (taken.root != BENDY_NONE) {
        if (const bendy_status status = check_index(taken.root, parts(*posed).joint(), "joint", error)) return status;
    }
    made = std::make_unique<bendy_binding>(animated->character, posed->character, taken).release();
    return BENDY_OK;
}

bendy_status bendy::capi::sample_bound(bendy_pose* pose, bendy_binding* binding, uint32_t clip, float seconds,
                                       bendy_error* error) {
    const bendy::Clip& view = binding->animated->model.clips()[clip];
    return from_call(bendy::sample(pose->pose, binding->binding, &view, seconds), error);
}

const uint32_t* bendy_binding_joints(const bendy_binding* binding) {
    return numbers_of(binding, &bendy::Binding::joints);
}

const uint32_t* bendy_binding_targets(const bendy_binding* binding) {
    return numbers_of(binding, &bendy::Binding::targets);
}

bendy_status bendy::capi::binding_unmatched_joints(const bendy_binding* binding, size_t* count, const uint32_t*& made,
                                                   bendy_error* /*error*/) {
    made = numbers_of(binding, &bendy::Binding::unmatched_joints);
    *count = binding->binding.unmatched_joints().size();
    return BENDY_OK;
}

bendy_status bendy::capi::binding_unmatched_targets(const bendy_binding* binding, size_t* count, const uint32_t*& made,
                                                    bendy_error* /*error*/) {
    made = numbers_of(binding, &bendy::Binding::unmatched_targets);
    *count = binding->binding.unmatched_targets().size();
    return BENDY_OK;
}
