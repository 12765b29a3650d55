#pragma once

#include <bendy/format/records.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bendy::edit {

/// The keys of a track or of a curve, to be changed. Times ascend strictly; there is at least one key.
struct KeyTrack {
    Interpolation interpolation = Interpolation::linear;
    bool is_rotation = false;  ///< quaternions x y z w; linear means slerp, and cubic results are normalised
    std::uint32_t components = 0;
    std::vector<float> times;   ///< seconds, on the clip's time line
    std::vector<float> values;  ///< `row` numbers per key: the value; if cubic in-tangent, value, out-tangent

    [[nodiscard]] bool is_cubic() const { return interpolation == Interpolation::cubic; }
    [[nodiscard]] std::size_t row() const { return std::size_t{components} * (is_cubic() ? 3 : 1); }
    [[nodiscard]] std::span<float> key(std::size_t k) { return std::span(values).subspan(k * row(), row()); }
    [[nodiscard]] std::span<float> value(std::size_t k) {
        return key(k).subspan(is_cubic() ? components : 0, components);
    }
    [[nodiscard]] std::span<const float> value(std::size_t k) const {
        return std::span(values).subspan(k * row() + (is_cubic() ? components : 0), components);
    }
    /// True if its value never changes: the same numbers in all keys, and no slopes.
    [[nodiscard]] bool is_constant() const;
};

/// Returns the value at a time as spec/tree.md defines it, but a cubic rotation is not normalised.
/// \param slope  its change per second, as wide as the value; 0 outside the keys. May be empty
void sample(const KeyTrack& track, double seconds, std::span<double> value, std::span<double> slope = {});

/// Adds a key where there is none; the value stays the same at every time. Outside the keys the value is held.
void insert_key(KeyTrack& track, float seconds);

/// Keeps what is played from `from` to `to`, and moves it so that `from` is at 0. The value stays the same at every
/// time between, except that times are rounded. Returns false if two keys would have the same time.
bool cut(KeyTrack& track, float from, float to);

/// Replaces the keys with linear ones at these times, at least one. Returns false if there is a single key or the track
/// steps: it stays as it is.
bool resample(KeyTrack& track, std::span<const float> times);

/// Lets the value drift from `from` to `to` so that it ends with what it has at `start`. The drift follows
/// 3u² - 2u³, so nothing jumps and, if the keys are dense or cubic, nothing turns sharply.
void close_loop(KeyTrack& track, float start, float from, float to);

}  // namespace bendy::edit
