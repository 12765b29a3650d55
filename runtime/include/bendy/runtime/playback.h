#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/model.h>

#include <cstdint>

// A clip's clock: where it stands, and what it has walked on its time line since it was last asked.
namespace BENDY_PUBLIC bendy {

enum class LoopMode : std::uint8_t {
    once,       ///< stops at the end and holds it; backwards, at the start
    repeat,     ///< from the end on at the start, where it is the same moment
    ping_pong,  ///< there and back
};

/// A part of the time line, walked without a turn or a jump; backwards where `to` is smaller.
struct TimeSpan {
    double from = 0.0;  ///< seconds, on the clip's own time line
    double to = 0.0;    ///< seconds
    /// What stands at `to` belongs to it: the start or end of the clip, where it jumps or stops. Otherwise it belongs
    /// to the stretch that begins there, so that nothing is met twice. What stands at `from` always does.
    bool has_end = false;

    [[nodiscard]] bool is_empty() const { return from == to && !has_end; }
};

/// What one step has walked, in order: a first stretch, whole passes from end to end, a last stretch. Any may be empty.
struct PlayedInterval {
    TimeSpan first;
    TimeSpan pass;             ///< the first whole pass
    std::uint64_t passes = 0;  ///< so many, each as `pass`; if `turns`, every second one the other way
    bool turns = false;
    TimeSpan last;

    /// The k-th whole pass, from 0.
    [[nodiscard]] TimeSpan whole(std::uint64_t k) const {
        return turns && k % 2 == 1 ? TimeSpan{pass.to, pass.from, pass.has_end} : pass;
    }
    [[nodiscard]] bool is_empty() const { return passes == 0 && first.is_empty() && last.is_empty(); }
};

/// Time does not drift: it is kept inside one pass, in doubles, so each step rounds by less than 2e-16 of the clip's
/// length however many passes there have been. A clip without length stands still and walks nothing.
class Playback {
public:
    Playback() = default;
    /// From the clip's start; repeats if the clip says that it loops.
    explicit Playback(const Clip& clip);
    /// \param start, end  seconds on the clip's time line; without length if end is not after start, or not finite
    Playback(float start, float end, LoopMode mode);

    /// Walks on by so many seconds times the speed; back if that is negative. A step that is not finite walks nothing.
    PlayedInterval advance(double seconds);

    /// 1: as authored; 0: stands; negative: backwards.
    void set_speed(double speed) { speed_ = speed; }
    [[nodiscard]] double speed() const { return speed_; }
    /// The time stays; what was walking back in ping_pong walks forth.
    void set_mode(LoopMode mode);
    [[nodiscard]] LoopMode mode() const { return mode_; }

    /// Goes there without walking; held to [start, end]. A NaN goes nowhere. What repeats has no end of its own: there
    /// it stands at the start of the next pass.
    void seek(double seconds);
    /// The same by the share of the length, 0 to 1: what keeps a walk and a run in step.
    void seek_share(double share) { seek(start_ + share * length_); }

    [[nodiscard]] double start() const { return start_; }
    [[nodiscard]] double end() const { return end_; }
    /// Seconds, on the clip's own time line: what `sample` takes.
    [[nodiscard]] float seconds() const { return static_cast<float>(time_at(inside_, is_back())); }
    /// Of the length, 0 to 1; 0 without length.
    [[nodiscard]] double share() const;
    /// Passes completed since the last seek, less those undone. Always 0 in mode once.
    [[nodiscard]] std::int64_t passes() const { return pass_; }
    /// It stands at the end that it was going to: only in mode once.
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
    double inside_ = 0.0;  // seconds from where the pass begins: [0, length), once: [0, length]
    double speed_ = 1.0;
    std::int64_t pass_ = 0;
    LoopMode mode_ = LoopMode::once;
};

}  // namespace bendy
