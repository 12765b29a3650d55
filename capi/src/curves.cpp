// Named curves of clips.
#include "handles.h"
#include "sized.h"

#include <bendy/runtime/curve.h>

#include <span>
#include <string>

namespace bendy::capi {
namespace {

bendy_status check_curve(const bendy_model* model, std::uint32_t clip, std::uint32_t curve, bendy_error* error) {
    if (const bendy_status status = check_pointer(model, "model", error)) return status;
    if (const bendy_status status = check_index(clip, model->get().clips().size(), "clip", error)) return status;
    return check_index(curve, model->get().clips()[clip].curves.size(), "curve", error);
}

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

uint32_t bendy_curve_count(const bendy_model* model, uint32_t clip) {
    if (model == nullptr || clip >= model->get().clips().size()) return 0;
    return static_cast<std::uint32_t>(model->get().clips()[clip].curves.size());
}

uint32_t bendy_find_curve(const bendy_model* model, uint32_t clip, const char* name_or_path, bendy_error* error) {
    std::uint32_t number = BENDY_NONE;
    guarded(error, [&] {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(clip, model->get().clips().size(), "clip", error)) return status;
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

bendy_status bendy_get_curve(const bendy_model* model, uint32_t clip, uint32_t curve, bendy_curve* out,
                             bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_curve(model, clip, curve, error)) return status;
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
        put(*out, value);
        return BENDY_OK;
    });
}

bendy_status bendy_sample_curve(const bendy_model* model, uint32_t clip, uint32_t curve, double seconds, float* values,
                                size_t count, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_curve(model, clip, curve, error)) return status;
        if (const bendy_status status = check_pointer(values, "values", error)) return status;
        const bendy::Curve& view = model->get().clips()[clip].curves[curve];
        if (const bendy_status status = check_room(count, view.components, "values", error)) return status;
        return from_call(bendy::sample_curve(view, seconds, std::span(values, count)), error);
    });
}
