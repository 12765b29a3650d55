// The named curves of a clip.
#include "calls.h"
#include "fail.h"
#include "fields.h"
#include "handles.h"
#include "lookup.h"

#include <bendy/runtime/curve.h>

#include <span>
#include <string>

using namespace bendy::capi;

bendy_status bendy::capi::find_curve(const bendy_model* model, uint32_t clip, const char* name_or_path, uint32_t& made,
                                     bendy_error* error) {
    const bendy::Clip& view = model->get().clips()[clip];
    const bendy::Curve* const found = bendy::find_curve(view, name_or_path);
    if (found == nullptr) {
        return fail(error, BENDY_NOT_FOUND,
                    std::string("the clip has no curve \"") + name_or_path + "\", by name or by path");
    }
    made = static_cast<std::uint32_t>(found - view.curves.data());
    return BENDY_OK;
}

bendy_status bendy::capi::find_curve_of(const bendy_model* model, uint32_t clip, uint32_t target_kind,
                                        uint32_t target_index, const char* path, uint32_t& made, bendy_error* error) {
    const bendy::Clip& view = model->get().clips()[clip];
    const bendy::Curve* const found =
        bendy::find_curve(view, static_cast<bendy::CurveTarget>(target_kind), target_index, path);
    if (found == nullptr)
        return fail(error, BENDY_NOT_FOUND, std::string("the clip has no curve \"") + path + "\" of this target");
    made = static_cast<std::uint32_t>(found - view.curves.data());
    return BENDY_OK;
}

bendy_status bendy::capi::get_curve(const bendy_model* model, uint32_t clip, uint32_t curve, bendy_curve& out,
                                    bendy_error* /*error*/) {
    const bendy::Curve& view = model->get().clips()[clip].curves[curve];
    const CurveNames& names = model->character->names.curves[clip][curve];
    to_c(view, out);
    out.name = names.name.c_str();
    out.path = names.path.c_str();
    out.target_kind = static_cast<std::uint32_t>(view.kind);
    out.start = view.times.front();
    out.end = view.times.back();
    out.times = view.times.data();
    return BENDY_OK;
}

bendy_status bendy::capi::sample_curve(const bendy_model* model, uint32_t clip, uint32_t curve, double seconds,
                                       float* values, size_t count, bendy_error* error) {
    const bendy::Curve& view = model->get().clips()[clip].curves[curve];
    if (const bendy_status status = check_room(count, view.components, "values", error)) return status;
    return from_call(bendy::sample_curve(view, seconds, std::span(values, count)), error);
}

bendy_status bendy::capi::get_curve_values(const bendy_model* model, uint32_t clip, uint32_t curve, float* values,
                                           size_t count, bendy_error* error) {
    const bendy::Curve& view = model->get().clips()[clip].curves[curve];
    if (const bendy_status status = check_room(count, view.value_count(), "values", error)) return status;
    for (std::size_t k = 0; k < view.value_count(); ++k) values[k] = view.value(k);
    return BENDY_OK;
}
