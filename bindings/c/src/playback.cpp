// The clocks of clips, the markers that they pass, and fades.
#include "calls.h"
#include "fail.h"
#include "fields.h"
#include "handles.h"
#include "lookup.h"

#include <bendy/runtime/markers.h>

#include <memory>

using namespace bendy::capi;

bendy_status bendy::capi::playback_new(const bendy_model* model, uint32_t clip, bendy_playback*& made,
                                       bendy_error* /*error*/) {
    made = std::make_unique<bendy_playback>(bendy_playback{bendy::Playback(model->get().clips()[clip])}).release();
    return BENDY_OK;
}

bendy_status bendy::capi::playback_new_range(float start, float end, uint32_t mode, bendy_playback*& made,
                                             bendy_error* /*error*/) {
    const bendy::Playback clock(start, end, static_cast<bendy::LoopMode>(mode));
    made = std::make_unique<bendy_playback>(bendy_playback{clock}).release();
    return BENDY_OK;
}

bendy_status bendy::capi::get_playback(const bendy_playback* playback, bendy_playback_info& out,
                                       bendy_error* /*error*/) {
    const bendy::Playback& from = playback->playback;
    out = {0,
           static_cast<std::uint32_t>(from.mode()),
           from.seconds(),
           from.is_done() ? 1U : 0U,
           from.start(),
           from.end(),
           from.share(),
           from.speed(),
           from.passes()};
    return BENDY_OK;
}

bendy_status bendy::capi::playback_advance(bendy_playback* playback, double seconds, bendy_played& played,
                                           bendy_error* /*error*/) {
    to_c(playback->playback.advance(seconds), played);
    return BENDY_OK;
}

bendy_status bendy::capi::playback_set_speed(bendy_playback* playback, double speed, bendy_error* /*error*/) {
    playback->playback.set_speed(speed);
    return BENDY_OK;
}

bendy_status bendy::capi::playback_set_mode(bendy_playback* playback, uint32_t mode, bendy_error* /*error*/) {
    playback->playback.set_mode(static_cast<bendy::LoopMode>(mode));
    return BENDY_OK;
}

bendy_status bendy::capi::playback_seek(bendy_playback* playback, double seconds, bendy_error* /*error*/) {
    playback->playback.seek(seconds);
    return BENDY_OK;
}

bendy_status bendy::capi::playback_seek_share(bendy_playback* playback, double share, bendy_error* /*error*/) {
    playback->playback.seek_share(share);
    return BENDY_OK;
}

bendy_status bendy::capi::count_markers(const bendy_model* model, uint32_t clip, const bendy_played& played,
                                        uint64_t* count, bendy_error* /*error*/) {
    bendy::PlayedInterval taken;
    from_c(played, taken);
    *count = bendy::count_markers(model->get().clips()[clip].markers, taken);
    return BENDY_OK;
}

bendy_status bendy::capi::collect_markers(const bendy_model* model, uint32_t clip, const bendy_played& played,
                                          uint32_t* markers, size_t capacity, size_t* count, bendy_error* error) {
    bendy::PlayedInterval taken;
    from_c(played, taken);
    if (capacity != 0) {
        if (const bendy_status status = check_pointer(markers, "markers", error)) return status;
    }
    *count = 0;
    if (capacity == 0) return BENDY_OK;
    const std::vector<bendy::Marker>& all = model->get().clips()[clip].markers;
    bendy::visit_markers(all, taken, [&](const bendy::Marker& marker) {
        markers[(*count)++] = static_cast<std::uint32_t>(&marker - all.data());
        return *count < capacity;
    });
    return BENDY_OK;
}

float bendy_ease(uint32_t easing, float share) {
    return bendy::ease(easing == BENDY_EASING_SMOOTH ? bendy::Easing::smooth : bendy::Easing::linear, share);
}

bendy_status bendy::capi::fade_new(float weight, bendy_fade*& made, bendy_error* /*error*/) {
    made = std::make_unique<bendy_fade>(bendy_fade{bendy::Fade(weight)}).release();
    return BENDY_OK;
}

bendy_status bendy::capi::fade_to(bendy_fade* fade, float weight, float seconds, uint32_t easing,
                                  bendy_error* /*error*/) {
    fade->fade.to(weight, seconds, static_cast<bendy::Easing>(easing));
    return BENDY_OK;
}

bendy_status bendy::capi::fade_advance(bendy_fade* fade, double seconds, bendy_error* /*error*/) {
    fade->fade.advance(seconds);
    return BENDY_OK;
}

float bendy_fade_weight(const bendy_fade* fade) {
    return fade == nullptr ? 0.0f : fade->fade.weight();
}

uint32_t bendy_fade_is_done(const bendy_fade* fade) {
    return fade == nullptr || fade->fade.is_done() ? 1 : 0;
}
