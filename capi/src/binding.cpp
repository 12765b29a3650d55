// Clips of one model on another.
#include "fail.h"
#include "handles.h"
#include "lookup.h"

#include <memory>
#include <span>

namespace bendy::capi {
namespace {

bendy_status take_options(const bendy_binding_options* options, std::size_t joints, BindingOptions& taken,
                          bendy_error* error) {
    bendy_binding_options values = BENDY_BINDING_OPTIONS_INIT;
    if (const bendy_status status = take(options, "options", values, error)) return status;
    if (const bendy_status status =
            check_value(values.translations, BENDY_TRANSLATIONS_ROOT_ONLY + 1, "kind of translations", error))
        return status;
    if (values.root != BENDY_NONE) {
        if (const bendy_status status = check_index(values.root, joints, "joint", error)) return status;
    }
    if (const bendy_status status = check_finite(std::span(&values.root_scale, 1), "root_scale", error)) return status;
    taken = {static_cast<BoundTranslations>(values.translations), values.root, values.root_scale};
    return BENDY_OK;
}

using NumberList = std::span<const std::uint32_t> (Binding::*)() const;

const std::uint32_t* numbers_of(const bendy_binding* binding, NumberList list) {
    if (binding == nullptr) return nullptr;
    const auto numbers = (binding->binding.*list)();
    return numbers.empty() ? nullptr : numbers.data();
}

const std::uint32_t* counted(const bendy_binding* binding, NumberList list, std::size_t* count, bendy_error* error) {
    const std::uint32_t* numbers = nullptr;
    guarded(error, [&] {
        if (const bendy_status status = check_pointer(binding, "binding", error)) return status;
        if (const bendy_status status = check_pointer(count, "count", error)) return status;
        numbers = numbers_of(binding, list);
        *count = (binding->binding.*list)().size();
        return BENDY_OK;
    });
    return numbers;
}

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

bendy_binding* bendy_binding_new(const bendy_model* animated, const bendy_model* posed,
                                 const bendy_binding_options* options, bendy_error* error) {
    bendy_binding* binding = nullptr;
    guarded(error, [&] {
        if (const bendy_status status = check_pointer(animated, "animated", error)) return status;
        if (const bendy_status status = check_pointer(posed, "posed", error)) return status;
        bendy::BindingOptions taken;
        if (const bendy_status status = take_options(options, posed->get().joints().size(), taken, error))
            return status;
        binding = std::make_unique<bendy_binding>(animated->character, posed->character, taken).release();
        return BENDY_OK;
    });
    return binding;
}

void bendy_binding_free(bendy_binding* binding) {
    delete binding;
}

bendy_status bendy_sample_bound(bendy_pose* pose, bendy_binding* binding, uint32_t clip, float seconds,
                                bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(binding, "binding", error)) return status;
        if (const bendy_status status = check_pose_of(pose, *binding->posed, "pose", "binding", error)) return status;
        if (const bendy_status status = check_clip_of(*binding->animated, clip, error)) return status;
        if (const bendy_status status = check_seconds(seconds, error)) return status;
        const bendy::Clip& view = binding->animated->model.clips()[clip];
        return from_call(bendy::sample(pose->pose, binding->binding, &view, seconds), error);
    });
}

const uint32_t* bendy_binding_joints(const bendy_binding* binding) {
    return numbers_of(binding, &bendy::Binding::joints);
}

const uint32_t* bendy_binding_targets(const bendy_binding* binding) {
    return numbers_of(binding, &bendy::Binding::targets);
}

const uint32_t* bendy_binding_unmatched_joints(const bendy_binding* binding, size_t* count, bendy_error* error) {
    return counted(binding, &bendy::Binding::unmatched_joints, count, error);
}

const uint32_t* bendy_binding_unmatched_targets(const bendy_binding* binding, size_t* count, bendy_error* error) {
    return counted(binding, &bendy::Binding::unmatched_targets, count, error);
}
