#include "key_track.h"

#include <bendy/format/find_key.h>
#include <bendy/format/slerp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>

namespace bendy::edit {
namespace {

/// More than a rotation and its slope need; weights tracks have more components and are sampled in parts.
using Row = std::vector<double>;

double dot_of(std::span<const double> a, std::span<const double> b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

void normalise(std::span<double> rotation) {
    const double length = std::sqrt(dot_of(rotation, rotation));
    if (!(length > 0.0)) return;
    for (double& number : rotation) number /= length;
}

void slerp(std::span<const float> left, std::span<const float> right, double share, std::span<double> out) {
    double dot = 0.0;
    for (std::size_t c = 0; c < out.size(); ++c) dot += double{left[c]} * right[c];
    const SlerpWeights weights = slerp_weights(dot, share);
    for (std::size_t c = 0; c < out.size(); ++c) out[c] = weights.first * left[c] + weights.second * right[c];
    normalise(out);
}

/// Hermite, with the tangents as changes per second.
void sample_cubic(const KeyTrack& track, std::size_t k, double u, std::span<double> value, std::span<double> slope) {
    const std::size_t n = track.components;
    const double d = double{track.times[k + 1]} - track.times[k];
    const auto left = std::span(track.values).subspan(k * track.row(), track.row());
    const auto right = std::span(track.values).subspan((k + 1) * track.row(), track.row());
    for (std::size_t c = 0; c < n; ++c) {
        const double a = left[n + c];
        const double out = d * left[2 * n + c];
        const double b = right[n + c];
        const double in = d * right[c];
        value[c] = (1.0 - u * u * (3.0 - 2.0 * u)) * a + u * (1.0 - u) * (1.0 - u) * out + u * u * (3.0 - 2.0 * u) * b -
                   u * u * (1.0 - u) * in;
        if (!slope.empty()) {
            slope[c] =
                (6.0 * u * (1.0 - u) * (b - a) + (1.0 - u) * (1.0 - 3.0 * u) * out + u * (3.0 * u - 2.0) * in) / d;
        }
    }
}

void insert_row(KeyTrack& track, std::size_t place, float seconds, std::span<const double> value,
                std::span<const double> slope) {
    std::vector<float> row;
    row.reserve(track.row());
    const auto add = [&](std::span<const double> numbers) {
        for (const double number : numbers) row.push_back(static_cast<float>(number));
    };
    if (track.is_cubic()) add(slope);
    add(value);
    if (track.is_cubic()) add(slope);
    track.times.insert(track.times.begin() + static_cast<std::ptrdiff_t>(place), seconds);
    track.values.insert(track.values.begin() + static_cast<std::ptrdiff_t>(place * track.row()), row.begin(),
                        row.end());
}

/// A rotation from one to another, as a quaternion to multiply from the left; the shorter way.
std::array<double, 4> difference(std::span<const double> from, std::span<const double> to) {
    const std::array<double, 4> back{-from[0], -from[1], -from[2], from[3]};
    std::array<double, 4> turn{to[3] * back[0] + to[0] * back[3] + to[1] * back[2] - to[2] * back[1],
                               to[3] * back[1] - to[0] * back[2] + to[1] * back[3] + to[2] * back[0],
                               to[3] * back[2] + to[0] * back[1] - to[1] * back[0] + to[2] * back[3],
                               to[3] * back[3] - to[0] * back[0] - to[1] * back[1] - to[2] * back[2]};
    return turn;
}

std::array<double, 4> product(const std::array<double, 4>& a, std::span<const float> b) {
    return {
        a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1], a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
        a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3], a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

/// The difference between the first and the last value, added by shares.
class Drift {
public:
    Drift(KeyTrack& track, float start, float to) : track_(track), first_(track.components), last_(track.components) {
        sample(track, start, first_);
        sample(track, to, last_);
        is_turn_ = track.is_rotation && !track.is_cubic();
        if (is_turn_) turn_ = difference(last_, first_);
        const double sign = track.is_rotation && dot_of(first_, last_) < 0.0 ? -1.0 : 1.0;
        for (double& number : first_) number *= sign;
    }

    [[nodiscard]] bool is_nothing() const { return first_ == last_; }

    /// \param share, speed  of the whole difference, and its change per second
    void add_to(std::size_t k, double share, double speed) {
        const auto value = track_.value(k);
        if (is_turn_) return turn(value, share);
        const auto key = track_.key(k);
        const std::size_t n = track_.components;
        for (std::size_t c = 0; c < n; ++c) {
            const double whole = first_[c] - last_[c];
            value[c] = static_cast<float>(value[c] + share * whole);
            if (!track_.is_cubic()) continue;
            key[c] = static_cast<float>(key[c] + speed * whole);
            key[2 * n + c] = static_cast<float>(key[2 * n + c] + speed * whole);
        }
    }

    void set(std::size_t k) {
        const auto value = track_.value(k);
        for (std::size_t c = 0; c < value.size(); ++c) value[c] = static_cast<float>(first_[c]);
    }

private:
    void turn(std::span<float> value, double share) const {
        constexpr std::array<float, 4> kNoTurn{0.0f, 0.0f, 0.0f, 1.0f};
        const SlerpWeights weights = slerp_weights(turn_[3], share);
        std::array<double, 4> part{};
        for (std::size_t c = 0; c < 4; ++c) part.at(c) = weights.first * kNoTurn.at(c) + weights.second * turn_.at(c);
        auto turned = product(part, value);
        normalise(turned);
        for (std::size_t c = 0; c < 4; ++c) value[c] = static_cast<float>(turned.at(c));
    }

    KeyTrack& track_;
    Row first_, last_;
    bool is_turn_ = false;
    std::array<double, 4> turn_{};
};

}  // namespace

bool KeyTrack::is_constant() const {
    const auto first = value(0);
    for (std::size_t k = 0; k < times.size(); ++k) {
        const auto here = value(k);
        if (!std::equal(first.begin(), first.end(), here.begin())) return false;
        if (!is_cubic() || times.size() == 1) continue;
        const auto all = std::span(values).subspan(k * row(), row());
        const auto is_flat = [](float slope) { return slope == 0.0f; };
        if (!std::all_of(all.begin(), all.begin() + components, is_flat)) return false;
        if (!std::all_of(all.end() - components, all.end(), is_flat)) return false;
    }
    return true;
}

void sample(const KeyTrack& track, double seconds, std::span<double> value, std::span<double> slope) {
    const std::size_t last = track.times.size() - 1;
    const std::size_t k = find_key(
        track.times.size(), [&](std::size_t key) { return double{track.times[key]}; }, seconds);
    std::fill(slope.begin(), slope.end(), 0.0);
    const bool is_at_key = k == last || !(seconds > track.times[k]);
    if (is_at_key || track.interpolation == Interpolation::step) {
        const auto here = track.value(k);
        std::copy(here.begin(), here.end(), value.begin());
        return;
    }
    const double u = (seconds - track.times[k]) / (double{track.times[k + 1]} - track.times[k]);
    if (track.is_cubic()) return sample_cubic(track, k, u, value, slope);
    const auto left = track.value(k);
    const auto right = track.value(k + 1);
    if (track.is_rotation) return slerp(left, right, u, value);
    for (std::size_t c = 0; c < value.size(); ++c) value[c] = (1.0 - u) * left[c] + u * right[c];
}

void insert_key(KeyTrack& track, float seconds) {
    const auto after = std::lower_bound(track.times.begin(), track.times.end(), seconds);
    if (after != track.times.end() && *after == seconds) return;
    Row value(track.components);
    Row slope(track.components);
    sample(track, seconds, value, slope);
    const auto place = static_cast<std::size_t>(after - track.times.begin());
    if (track.is_cubic() && (after == track.times.begin() || after == track.times.end())) {
        // Held outside the keys: the slope of the end does not reach there.
        const auto end = track.key(after == track.times.end() ? place - 1 : 0);
        const auto unused = after == track.times.end() ? end.last(track.components) : end.first(track.components);
        std::fill(unused.begin(), unused.end(), 0.0f);
    }
    insert_row(track, place, seconds, value, slope);
}

bool cut(KeyTrack& track, float from, float to) {
    if (from > track.times.front() && from < track.times.back()) insert_key(track, from);
    if (to > track.times.front() && to < track.times.back() && track.interpolation != Interpolation::step)
        insert_key(track, to);
    auto first =
        static_cast<std::size_t>(std::lower_bound(track.times.begin(), track.times.end(), from) - track.times.begin());
    auto end =
        static_cast<std::size_t>(std::upper_bound(track.times.begin(), track.times.end(), to) - track.times.begin());
    if (first == track.times.size()) first = end - 1;  // all keys are before: the last one is held
    if (end <= first) end = first + 1;                 // all are after: the first one is held
    KeyTrack kept = track;
    kept.times.clear();
    for (std::size_t k = first; k < end; ++k) {
        const double seconds = std::clamp(track.times[k], from, to);
        kept.times.push_back(static_cast<float>(seconds - from));
        if (k > first && !(kept.times[k - first] > kept.times[k - first - 1])) return false;
    }
    const auto begin = track.values.begin() + static_cast<std::ptrdiff_t>(first * track.row());
    kept.values.assign(begin, begin + static_cast<std::ptrdiff_t>((end - first) * track.row()));
    track = std::move(kept);
    return true;
}

bool resample(KeyTrack& track, std::span<const float> times) {
    if (track.times.size() == 1 || track.interpolation == Interpolation::step) return false;
    Row value(track.components);
    std::vector<float> values;
    values.reserve(times.size() * track.components);
    for (const float seconds : times) {
        sample(track, seconds, value);
        if (track.is_cubic() && track.is_rotation) normalise(value);
        for (const double number : value) values.push_back(static_cast<float>(number));
    }
    track.interpolation = Interpolation::linear;
    track.times.assign(times.begin(), times.end());
    track.values = std::move(values);
    return true;
}

void close_loop(KeyTrack& track, float start, float from, float to) {
    Drift drift(track, start, to);
    if (drift.is_nothing()) return;
    const bool is_step = track.interpolation == Interpolation::step;
    if (!is_step) insert_key(track, from);
    insert_key(track, to);
    const std::size_t last = track.times.size() - 1;
    const double length = double{to} - from;
    for (std::size_t k = 0; k < last && !is_step; ++k) {
        const double u = (double{track.times[k]} - from) / length;
        if (u > 0.0) drift.add_to(k, u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u) / length);
    }
    drift.set(last);
}

}  // namespace bendy::edit
