#include "clips.h"

#include "attach_rig.h"
#include "fields.h"
#include "joint_key.h"
#include "parse_rig.h"
#include "scene/curve_property.h"
#include "scene/failure.h"
#include "scene/frame_shapes.h"

#include <bendy/format/names.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace bendy::converter {
namespace {

constexpr float kNear = 1e-3f;  // seconds: times in text are rounded differently from keys

/// Runs `work`. An error fails, or is reported, depending on `wrong`.
template <class Work>
void guard(WrongMarkers wrong, const std::string& source, Report& report, Work work) {
    try {
        work();
    } catch (const Failure& failure) {
        if (wrong == WrongMarkers::fail) throw;
        report.warn("marker left out: " + failure.error.message, source + failure.error.place);
    }
}

Marker parse_entry(const OrderedJson& value, const std::string& place) {
    Fields fields(value, place, Notation::extras);
    Marker marker;
    marker.seconds = to_float(fields.need("time"), fields.place_of("time"));
    fields.need("name");
    fields.read("name", marker.name);
    fields.refuse_others();
    return marker;
}

std::string in_json(float seconds) {
    return shown(OrderedJson(static_cast<double>(seconds)));
}

/// Fails at `place` if a time is outside a clip by more than rounding.
void check_inside(float seconds, const ClipSpan& span, const std::string& place) {
    if (seconds >= span.start - kNear && seconds <= span.end + kNear) return;
    fail(place, in_json(seconds) + " s is outside the clip, which lasts from " + in_json(span.start) + " s to " +
                    in_json(span.end) + " s");
}

std::vector<float> parse_numbers(const OrderedJson& value, const std::string& place) {
    need_list(value, place);
    std::vector<float> numbers;
    numbers.reserve(value.size());
    for (std::size_t i = 0; i < value.size(); ++i) numbers.push_back(to_float(value[i], at(place, i)));
    return numbers;
}

void parse_target(const OrderedJson& value, const std::string& place, RigCurve& curve) {
    Fields fields(value, place, Notation::extras);
    for (std::size_t kind = 1; kind < kValueNames<CurveTarget>.size(); ++kind) {
        if (fields.find(kValueNames<CurveTarget>[kind]) == nullptr) continue;
        if (curve.curve.kind != CurveTarget::nothing) fail(place, "expected one target, found two");
        curve.curve.kind = static_cast<CurveTarget>(kind);
        fields.read(kValueNames<CurveTarget>[kind], curve.target);
    }
    fields.refuse_others();
    if (curve.curve.kind == CurveTarget::nothing)
        fail(place, "expected one of joint, material, mesh, texture, found none");
}

/// Escapes a name as a token of a JSON pointer.
std::string pointer_token(const std::string& name) {
    std::string token;
    for (const char c : name) token += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
    return token;
}

/// \param has_path  the path is present, even if empty
void check_path(Curve& curve, bool has_path, const std::string& place) {
    const bool has_target = curve.kind != CurveTarget::nothing;
    if (curve.path.empty()) {
        if (curve.name.empty()) fail(place, "expected a path or a name, found neither");
        if (!has_path) curve.path = (has_target ? "extras/" : "/extras/") + pointer_token(curve.name);
        return;
    }
    const std::string path_place = place + ".path";
    if (curve.kind == CurveTarget::joint) {
        constexpr std::span<const std::string_view> kTracks = kValueNames<TrackPath>;
        if (std::find(kTracks.begin(), kTracks.end(), curve.path) != kTracks.end())
            fail(path_place, "a joint's " + curve.path + " is animated by a track, not by a curve");
    }
    if (has_target || curve.path.front() == '/') return;
    fail(path_place,
         "expected a JSON pointer, which begins with '/', for a curve without a target, found " + quote(curve.path));
}

void check_keys(Curve& curve, const std::string& place) {
    if (curve.times.empty()) fail(place + ".times", "expected one time or more, found none");
    for (std::size_t k = 1; k < curve.times.size(); ++k) {
        if (curve.times[k] > curve.times[k - 1]) continue;
        fail(at(place + ".times", k),
             "expected a time after " + in_json(curve.times[k - 1]) + ", found " + in_json(curve.times[k]));
    }
    const bool is_cubic = curve.interpolation == Interpolation::cubic;
    const std::size_t of_component = curve.times.size() * (is_cubic ? 3 : 1);
    const std::size_t components = curve.values.size() / of_component;
    if (components < 1 || components > kMostCurveComponents || curve.values.size() % of_component != 0) {
        fail(place + ".values", "expected " + std::to_string(of_component) + " numbers, or 2, 3 or 4 times as many, " +
                                    "for " + std::to_string(curve.times.size()) + (is_cubic ? " cubic" : "") +
                                    " keys, found " + std::to_string(curve.values.size()));
    }
    curve.components = static_cast<std::uint32_t>(components);
}

RigCurve parse_curve(const OrderedJson& value, const std::string& place) {
    Fields fields(value, place, Notation::extras);
    RigCurve parsed;
    parsed.place = place;
    Curve& curve = parsed.curve;
    fields.need("clip");
    fields.read("clip", parsed.clip);
    fields.read("name", curve.name);
    const bool has_path = fields.find("path") != nullptr;
    fields.read("path", curve.path);
    if (const OrderedJson* target = fields.find("target"); target != nullptr)
        parse_target(*target, place + ".target", parsed);
    auto interpolation = static_cast<std::uint8_t>(Interpolation::linear);
    fields.read_word("interpolation", kValueNames<Interpolation>, interpolation);
    curve.interpolation = static_cast<Interpolation>(interpolation);
    curve.times = parse_numbers(fields.need("times"), place + ".times");
    curve.values = parse_numbers(fields.need("values"), place + ".values");
    fields.refuse_others();
    check_path(curve, has_path, place);
    check_keys(curve, place);
    return parsed;
}

/// Looks up things by name, first occurrence, or by number as `#12`.
class NamedThings {
public:
    template <class Things>
    explicit NamedThings(const Things& things) : count_(things.size()) {
        for (std::size_t i = 0; i < things.size(); ++i) by_name_.try_emplace(things[i].name, i);
    }

    /// kNone if there is none.
    [[nodiscard]] std::uint32_t find(std::string_view key) const {
        std::uint64_t number = 0;
        if (parse_joint_number(key, number)) return number < count_ ? static_cast<std::uint32_t>(number) : kNone;
        const auto named = by_name_.find(name_of_key(key));
        return named == by_name_.end() ? kNone : static_cast<std::uint32_t>(named->second);
    }

private:
    std::size_t count_;
    std::unordered_map<std::string_view, std::size_t> by_name_;
};

/// A clip's span before its curves change; nothing for one without keys.
std::optional<ClipSpan> length_before(const Clip& clip) {
    const bool has_keys = !clip.tracks.empty() || !clip.plays.empty() || !clip.curves.empty() || clip.stated_span;
    return has_keys ? std::optional(span_of(clip)) : std::nullopt;
}

class CurveAttacher {
public:
    CurveAttacher(Scene& scene, const Rig& rig, const JointIndex& index, Report& report)
        : scene_(scene),
          rig_(rig),
          index_(index),
          report_(report),
          clips_(scene.clips),
          materials_(scene.materials),
          meshes_(scene.meshes),
          textures_(scene.textures),
          numbers_of_(scene.clips.size()) {
        for (const Clip& clip : scene.clips) lengths_.push_back(length_before(clip));
    }

    void run() {
        std::vector<std::pair<std::size_t, Curve>> resolved;
        for (const RigCurve& entry : *rig_.curves) {
            const std::uint32_t clip = clips_.find(entry.clip);
            Curve curve = resolve(entry);
            if (clip == kNone) {
                report_.warn("no clip takes a curve for " + quote(entry.clip), rig_.source + entry.place);
                continue;
            }
            if (!taken_.emplace(clip, own_property_of(curve)).second)
                fail(entry.place, "an earlier curve of clip " + quote(entry.clip) + " animates the same");
            check_times(curve, lengths_[clip], entry);
            resolved.emplace_back(clip, std::move(curve));
        }
        // Nothing fails from here on.
        for (std::size_t clip = 0; clip < scene_.clips.size(); ++clip) {
            std::vector<Curve>& curves = scene_.clips[clip].curves;
            if (rig_.complete) curves.clear();
            for (std::size_t c = 0; c < curves.size(); ++c) numbers_of_[clip].emplace(own_property_of(curves[c]), c);
        }
        for (auto& [clip, curve] : resolved) put(clip, std::move(curve));
        for (std::size_t clip = 0; clip < scene_.clips.size(); ++clip) keep_length(clip);
    }

private:
    [[nodiscard]] Curve resolve(const RigCurve& entry) const {
        Curve curve = entry.curve;
        switch (curve.kind) {
            case CurveTarget::joint:
                curve.target = index_.find_key(entry.target);
                break;
            case CurveTarget::material:
                curve.target = materials_.find(entry.target);
                break;
            case CurveTarget::mesh:
                curve.target = meshes_.find(entry.target);
                break;
            case CurveTarget::texture:
                curve.target = textures_.find(entry.target);
                break;
            default:
                return curve;
        }
        const std::string kind(kValueNames<CurveTarget>[static_cast<std::size_t>(curve.kind)]);
        if (curve.target == kNone)
            fail(entry.place + ".target." + kind, "there is no " + kind + ' ' + quote(entry.target));
        return curve;
    }

    static void check_times(const Curve& curve, const std::optional<ClipSpan>& length, const RigCurve& entry) {
        if (!length) return;
        for (const float seconds : {curve.times.front(), curve.times.back()})
            check_inside(seconds, *length, entry.place + ".times");
    }

    void put(std::size_t clip, Curve curve) {
        std::vector<Curve>& curves = scene_.clips[clip].curves;
        const auto known = numbers_of_[clip].find(own_property_of(curve));
        if (known == numbers_of_[clip].end()) {
            curves.push_back(std::move(curve));
        } else {
            curves[known->second] = std::move(curve);
        }
    }

    void keep_length(std::size_t clip) {
        Clip& changed = scene_.clips[clip];
        if (lengths_[clip] && span_of(changed) != *lengths_[clip]) changed.stated_span = lengths_[clip];
    }

    Scene& scene_;
    const Rig& rig_;
    const JointIndex& index_;
    Report& report_;
    NamedThings clips_, materials_, meshes_, textures_;
    std::vector<std::optional<ClipSpan>> lengths_;
    std::set<std::pair<std::size_t, OwnProperty>> taken_;
    std::vector<std::map<OwnProperty, std::size_t>> numbers_of_;
};

}  // namespace

std::vector<SourceMarker> parse_markers(const OrderedJson& value, const std::string& place, WrongMarkers wrong,
                                        Report& report) {
    std::vector<SourceMarker> markers;
    const auto add = [&](const std::string& where, auto parse) {
        guard(wrong, {}, report, [&] { markers.push_back({parse(), where}); });
    };
    if (value.is_array()) {
        for (std::size_t i = 0; i < value.size(); ++i)
            add(at(place, i), [&] { return parse_entry(value[i], at(place, i)); });
        return markers;
    }
    if (!value.is_object()) fail(place, "it must be a list of markers, not " + shown(value));
    for (auto entry = value.begin(); entry != value.end(); ++entry) {
        const std::string& name = entry.key();
        const OrderedJson& times = *entry;
        const std::string where = member(place, name);
        if (!times.is_array()) {
            add(where, [&] { return Marker{to_float(times, where), name}; });
            continue;
        }
        for (std::size_t i = 0; i < times.size(); ++i)
            add(at(where, i), [&] { return Marker{to_float(times[i], at(where, i)), name}; });
    }
    return markers;
}

void set_markers(Clip& clip, std::vector<SourceMarker> markers, const std::string& source, WrongMarkers wrong,
                 Report& report) {
    const ClipSpan span = span_of(clip);
    std::vector<Marker> kept;
    for (SourceMarker& from : markers) {
        guard(wrong, source, report, [&] {
            check_inside(from.marker.seconds, span, from.place);
            from.marker.seconds = std::clamp(from.marker.seconds, span.start, span.end);
            kept.push_back(std::move(from.marker));
        });
    }
    std::stable_sort(kept.begin(), kept.end(), [](const Marker& a, const Marker& b) { return a.seconds < b.seconds; });
    clip.markers = std::move(kept);
}

void take_markers_from_extras(Clip& clip, const std::string& place, Report& report) {
    constexpr const char* kMember = "markers";
    if (clip.extras.find(kMember) == std::string::npos) return;
    const std::string where = place + '.' + kMember;
    try {
        auto extras = parse_json_text<Json>(clip.extras, report);
        if (!extras.is_object() || !extras.contains(kMember)) return;
        const Json& found = extras[kMember];
        const std::string text = found.is_string() ? found.get<std::string>() : found.dump();
        auto markers = parse_markers(parse_json_text<OrderedJson>(text, report), where, WrongMarkers::left_out, report);
        if (markers.empty()) return;
        set_markers(clip, std::move(markers), {}, WrongMarkers::left_out, report);
        extras.erase(kMember);
        clip.extras = extras.empty() ? std::string() : extras.dump();
    } catch (const Failure& failure) {
        report.warn("markers left out: " + failure.error.message, where);
    }
}

void attach_markers(Scene& scene, const Rig& rig, Report& report) {
    if (!rig.clips) return;
    std::unordered_map<std::string_view, std::size_t> by_name;  // the first of each name
    for (std::size_t i = 0; i < scene.clips.size(); ++i) by_name.try_emplace(scene.clips[i].name, i);
    std::vector<bool> is_taken(scene.clips.size());
    bool has_suggested = false;
    for (const RigClip& entry : *rig.clips) {
        std::uint64_t number = 0;
        const bool is_number = parse_joint_number(entry.key, number);
        const auto named = by_name.find(name_of_key(entry.key));
        if (!is_number && named != by_name.end()) number = named->second;
        if (is_number ? number >= scene.clips.size() : named == by_name.end()) {
            std::vector<std::string_view> names;  // to suggest one, made once: a hostile file has many entries
            for (std::size_t i = 0; !has_suggested && i < scene.clips.size(); ++i) names.push_back(scene.clips[i].name);
            has_suggested = true;
            report.warn("no clip takes " + quote(entry.key) + did_you_mean(names, name_of_key(entry.key)),
                        rig.source + entry.place);
            continue;
        }
        if (is_taken[number]) fail(entry.place, "clip " + quote(entry.key) + " has an earlier entry");
        is_taken[number] = true;
        set_markers(scene.clips[number], entry.markers, rig.source, WrongMarkers::fail, report);
    }
    for (std::size_t i = 0; i < is_taken.size(); ++i) {
        if (rig.complete && !is_taken[i]) scene.clips[i].markers.clear();
    }
}

std::vector<RigCurve> parse_curves(const OrderedJson& value, const std::string& place) {
    need_list(value, place);
    std::vector<RigCurve> curves;
    for (std::size_t i = 0; i < value.size(); ++i) curves.push_back(parse_curve(value[i], at(place, i)));
    return curves;
}

void attach_curves(Scene& scene, const Rig& rig, const JointIndex& index, Report& report) {
    if (rig.curves) CurveAttacher(scene, rig, index, report).run();
}

}  // namespace bendy::converter
