#include <bendy/runtime/playback.h>

#include <algorithm>
#include <cmath>

namespace bendy {
namespace {

/// The whole passes in a step of `seconds` (not negative), and the remainder.
struct Passes {
    std::uint64_t whole = 0;
    double rest = 0.0;  // [0, length)
};

Passes split(double seconds, double length) {
    constexpr double kMost = 9e15;                   // largest count that doubles represent exactly; longer steps are
                                                     // inexact anyway
    const double rest = std::fmod(seconds, length);  // exact
    return {static_cast<std::uint64_t>(std::min(std::round((seconds - rest) / length), kMost)), rest};
}

/// Wraps around after 2^63, which only meaningless steps reach.
std::int64_t moved(std::int64_t pass, std::uint64_t by) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(pass) + by);
}

}  // namespace

Playback::Playback(const Clip& clip) : Playback(clip.start, clip.end, clip.loop ? LoopMode::repeat : LoopMode::once) {}

Playback::Playback(float start, float end, LoopMode mode) : mode_(mode) {
    start_ = std::isfinite(start) ? double{start} : 0.0;
    end_ = std::isfinite(start) && std::isfinite(end) && end > start ? double{end} : start_;
    length_ = end_ - start_;
}

double Playback::time_at(double inside, bool is_back) const {
    if (inside >= length_) return is_back ? start_ : end_;
    if (inside <= 0.0) return is_back ? end_ : start_;
    return std::clamp(is_back ? end_ - inside : start_ + inside, start_, end_);
}

TimeSpan Playback::span_between(double from, double to, bool has_end) const {
    // At a turn, the way back begins with the markers there.
    return {time_at(from, is_back()), time_at(to, is_back()), has_end && mode_ != LoopMode::ping_pong};
}

TimeSpan Playback::whole_pass(bool forth) const {
    return forth ? span_between(0.0, length_, true) : span_between(length_, 0.0, true);
}

double Playback::share() const {
    return length_ > 0.0 ? (time_at(inside_, is_back()) - start_) / length_ : 0.0;
}

bool Playback::is_done() const {
    if (mode_ != LoopMode::once) return false;
    return speed_ < 0.0 ? inside_ <= 0.0 : inside_ >= length_;
}

void Playback::set_mode(LoopMode mode) {
    const double seconds = time_at(inside_, is_back());
    mode_ = mode;
    seek(seconds);
}

void Playback::seek(double seconds) {
    if (std::isnan(seconds)) return;
    inside_ = std::clamp(seconds - start_, 0.0, length_);
    pass_ = 0;
    if (mode_ == LoopMode::once || inside_ < length_ || length_ == 0.0) return;
    inside_ = 0.0;
    pass_ = 1;
}

PlayedInterval Playback::advance(double seconds) {
    const double step = seconds * speed_;
    PlayedInterval played;
    played.turns = mode_ == LoopMode::ping_pong;
    const double here = time_at(inside_, is_back());
    played.first = played.pass = played.last = {here, here, false};
    if (!std::isfinite(step) || step == 0.0 || length_ == 0.0) return played;
    if (mode_ == LoopMode::once) return advance_once(step);
    return step > 0.0 ? advance_forward(step) : advance_backward(-step);
}

PlayedInterval Playback::advance_once(double step) {
    const double to = std::clamp(inside_ + step, 0.0, length_);
    const bool is_stopped = step > 0.0 ? to >= length_ : to <= 0.0;
    PlayedInterval played;
    played.first = span_between(inside_, to, is_stopped && to != inside_);
    inside_ = to;
    const double here = time_at(to, false);
    played.pass = played.last = {here, here, false};
    return played;
}

PlayedInterval Playback::advance_forward(double step) {
    PlayedInterval played;
    played.turns = mode_ == LoopMode::ping_pong;
    const double beyond = (inside_ - length_) + step;
    if (beyond < 0.0 && inside_ + step < length_) {
        played.first = span_between(inside_, inside_ + step, false);
        inside_ += step;
        played.pass = played.last = {played.first.to, played.first.to, false};
        return played;
    }
    const Passes passes = split(std::max(beyond, 0.0), length_);
    played.first = span_between(inside_, length_, true);
    pass_ = moved(pass_, 1);
    played.pass = whole_pass(true);
    played.passes = passes.whole;
    pass_ = moved(pass_, passes.whole);
    played.last = span_between(0.0, passes.rest, false);
    inside_ = passes.rest;
    return played;
}

PlayedInterval Playback::advance_backward(double step) {
    PlayedInterval played;
    played.turns = mode_ == LoopMode::ping_pong;
    if (step < inside_) {
        played.first = span_between(inside_, inside_ - step, false);
        inside_ -= step;
        played.pass = played.last = {played.first.to, played.first.to, false};
        return played;
    }
    const Passes passes = split(step - inside_, length_);
    played.first = span_between(inside_, 0.0, inside_ > 0.0);
    pass_ = moved(pass_, ~std::uint64_t{0});
    played.pass = whole_pass(false);
    played.passes = passes.whole;
    pass_ = moved(pass_, 0 - passes.whole);
    inside_ = length_ - passes.rest;
    const bool has_moved = inside_ < length_;  // otherwise it is at the start of the pass after this one
    played.last = span_between(length_, inside_, false);
    if (has_moved) return played;
    inside_ = 0.0;
    pass_ = moved(pass_, 1);
    return played;
}

}  // namespace bendy
