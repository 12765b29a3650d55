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
    smooth,  ///< 3t^2 - 2t^3: starts and ends without a jerk
};

/// The weight at a share of the way, 0 to 1 (held to that; NaN is 1).
[[nodiscard]] float ease(Easing easing, float share);

/// A weight on its way to another one: of a layer, of an additive pose.
class Fade {
public:
    Fade() = default;
    explicit Fade(float weight) : from_(weight), to_(weight) {}
    /// From where it is now, in so many seconds; at once if those are not above 0.
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
    Fade fade;              ///< how much of it covers what began before it
    PlayedInterval played;  ///< by the last advance: for markers and root motion
    float share = 0.0f;     ///< of the result; all shares add up to 1
};

/// Clips that follow one another, each fading in over those before. One that is interrupted goes on beneath the next,
/// so nothing jumps. Small, and allocates nothing.
class Crossfade {
public:
    /// Of more at a time, the oldest goes at once; what is left of its share jumps.
    static constexpr std::size_t kMost = 4;

    /// From now on this one; the first one covers all at once. The clip must outlive its playing.
    void play(const Clip& clip, float fade_seconds, Easing easing = Easing::smooth) {
        play(clip, Playback(clip), fade_seconds, easing);
    }
    /// With a clock of the caller's: at another speed, in step with what plays now.
    void play(const Clip& clip, const Playback& playback, float fade_seconds, Easing easing = Easing::smooth);

    /// Moves every clock and every fade on; what is wholly covered afterwards is gone, with its walk.
    void advance(double seconds);

    /// Oldest first; empty before the first play.
    [[nodiscard]] std::span<const Playing> playing() const { return std::span(playing_).first(count_); }
    /// The newest one's clock, to change its speed or seek; null before the first play.
    [[nodiscard]] Playback* playback() { return count_ == 0 ? nullptr : &playing_[count_ - 1].playback; }

private:
    void drop_oldest(std::size_t how_many);
    void find_shares();

    std::array<Playing, kMost> playing_;
    std::size_t count_ = 0;
};

/// Sets the pose to what plays, by the shares. `scratch`: another pose of the same model, overwritten. An error,
/// and the rest pose, if nothing plays; an error, and nothing changes, for poses of different models.
[[nodiscard]] Result<void, CallError> sample(Pose& pose, const Crossfade& crossfade, Pose& scratch);

}  // namespace bendy
