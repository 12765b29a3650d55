#include <bendy/runtime/crossfade.h>

#include <bendy/runtime/blend.h>
#include <bendy/runtime/sample.h>

#include <algorithm>
#include <cmath>

namespace bendy {

float ease(Easing easing, float share) {
    if (!(share < 1.0f)) return 1.0f;
    const float t = std::max(share, 0.0f);
    return easing == Easing::smooth ? t * t * (3.0f - 2.0f * t) : t;
}

void Fade::to(float weight, float seconds, Easing easing) {
    from_ = this->weight();
    to_ = weight;
    passed_ = 0.0;
    seconds_ = seconds > 0.0f ? double{seconds} : 0.0;
    easing_ = easing;
}

void Fade::advance(double seconds) {
    if (seconds > 0.0) passed_ = std::min(passed_ + seconds, seconds_);
}

float Fade::weight() const {
    if (is_done()) return to_;
    return from_ + (to_ - from_) * ease(easing_, static_cast<float>(passed_ / seconds_));
}

void Crossfade::play(const Clip& clip, const Playback& playback, float fade_seconds, Easing easing) {
    if (count_ == kMost) drop_oldest(1);
    Playing& added = playing_[count_];
    added = {};
    added.clip = &clip;
    added.playback = playback;
    added.fade = Fade(count_ == 0 ? 1.0f : 0.0f);
    added.fade.to(1.0f, fade_seconds, easing);
    ++count_;
    find_shares();
}

void Crossfade::advance(double seconds) {
    std::size_t covered = 0;
    for (std::size_t k = 0; k < count_; ++k) {
        Playing& playing = playing_[k];
        playing.played = playing.playback.advance(seconds);
        playing.fade.advance(seconds);
        if (playing.fade.is_done()) covered = k;
    }
    drop_oldest(covered);
    find_shares();
}

void Crossfade::drop_oldest(std::size_t how_many) {
    if (how_many == 0) return;
    std::move(playing_.begin() + static_cast<std::ptrdiff_t>(how_many),
              playing_.begin() + static_cast<std::ptrdiff_t>(count_), playing_.begin());
    count_ -= how_many;
}

void Crossfade::find_shares() {
    float left = 1.0f;
    for (std::size_t k = count_; k-- > 0;) {
        Playing& playing = playing_[k];
        playing.share = k == 0 ? left : left * playing.fade.weight();
        left -= playing.share;
    }
}

Result<void, CallError> sample(Pose& pose, const Crossfade& crossfade, Pose& scratch) {
    if (pose.model() != scratch.model()) return CallError::other_model;
    const auto playing = crossfade.playing();
    if (playing.empty()) {
        pose.set_rest();
        return CallError::missing;
    }
    Result<void, CallError> result = sample(pose, playing[0].clip, playing[0].playback.seconds());
    for (const Playing& next : playing.subspan(1)) {
        if (result) result = sample(scratch, next.clip, next.playback.seconds());
        if (result) result = blend(pose, scratch, next.fade.weight());
    }
    if (!result) pose.set_rest();
    return result;
}

}  // namespace bendy
