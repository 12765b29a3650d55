#include <bendy/format/find_key.h>
#include <bendy/runtime/curve.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace bendy {
namespace {

/// The keys around a time.
struct KeyInterval {
    std::size_t left = 0;
    std::size_t right = 0;  ///< equal to left if there is nothing to interpolate
    double fraction = 0.0;  ///< [0, 1)
    double seconds = 0.0;   ///< from left to right
};

KeyInterval interval_at(std::span<const float> times, double seconds) {
    const std::size_t left = find_key(
        times.size(), [times](std::size_t key) { return double{times[key]}; }, seconds);
    if (left + 1 == times.size() || !(seconds > times[left])) return {left, left};
    const double length = double{times[left + 1]} - times[left];
    return {left, left + 1, (seconds - times[left]) / length, length};
}

/// Returns component `component` of a cubic curve between two keys, each stored as in-tangent, value, out-tangent.
double hermite_value(const Curve& curve, const KeyInterval& at, std::size_t component) {
    const std::size_t n = curve.components;
    const auto number = [&](std::size_t key, std::size_t part) {
        return double{curve.value(key * 3 * n + part * n + component)};
    };
    const double u = at.fraction;
    const double u2 = u * u;
    const double u3 = u2 * u;
    return (2.0 * u3 - 3.0 * u2 + 1.0) * number(at.left, 1) + at.seconds * (u3 - 2.0 * u2 + u) * number(at.left, 2) +
           (-2.0 * u3 + 3.0 * u2) * number(at.right, 1) + at.seconds * (u3 - u2) * number(at.right, 0);
}

}  // namespace

Result<void, CallError> sample_curve(const Curve& curve, double seconds, std::span<float> value) {
    if (std::isnan(seconds)) return CallError::not_finite;
    if (value.size() < curve.components) return CallError::output_too_short;
    const std::size_t n = curve.components;
    const bool is_cubic = curve.interpolation == Interpolation::cubic;
    const KeyInterval at = interval_at(curve.times, seconds);
    const auto key_value = [&](std::size_t key, std::size_t component) {
        return curve.value(is_cubic ? key * 3 * n + n + component : key * n + component);
    };
    for (std::size_t c = 0; c < n; ++c) {
        if (at.left == at.right || curve.interpolation == Interpolation::step) {
            value[c] = key_value(at.left, c);
        } else if (is_cubic) {
            value[c] = static_cast<float>(hermite_value(curve, at, c));
        } else {
            value[c] =
                static_cast<float>((1.0 - at.fraction) * key_value(at.left, c) + at.fraction * key_value(at.right, c));
        }
    }
    return {};
}

const Curve* find_curve(const ClipView& clip, std::string_view name_or_path) {
    const auto first = [&](std::string_view Curve::*text) {
        const auto found = std::find_if(clip.curves.begin(), clip.curves.end(),
                                        [&](const Curve& curve) { return curve.*text == name_or_path; });
        return found == clip.curves.end() ? nullptr : &*found;
    };
    const Curve* const named = first(&Curve::name);
    return named != nullptr ? named : first(&Curve::path);
}

const Curve* find_curve(const ClipView& clip, CurveTarget kind, std::uint32_t target, std::string_view path) {
    const auto found = std::find_if(clip.curves.begin(), clip.curves.end(), [&](const Curve& curve) {
        return curve.kind == kind && curve.target == target && curve.path == path;
    });
    return found == clip.curves.end() ? nullptr : &*found;
}

}  // namespace bendy
