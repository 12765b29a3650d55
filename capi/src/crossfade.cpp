// Clips that fade into one another.
#include "fail.h"
#include "handles.h"
#include "lookup.h"
#include "played.h"

#include <memory>

namespace bendy::capi {
namespace {

static_assert(BENDY_CROSSFADE_MOST == Crossfade::kMost);

bendy_status check_playing(const bendy_crossfade* crossfade, std::uint32_t number, bendy_error* error) {
    if (const bendy_status status = check_pointer(crossfade, "crossfade", error)) return status;
    return check_index(number, crossfade->crossfade.playing().size(), "playing clip", error, "the crossfade");
}

bendy_status check_any_plays(const Crossfade& crossfade, bendy_error* error) {
    if (!crossfade.playing().empty()) return BENDY_OK;
    return fail(error, BENDY_BAD_ARGUMENT, "the crossfade plays no clip");
}

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

bendy_crossfade* bendy_crossfade_new(const bendy_model* model, bendy_error* error) {
    bendy_crossfade* crossfade = nullptr;
    guarded(error, [&] {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        crossfade = std::make_unique<bendy_crossfade>(bendy_crossfade{model->character, {}}).release();
        return BENDY_OK;
    });
    return crossfade;
}

void bendy_crossfade_free(bendy_crossfade* crossfade) {
    delete crossfade;
}

bendy_status bendy_crossfade_play(bendy_crossfade* crossfade, uint32_t clip, const bendy_playback* playback,
                                  float fade_seconds, uint32_t easing, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(crossfade, "crossfade", error)) return status;
        if (const bendy_status status = check_clip_of(*crossfade->character, clip, error)) return status;
        if (const bendy_status status = check_finite(std::span(&fade_seconds, 1), "fade_seconds", error)) return status;
        if (const bendy_status status = check_value(easing, kEasings, "easing", error)) return status;
        const bendy::Clip& view = crossfade->character->model.clips()[clip];
        crossfade->crossfade.play(view, playback == nullptr ? bendy::Playback(view) : playback->playback, fade_seconds,
                                  static_cast<bendy::Easing>(easing));
        return BENDY_OK;
    });
}

bendy_status bendy_crossfade_advance(bendy_crossfade* crossfade, double seconds, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(crossfade, "crossfade", error)) return status;
        if (const bendy_status status = check_double(seconds, "seconds", error)) return status;
        crossfade->crossfade.advance(seconds);
        return BENDY_OK;
    });
}

uint32_t bendy_crossfade_count(const bendy_crossfade* crossfade) {
    return crossfade == nullptr ? 0 : static_cast<uint32_t>(crossfade->crossfade.playing().size());
}

bendy_status bendy_get_playing(const bendy_crossfade* crossfade, uint32_t number, bendy_playing* out,
                               bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_playing(crossfade, number, error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        const bendy::Playing& playing = crossfade->crossfade.playing()[number];
        const auto clip = static_cast<std::uint32_t>(playing.clip - crossfade->character->model.clips().data());
        put(*out, {0, clip, playing.playback.seconds(), playing.fade.weight(), playing.share});
        return BENDY_OK;
    });
}

bendy_status bendy_get_played(const bendy_crossfade* crossfade, uint32_t number, bendy_played* out,
                              bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_playing(crossfade, number, error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        put(*out, to_c(crossfade->crossfade.playing()[number].played));
        return BENDY_OK;
    });
}

bendy_status bendy_crossfade_get_playback(const bendy_crossfade* crossfade, uint32_t number, bendy_playback* playback,
                                          bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_playing(crossfade, number, error)) return status;
        if (const bendy_status status = check_pointer(playback, "playback", error)) return status;
        playback->playback = crossfade->crossfade.playing()[number].playback;
        return BENDY_OK;
    });
}

bendy_status bendy_crossfade_set_playback(bendy_crossfade* crossfade, const bendy_playback* playback,
                                          bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(crossfade, "crossfade", error)) return status;
        if (const bendy_status status = check_pointer(playback, "playback", error)) return status;
        if (const bendy_status status = check_any_plays(crossfade->crossfade, error)) return status;
        *crossfade->crossfade.playback() = playback->playback;
        return BENDY_OK;
    });
}

bendy_status bendy_sample_crossfade(bendy_pose* pose, const bendy_crossfade* crossfade, bendy_pose* scratch,
                                    bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(crossfade, "crossfade", error)) return status;
        const Character& character = *crossfade->character;
        if (const bendy_status status = check_pose_of(pose, character, "pose", "crossfade", error)) return status;
        if (const bendy_status status = check_pose_of(scratch, character, "scratch", "crossfade", error)) return status;
        if (pose == scratch) return fail(error, BENDY_BAD_ARGUMENT, "scratch is the pose itself");
        if (const bendy_status status = check_any_plays(crossfade->crossfade, error)) return status;
        return from_call(bendy::sample(pose->pose, crossfade->crossfade, scratch->pose), error);
    });
}
