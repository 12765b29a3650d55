// The named curves of a clip.
#include "fail.h"
#include "handles.h"
#include "lookup.h"

#include <bendy/runtime/curve.h>

#include <span>
#include <string>

using namespace bendy::capi;

uint32_t bendy_curve_count(const bendy_model* model, uint32_t clip) {
    return count_in_clip(model, clip, &bendy::Clip::curves);
}

uint32_t bendy_find_curve(const bendy_model* model, uint32_t clip, const char* name_or_path, bendy_error* error) {
    std::uint32_t number = BENDY_NONE;
    guarded(error, [&] {
        if (const bendy_status status = check_clip(model, clip, error)) return status;
        if (const bendy_status status = check_pointer(name_or_path, "name_or_path", error)) return status;
        const bendy::Clip& view = model->get().clips()[clip];
        const bendy::Curve* const found = bendy::find_curve(view, name_or_path);
        if (found == nullptr) {
            return fail(error, BENDY_NOT_FOUND,
                        std::string("the clip has no curve \"") + name_or_path + "\", by name or by path");
        }
        number = static_cast<std::uint32_t>(found - view.curves.data());
        return BENDY_OK;
    });
    return number;
}

uint32_t bendy_find_curve_of(const bendy_model* model, uint32_t clip, uint32_t target_kind, uint32_t target,
                             const char* path, bendy_error* error) {
    std::uint32_t number = BENDY_NONE;
    guarded(error, [&] {
        if (const bendy_status status = check_clip(model, clip, error)) return status;
        if (const bendy_status status = check_value(target_kind, bendy::kCurveTargets, "kind of target", error))
            return status;
        if (const bendy_status status = check_pointer(path, "path", error)) return status;
        const bendy::Clip& view = model->get().clips()[clip];
        const bendy::Curve* const found =
            bendy::find_curve(view, static_cast<bendy::CurveTarget>(target_kind), target, path);
        if (found == nullptr)
            return fail(error, BENDY_NOT_FOUND, std::string("the clip has no curve \"") + path + "\" of this target");
        number = static_cast<std::uint32_t>(found - view.curves.data());
        return BENDY_OK;
    });
    return number;
}

bendy_status bendy_get_curve(const bendy_model* model, uint32_t clip, uint32_t curve, bendy_curve* out,
                             bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_in_clip(model, clip, &bendy::Clip::curves, curve, "curve", error))
            return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        const bendy::Curve& view = model->get().clips()[clip].curves[curve];
        const CurveNames& names = model->character->names.curves[clip][curve];
        bendy_curve value{};
        value.components = view.components;
        value.name = names.name.c_str();
        value.path = names.path.c_str();
        value.target_kind = static_cast<std::uint32_t>(view.kind);
        value.target = view.target;
        value.start = view.times.front();
        value.end = view.times.back();
        value.interpolation = static_cast<std::uint32_t>(view.interpolation);
        value.keys = view.keys;
        value.times = view.times.data();
        value.max_error = view.max_error;
        put(*out, value);
        return BENDY_OK;
    });
}

bendy_status bendy_sample_curve(const bendy_model* model, uint32_t clip, uint32_t curve, double seconds, float* values,
                                size_t count, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_in_clip(model, clip, &bendy::Clip::curves, curve, "curve", error))
            return status;
        if (const bendy_status status = check_pointer(values, "values", error)) return status;
        const bendy::Curve& view = model->get().clips()[clip].curves[curve];
        if (const bendy_status status = check_room(count, view.components, "values", error)) return status;
        return from_call(bendy::sample_curve(view, seconds, std::span(values, count)), error);
    });
}

bendy_status bendy_get_curve_values(const bendy_model* model, uint32_t clip, uint32_t curve, float* values,
                                    size_t count, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_in_clip(model, clip, &bendy::Clip::curves, curve, "curve", error))
            return status;
        if (const bendy_status status = check_pointer(values, "values", error)) return status;
        const bendy::Curve& view = model->get().clips()[clip].curves[curve];
        if (const bendy_status status = check_room(count, view.value_count(), "values", error)) return status;
        for (std::size_t k = 0; k < view.value_count(); ++k) values[k] = view.value(k);
        return BENDY_OK;
    });
}
