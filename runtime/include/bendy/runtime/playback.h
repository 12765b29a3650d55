#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/model.h>

#include <cstdint>

// The clock of a clip: its current time, and the interval that the last step has played.
namespace BENDY_PUBLIC bendy {

enum class LoopMode : std::uint8_t {
    once,       ///< stops at the end and stays there; backwards, at the start
    repeat,     ///< continues at the start after the end, which are the same moment
    ping_pong,  ///< forwards and backwards alternately
};

/// A part of the time line, played without a turn or a jump; backwards if `to` is smaller than `from`.
struct TimeSpan {
    double from = 0.0;  ///< seconds, on the clip's time line
    double to = 0.0;    ///< seconds
    /// True if a marker exactly at `to` belongs to this span: at the clip's start or end, where playback jumps or
    /// stops. Otherwise it belongs to the span that begins there, so that no marker is passed twice. A marker at `from`
    /// always belongs to the span.
    bool has_end = false;

    [[nodiscard]] bool is_empty() const { return from == to && !has_end; }
};

/// The interval that one step has played, in order: a first span, whole passes from end to end, a last span. Any of
/// them may be empty.
struct PlayedInterval {
    TimeSpan first;
    TimeSpan pass;             ///< the first whole pass
    std::uint64_t passes = 0;  ///< number of whole passes, each as `pass`; if `turns`, every second one in the other
                               ///< direction
    bool turns = false;
    TimeSpan last;

    /// Returns the k-th whole pass, from 0.
    [[nodiscard]] TimeSpan whole(std::uint64_t k) const {
        return turns && k % 2 == 1 ? TimeSpan{pass.to, pass.from, pass.has_end} : pass;
    }
    [[nodiscard]] bool is_empty() const { return passes == 0 && first.is_empty() && last.is_empty(); }
};

/// The clock of a clip. Time does not drift: it is kept within one pass, in double precision, so each step rounds by
/// less than 2e-16 of the clip's length however many passes there have been. A clip of zero length stands still and
/// plays nothing.
class Playback {
public:
    Playback() = default;
    /// Starts at the clip's start; repeats if the clip is marked as looping.
    explicit Playback(const Clip& clip);
    /// \param start, end  seconds on the clip's time line; the length is zero if end is not after start, or if they are
    /// not finite
    Playback(float start, float end, LoopMode mode);

    /// Advances by `seconds` times the speed, backwards if that is negative. Does nothing if the step is not finite.
    PlayedInterval advance(double seconds);

    /// 1: as authored; 0: paused; negative: backwards.
    void set_speed(double speed) { speed_ = speed; }
    [[nodiscard]] double speed() const { return speed_; }
    /// Keeps the current time; playback on the way back in ping_pong turns to go forwards.
    void set_mode(LoopMode mode);
    [[nodiscard]] LoopMode mode() const { return mode_; }

    /// Jumps to a time without playing what lies between; clamped to [start, end]. Ignores NaN. Except in mode
    /// once, the end counts as the start of the next pass.
    void seek(double seconds);
    /// Seeks by the fraction of the length, 0 to 1: to keep a walk and a run in step.
    void seek_share(double share) { seek(start_ + share * length_); }

    [[nodiscard]] double start() const { return start_; }
    [[nodiscard]] double end() const { return end_; }
    /// The current time in seconds on the clip's time line, as `sample` takes it.
    [[nodiscard]] float seconds() const { return static_cast<float>(time_at(inside_, is_back())); }
    /// The current time as a fraction of the length, 0 to 1; 0 for zero length.
    [[nodiscard]] double share() const;
    /// Number of passes completed since the last seek, minus those undone by playing backwards. Always 0 in mode once.
    [[nodiscard]] std::int64_t passes() const { return pass_; }
    /// True if playback has stopped at the end it was heading for: only in mode once.
    [[nodiscard]] bool is_done() const;

private:
    [[nodiscard]] bool is_back() const { return mode_ == LoopMode::ping_pong && pass_ % 2 != 0; }
    [[nodiscard]] double time_at(double inside, bool is_back) const;
    [[nodiscard]] TimeSpan span_between(double from, double to, bool has_end) const;
    PlayedInterval advance_once(double step);
    PlayedInterval advance_forward(double step);
    PlayedInterval advance_backward(double step);
    [[nodiscard]] TimeSpan whole_pass(bool forth) const;

    double start_ = 0.0, end_ = 0.0, length_ = 0.0;  // seconds
    double inside_ = 0.0;                            // seconds since the pass began: [0, length), once: [0, length]
    double speed_ = 1.0;
    std::int64_t pass_ = 0;
    LoopMode mode_ = LoopMode::once;
};

}  // namespace bendy
