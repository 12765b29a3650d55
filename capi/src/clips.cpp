// What is in a clip: tracks, markers, and the frames of meshes that it plays.
#include "fail.h"
#include "handles.h"
#include "lookup.h"

#include <bendy/runtime/sample.h>

#include <span>

namespace bendy::capi {
namespace {

bendy_status check_track(const bendy_model* model, std::uint32_t clip, std::uint32_t track, bendy_error* error) {
    return check_in_clip(model, clip, &Clip::tracks, track, "track", error);
}

bendy_status check_sequence(const bendy_model* model, std::uint32_t clip, std::uint32_t sequence, bendy_error* error) {
    return check_in_clip(model, clip, &Clip::plays, sequence, "frame sequence", error);
}

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

uint32_t bendy_track_count(const bendy_model* model, uint32_t clip) {
    return count_in_clip(model, clip, &bendy::Clip::tracks);
}

bendy_status bendy_get_track(const bendy_model* model, uint32_t clip, uint32_t track, bendy_track* out,
                             bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_track(model, clip, track, error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        const bendy::TrackView& view = model->get().clips()[clip].tracks[track];
        put(*out,
            {0, static_cast<std::uint32_t>(view.path), static_cast<std::uint32_t>(view.interpolation), view.target,
             view.components, view.keys, view.times.empty() ? nullptr : view.times.data(), view.values.data()});
        return BENDY_OK;
    });
}

bendy_status bendy_sample_track(const bendy_model* model, uint32_t clip, uint32_t track, float seconds, float* values,
                                size_t count, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_track(model, clip, track, error)) return status;
        if (const bendy_status status = check_seconds(seconds, error)) return status;
        if (const bendy_status status = check_pointer(values, "values", error)) return status;
        const bendy::Clip& view = model->get().clips()[clip];
        const std::uint32_t components = view.tracks[track].components;
        if (const bendy_status status = check_room(count, components, "values", error)) return status;
        bendy::sample_track(view.tracks[track], view, seconds, std::span(values, components));
        return BENDY_OK;
    });
}

uint32_t bendy_packed_frame_count(const bendy_model* model, uint32_t clip) {
    if (model == nullptr || clip >= model->get().clips().size()) return 0;
    const bendy::Clip& view = model->get().clips()[clip];
    return view.packed ? view.packed->record.frames : 0;
}

bendy_status bendy_packed_frame_times(const bendy_model* model, uint32_t clip, float* times, size_t count,
                                      bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_clip(model, clip, error)) return status;
        const std::uint32_t frames = bendy_packed_frame_count(model, clip);
        if (const bendy_status status = check_room(count, frames, "times", error)) return status;
        if (frames == 0) return BENDY_OK;
        if (const bendy_status status = check_pointer(times, "times", error)) return status;
        const bendy::PackedView& packed = *model->get().clips()[clip].packed;
        for (std::uint32_t frame = 0; frame < frames; ++frame) times[frame] = static_cast<float>(packed.time_of(frame));
        return BENDY_OK;
    });
}

uint32_t bendy_marker_count(const bendy_model* model, uint32_t clip) {
    return count_in_clip(model, clip, &bendy::Clip::markers);
}

bendy_status bendy_get_marker(const bendy_model* model, uint32_t clip, uint32_t marker, bendy_marker* out,
                              bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_in_clip(model, clip, &bendy::Clip::markers, marker, "marker", error))
            return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        put(*out, {0, model->get().clips()[clip].markers[marker].seconds,
                   model->character->names.markers[clip][marker].c_str()});
        return BENDY_OK;
    });
}

uint32_t bendy_frame_sequence_count(const bendy_model* model, uint32_t clip) {
    return count_in_clip(model, clip, &bendy::Clip::plays);
}

bendy_status bendy_get_frame_sequence(const bendy_model* model, uint32_t clip, uint32_t sequence,
                                      bendy_frame_sequence* out, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_sequence(model, clip, sequence, error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        const bendy::PlayView& view = model->get().clips()[clip].plays[sequence];
        put(*out, {0, view.mesh, view.first, view.frames, view.closed ? 1U : 0U});
        return BENDY_OK;
    });
}

bendy_status bendy_mix_frames(const bendy_model* model, uint32_t clip, uint32_t sequence, float seconds,
                              bendy_frame_mix* out, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_sequence(model, clip, sequence, error)) return status;
        if (const bendy_status status = check_seconds(seconds, error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        const bendy::Clip& view = model->get().clips()[clip];
        const bendy::FrameMix mix = bendy::mix_frames(view.plays[sequence], view, seconds);
        put(*out, {0, mix.left, mix.right, mix.fraction});
        return BENDY_OK;
    });
}
