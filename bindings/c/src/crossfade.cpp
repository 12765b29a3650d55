// Cross-fades between clips.
#include "calls.h"
#include "fail.h"
#include "fields.h"
#include "handles.h"
#include "lookup.h"

#include <memory>

namespace bendy::capi {
namespace {

static_assert(BENDY_CROSSFADE_MOST == Crossfade::kMost);

bendy_status check_playing(const bendy_crossfade* crossfade, std::uint32_t number, bendy_error* error) {
    return check_index(number, crossfade->crossfade.playing().size(), "playing clip", error, "the crossfade");
}

bendy_status check_any_plays(const Crossfade& crossfade, bendy_error* error) {
    if (!crossfade.playing().empty()) return BENDY_OK;
    return fail(error, BENDY_BAD_ARGUMENT, "the crossfade plays no clip");
}

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy::capi::crossfade_new(const bendy_model* model, bendy_crossfade*& made, bendy_error* /*error*/) {
    made = std::make_unique<bendy_crossfade>(bendy_crossfade{model->character, {}}).release();
    return BENDY_OK;
}

bendy_status bendy::capi::crossfade_play(bendy_crossfade* crossfade, uint32_t clip, const bendy_playback* playback,
                                         float fade_seconds, uint32_t easing, bendy_error* /*error*/) {
    const bendy::Clip& view = crossfade->character->model.clips()[clip];
    crossfade->crossfade.play(view, playback == nullptr ? bendy::Playback(view) : playback->playback, fade_seconds,
                              static_cast<bendy::Easing>(easing));
    return BENDY_OK;
}

bendy_status bendy::capi::crossfade_advance(bendy_crossfade* crossfade, double seconds, bendy_error* /*error*/) {
    crossfade->crossfade.advance(seconds);
    return BENDY_OK;
}

uint32_t bendy_crossfade_count(const bendy_crossfade* crossfade) {
    return crossfade == nullptr ? 0 : static_cast<uint32_t>(crossfade->crossfade.playing().size());
}

bendy_status bendy::capi::get_playing(const bendy_crossfade* crossfade, uint32_t number, bendy_playing& out,
                                      bendy_error* error) {
    if (const bendy_status status = check_playing(crossfade, number, error)) return status;
    const bendy::Playing& playing = crossfade->crossfade.playing()[number];
    const auto clip = static_cast<std::uint32_t>(playing.clip - crossfade->character->model.clips().data());
    out = {0, clip, playing.playback.seconds(), playing.fade.weight(), playing.share};
    return BENDY_OK;
}

bendy_status bendy::capi::get_played(const bendy_crossfade* crossfade, uint32_t number, bendy_played& out,
                                     bendy_error* error) {
    if (const bendy_status status = check_playing(crossfade, number, error)) return status;
    to_c(crossfade->crossfade.playing()[number].played, out);
    return BENDY_OK;
}

bendy_status bendy::capi::crossfade_get_playback(const bendy_crossfade* crossfade, uint32_t number,
                                                 bendy_playback* playback, bendy_error* error) {
    if (const bendy_status status = check_playing(crossfade, number, error)) return status;
    playback->playback = crossfade->crossfade.playing()[number].playback;
    return BENDY_OK;
}

bendy_status bendy::capi::crossfade_set_playback(bendy_crossfade* crossfade, const bendy_playback* playback,
                                                 bendy_error* error) {
    if (const bendy_status status = check_any_plays(crossfade->crossfade, error)) return status;
    *crossfade->crossfade.playback() = playback->playback;
    return BENDY_OK;
}

bendy_status bendy::capi::sample_crossfade(bendy_pose* pose, const bendy_crossfade* crossfade, bendy_pose* scratch,
                                           bendy_error* error) {
    if (pose == scratch) return fail(error, BENDY_BAD_ARGUMENT, "scratch is the pose itself");
    if (const bendy_status status = check_any_plays(crossfade->crossfade, error)) return status;
    return from_call(bendy::sample(pose->pose, crossfade->crossfade, scratch->pose), error);
}
