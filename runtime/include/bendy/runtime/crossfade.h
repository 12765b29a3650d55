#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/playback.h>
#include <bendy/runtime/pose.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace BENDY_PUBLIC bendy {

enum class Easing : std::uint8_t {
    linear,
    smooth,  ///< 3t^2 - 2t^3: starts and ends smoothly
};

/// Returns the eased weight at a fraction of the way, 0 to 1 (clamped; NaN counts as 1).
[[nodiscard]] float ease(Easing easing, float share);

/// A weight that moves towards another over time: of a layer, of an additive pose.
class Fade {
public:
    Fade() = default;
    explicit Fade(float weight) : from_(weight), to_(weight) {}
    /// Starts a fade from the current weight that takes `seconds`; immediate if `seconds` is not above 0.
    void to(float weight, float seconds, Easing easing = Easing::smooth);
    void advance(double seconds);
    [[nodiscard]] float weight() const;
    [[nodiscard]] bool is_done() const { return passed_ >= seconds_; }

private:
    float from_ = 0.0f, to_ = 0.0f;
    double seconds_ = 0.0, passed_ = 0.0;
    Easing easing_ = Easing::smooth;
};

/// One of the clips of a Crossfade.
struct Playing {
    const Clip* clip = nullptr;
    Playback playback;
    Fade fade;              ///< how far it covers the clips that began before it
    PlayedInterval played;  ///< the interval of the last advance: for markers and root motion
    float share = 0.0f;     ///< its share of the result; all shares sum to 1
};

/// A sequence of clips in which each fades in over those before it. A clip that is interrupted keeps playing beneath
/// the next one, so nothing jumps. Small, and allocates nothing.
class Crossfade {
public:
    /// Maximum number of clips at a time. One more drops the oldest at once, so that the result jumps by what was left
    /// of its share.
    static constexpr std::size_t kMost = 4;

    /// Starts a clip; the first one is visible in full at once. The clip must stay alive while it plays, and all clips
    /// must belong to one model, that of the poses that `sample` is given.
    void play(const Clip& clip, float fade_seconds, Easing easing = Easing::smooth) {
        play(clip, Playback(clip), fade_seconds, easing);
    }
    /// Starts a clip with a clock of the caller's: at another speed, or in step with the clip that plays now.
    void play(const Clip& clip, const Playback& playback, float fade_seconds, Easing easing = Easing::smooth);

    /// Advances all clocks and fades; then drops the clips that are completely covered, with their played intervals.
    void advance(double seconds);

    /// Oldest first; empty before the first play.
    [[nodiscard]] std::span<const Playing> playing() const { return std::span(playing_).first(count_); }
    /// The clock of the newest clip, to change its speed or to seek; null before the first play.
    [[nodiscard]] Playback* playback() { return count_ == 0 ? nullptr : &playing_[count_ - 1].playback; }

private:
    void drop_oldest(std::size_t how_many);
    void find_shares();

    std::array<Playing, kMost> playing_;
    std::size_t count_ = 0;
};

/// Sets the pose to the clips that play, mixed by their shares. `scratch` is another pose of the same model, which is
/// overwritten. Returns an error, and sets the rest pose, if nothing plays or if a clip does not belong to the poses'
/// model; returns an error, and changes nothing, for poses of different models.
[[nodiscard]] Result<void, CallError> sample(Pose& pose, const Crossfade& crossfade, Pose& scratch);

}  // namespace bendy
