// The clocks of clips, the markers that they pass, and fades.
#include "fail.h"
#include "handles.h"
#include "lookup.h"
#include "played.h"

#include <bendy/runtime/markers.h>

#include <memory>

namespace bendy::capi {
namespace {

constexpr std::uint32_t kLoopModes = BENDY_LOOP_PING_PONG + 1;

/// Returns change(playback) for the numbers that setters take: both must be given, `number` must be finite.
template <class Change>
bendy_status change(bendy_playback* playback, double number, const char* name, bendy_error* error, const Change& with) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(playback, "playback", error)) return status;
        if (const bendy_status status = check_double(number, name, error)) return status;
        with(playback->playback);
        return BENDY_OK;
    });
}

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

bendy_playback* bendy_playback_new(const bendy_model* model, uint32_t clip, bendy_error* error) {
    bendy_playback* playback = nullptr;
    guarded(error, [&] {
        if (const bendy_status status = check_clip(model, clip, error)) return status;
        playback =
            std::make_unique<bendy_playback>(bendy_playback{bendy::Playback(model->get().clips()[clip])}).release();
        return BENDY_OK;
    });
    return playback;
}

bendy_playback* bendy_playback_new_range(float start, float end, uint32_t mode, bendy_error* error) {
    bendy_playback* playback = nullptr;
    guarded(error, [&] {
        const float times[]{start, end};
        if (const bendy_status status = check_finite(times, "the range", error)) return status;
        if (const bendy_status status = check_value(mode, kLoopModes, "loop mode", error)) return status;
        const bendy::Playback made(start, end, static_cast<bendy::LoopMode>(mode));
        playback = std::make_unique<bendy_playback>(bendy_playback{made}).release();
        return BENDY_OK;
    });
    return playback;
}

void bendy_playback_free(bendy_playback* playback) {
    delete playback;
}

bendy_status bendy_get_playback(const bendy_playback* playback, bendy_playback_info* out, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(playback, "playback", error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        const bendy::Playback& from = playback->playback;
        put(*out, {0, static_cast<std::uint32_t>(from.mode()), from.seconds(), from.is_done() ? 1U : 0U, from.start(),
                   from.end(), from.share(), from.speed(), from.passes()});
        return BENDY_OK;
    });
}

bendy_status bendy_playback_advance(bendy_playback* playback, double seconds, bendy_played* played,
                                    bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(playback, "playback", error)) return status;
        if (const bendy_status status = check_double(seconds, "seconds", error)) return status;
        if (played != nullptr) {
            if (const bendy_status status = check_out(played, "played", error)) return status;
        }
        const bendy::PlayedInterval interval = playback->playback.advance(seconds);
        if (played != nullptr) put(*played, to_c(interval));
        return BENDY_OK;
    });
}

bendy_status bendy_playback_set_speed(bendy_playback* playback, double speed, bendy_error* error) {
    return change(playback, speed, "speed", error, [&](bendy::Playback& changed) { changed.set_speed(speed); });
}

bendy_status bendy_playback_set_mode(bendy_playback* playback, uint32_t mode, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(playback, "playback", error)) return status;
        if (const bendy_status status = check_value(mode, kLoopModes, "loop mode", error)) return status;
        playback->playback.set_mode(static_cast<bendy::LoopMode>(mode));
        return BENDY_OK;
    });
}

bendy_status bendy_playback_seek(bendy_playback* playback, double seconds, bendy_error* error) {
    return change(playback, seconds, "seconds", error, [&](bendy::Playback& changed) { changed.seek(seconds); });
}

bendy_status bendy_playback_seek_share(bendy_playback* playback, double share, bendy_error* error) {
    return change(playback, share, "share", error, [&](bendy::Playback& changed) { changed.seek_share(share); });
}

bendy_status bendy_count_markers(const bendy_model* model, uint32_t clip, const bendy_played* played, uint64_t* count,
                                 bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_clip(model, clip, error)) return status;
        bendy::PlayedInterval taken;
        if (const bendy_status status = take_played(played, taken, error)) return status;
        if (const bendy_status status = check_pointer(count, "count", error)) return status;
        *count = bendy::count_markers(model->get().clips()[clip].markers, taken);
        return BENDY_OK;
    });
}

bendy_status bendy_collect_markers(const bendy_model* model, uint32_t clip, const bendy_played* played,
                                   uint32_t* markers, size_t capacity, size_t* count, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_clip(model, clip, error)) return status;
        bendy::PlayedInterval taken;
        if (const bendy_status status = take_played(played, taken, error)) return status;
        if (const bendy_status status = check_pointer(count, "count", error)) return status;
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
    });
}

float bendy_ease(uint32_t easing, float share) {
    return bendy::ease(easing == BENDY_EASING_SMOOTH ? bendy::Easing::smooth : bendy::Easing::linear, share);
}

bendy_fade* bendy_fade_new(float weight, bendy_error* error) {
    bendy_fade* fade = nullptr;
    guarded(error, [&] {
        if (const bendy_status status = check_finite(std::span(&weight, 1), "weight", error)) return status;
        fade = std::make_unique<bendy_fade>(bendy_fade{bendy::Fade(weight)}).release();
        return BENDY_OK;
    });
    return fade;
}

void bendy_fade_free(bendy_fade* fade) {
    delete fade;
}

bendy_status bendy_fade_to(bendy_fade* fade, float weight, float seconds, uint32_t easing, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(fade, "fade", error)) return status;
        if (const bendy_status status = check_finite(std::span(&weight, 1), "weight", error)) return status;
        if (const bendy_status status = check_finite(std::span(&seconds, 1), "seconds", error)) return status;
        if (const bendy_status status = check_value(easing, kEasings, "easing", error)) return status;
        fade->fade.to(weight, seconds, static_cast<bendy::Easing>(easing));
        return BENDY_OK;
    });
}

bendy_status bendy_fade_advance(bendy_fade* fade, double seconds, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(fade, "fade", error)) return status;
        if (const bendy_status status = check_double(seconds, "seconds", error)) return status;
        fade->fade.advance(seconds);
        return BENDY_OK;
    });
}

float bendy_fade_weight(const bendy_fade* fade) {
    return fade == nullptr ? 0.0f : fade->fade.weight();
}

uint32_t bendy_fade_is_done(const bendy_fade* fade) {
    return fade == nullptr || fade->fade.is_done() ? 1 : 0;
}
