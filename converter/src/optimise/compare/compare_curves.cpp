#include "optimise/compare/compare_curves.h"

#include "scene/curve_property.h"
#include "scene/evaluate.h"

#include <bendy/format/charconv.h>
#include <bendy/format/curve.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

namespace bendy::converter {
namespace {

using Kind = CharacterDifference::Kind;

std::string short_text(double number) {
    std::array<char, 32> digits{};
    const auto end = to_chars(digits.data(), digits.data() + digits.size(), static_cast<float>(number)).ptr;
    return {digits.data(), end};
}

std::string curve_in_words(const Curve& curve) {
    return "curve \"" + (curve.name.empty() ? curve.path : curve.name) + '"';
}

/// The curve as a track of vectors.
Track as_track(const Curve& curve) {
    return {TrackPath::translation, curve.interpolation, kNone, curve.components, curve.times, curve.values};
}

/// The range of each component's values, without the tangents of cubic curves.
std::vector<double> curve_ranges(const Curve& curve) {
    const bool is_cubic = curve.interpolation == Interpolation::cubic;
    const std::size_t stride = std::size_t{curve.components} * (is_cubic ? 3 : 1);
    std::vector<double> ranges;
    for (std::size_t component = 0; component < curve.components; ++component) {
        const float* const first = curve.values.data() + (is_cubic ? curve.components : 0) + component;
        float low = *first;
        float high = *first;
        for (std::size_t key = 1; key < curve.times.size(); ++key) {
            low = std::min(low, first[key * stride]);
            high = std::max(high, first[key * stride]);
        }
        ranges.push_back(double{high} - low);
    }
    return ranges;
}

/// Every key's time, and the midpoint to the next key; a step shows just before the later key.
std::vector<double> times_to_compare(const Curve& a, const Curve& b) {
    std::vector<double> keys(a.times.begin(), a.times.end());
    keys.insert(keys.end(), b.times.begin(), b.times.end());
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    std::vector<double> times;
    for (std::size_t k = 0; k < keys.size(); ++k) {
        times.push_back(keys[k]);
        if (k + 1 < keys.size()) times.push_back(0.5 * (keys[k] + keys[k + 1]));
    }
    return times;
}

class CurveComparison {
public:
    std::vector<CurveDifference> run(const Scene& a, const Clip& clip_a, const Scene& b, const Clip& clip_b,
                                     const CurveTargets& targets) {
        std::map<OwnProperty, const Curve*> others;
        for (const Curve& curve : clip_b.curves) {
            const auto known = [&](std::span<const std::uint32_t> a_of) {
                return curve.target < a_of.size() ? a_of[curve.target] : kNone;
            };
            Curve named;  // its property in A's numbering
            named.kind = curve.kind;
            named.path = curve.path;
            named.name = curve.name;
            named.target = curve.kind == CurveTarget::joint      ? known(targets.joints)
                           : curve.kind == CurveTarget::material ? known(targets.materials)
                           : curve.kind == CurveTarget::mesh     ? known(targets.meshes)
                           : curve.kind == CurveTarget::texture  ? same_texture(a, b, curve.target)
                                                                 : kNone;
            if (!others.emplace(own_property_of(named), &curve).second) add(Kind::only_in_b, curve);
        }
        for (const Curve& curve : clip_a.curves) {
            const auto other = others.find(own_property_of(curve));
            if (other == others.end()) {
                add(Kind::only_in_a, curve);
                continue;
            }
            compare(curve, *other->second);
            others.erase(other);
        }
        std::set<const Curve*> left;
        for (const auto& [property, curve] : others) left.insert(curve);
        for (const Curve& curve : clip_b.curves) {
            if (left.contains(&curve)) add(Kind::only_in_b, curve);
        }
        return std::move(differences_);
    }

private:
    void add(Kind kind, const Curve& curve, std::string what = {}) {
        differences_.push_back({kind, curve_in_words(curve), std::move(what)});
    }

    /// Textures are matched by number; other checks compare their images.
    static std::uint32_t same_texture(const Scene& a, const Scene& b, std::uint32_t number) {
        return number < a.textures.size() && a.textures[number].name == b.textures[number].name ? number : kNone;
    }

    void compare(const Curve& a, const Curve& b) {
        if (a.name != b.name) add(Kind::value, a, "name: \"" + a.name + "\" -> \"" + b.name + '"');
        if (a.components != b.components) {
            add(Kind::value, a, "components: " + std::to_string(a.components) + " -> " + std::to_string(b.components));
            return;
        }
        const std::vector<double> ranges = curve_ranges(a);
        const Track here = as_track(a);
        const Track there = as_track(b);
        std::vector<double> value;
        std::vector<double> other;
        double worst = 0.0;  // as a multiple of the tolerance
        double worst_apart = 0.0;
        double worst_time = 0.0;
        for (const double seconds : times_to_compare(a, b)) {
            evaluate_track(here, seconds, value);
            evaluate_track(there, seconds, other);
            for (std::size_t c = 0; c < a.components; ++c) {
                const double apart = std::abs(value[c] - other[c]);
                const double allowed = ranges[c] / kPackedCurveSteps;
                if (!(apart > allowed)) continue;
                const double share = allowed > 0.0 ? apart / allowed : INFINITY;
                if (share < worst || (share == worst && apart <= worst_apart)) continue;
                worst = share;
                worst_apart = apart;
                worst_time = seconds;
            }
        }
        if (worst > 0.0)
            add(Kind::value, a, "up to " + short_text(worst_apart) + " apart, at " + short_text(worst_time) + " s");
    }

    std::vector<CurveDifference> differences_;
};

}  // namespace

std::vector<CurveDifference> compare_curves(const Scene& a, const Clip& clip_a, const Scene& b, const Clip& clip_b,
                                            const CurveTargets& targets) {
    return CurveComparison().run(a, clip_a, b, clip_b, targets);
}

}  // namespace bendy::converter
