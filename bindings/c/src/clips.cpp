// The contents of a clip: tracks, markers, and the mesh frames that it plays.
#include "calls.h"
#include "fail.h"
#include "fields.h"
#include "handles.h"
#include "lookup.h"

#include <bendy/runtime/sample.h>

#include <span>

using namespace bendy::capi;

bendy_status bendy::capi::get_track(const bendy_model* model, uint32_t clip, uint32_t track, bendy_track& out,
                                    bendy_error* /*error*/) {
    const bendy::TrackView& view = model->get().clips()[clip].tracks[track];
    out = {0,
           static_cast<std::uint32_t>(view.path),
           static_cast<std::uint32_t>(view.interpolation),
           view.target,
           view.components,
           view.keys,
           view.times.empty() ? nullptr : view.times.data(),
           view.values.data()};
    return BENDY_OK;
}

bendy_status bendy::capi::sample_track(const bendy_model* model, uint32_t clip, uint32_t track, float seconds,
                                       float* values, size_t count, bendy_error* error) {
    const bendy::Clip& view = model->get().clips()[clip];
    const std::uint32_t components = view.tracks[track].components;
    if (const bendy_status status = check_room(count, components, "values", error)) return status;
    bendy::sample_track(view.tracks[track], view, seconds, std::span(values, components));
    return BENDY_OK;
}

uint32_t bendy_packed_frame_count(const bendy_model* model, uint32_t clip) {
    if (model == nullptr || clip >= model->get().clips().size()) return 0;
    const bendy::Clip& view = model->get().clips()[clip];
    return view.packed ? view.packed->record.frames : 0;
}

bendy_status bendy::capi::packed_frame_times(const bendy_model* model, uint32_t clip, float* times, size_t count,
                                             bendy_error* error) {
    const std::uint32_t frames = bendy_packed_frame_count(model, clip);
    if (const bendy_status status = check_room(count, frames, "times", error)) return status;
    if (frames == 0) return BENDY_OK;
    if (const bendy_status status = check_pointer(times, "times", error)) return status;
    const bendy::PackedView& packed = *model->get().clips()[clip].packed;
    for (std::uint32_t frame = 0; frame < frames; ++frame) times[frame] = static_cast<float>(packed.time_of(frame));
    return BENDY_OK;
}

bendy_status bendy::capi::get_marker(const bendy_model* model, uint32_t clip, uint32_t marker, bendy_marker& out,
                                     bendy_error* /*error*/) {
    out = {0, model->get().clips()[clip].markers[marker].seconds,
           model->character->names.markers[clip][marker].c_str()};
    return BENDY_OK;
}

bendy_status bendy::capi::get_frame_sequence(const bendy_model* model, uint32_t clip, uint32_t frame_sequence,
                                             bendy_frame_sequence& out, bendy_error* /*error*/) {
    const bendy::PlayRecord& view = model->get().clips()[clip].plays[frame_sequence];
    out = {0, view.mesh, view.first, view.frames, view.closed};
    return BENDY_OK;
}

bendy_status bendy::capi::mix_frames(const bendy_model* model, uint32_t clip, uint32_t frame_sequence, float seconds,
                                     bendy_frame_mix& out, bendy_error* /*error*/) {
    const bendy::Clip& view = model->get().clips()[clip];
    const bendy::FrameMix mix = bendy::mix_frames(view.plays[frame_sequence], view, seconds);
    out = {0, mix.left, mix.right, mix.fraction};
    return BENDY_OK;
}
