#include "markers.h"

#include "attach_rig.h"
#include "failure.h"
#include "fields.h"
#include "frame_shapes.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace bendy::converter {
namespace {

constexpr float kNear = 1e-3f;  // seconds: times in text are rounded otherwise than keys

/// Does `work`; what is wrong fails, or is named.
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
    Fields fields(value, place, AngleUnit::radians);
    Marker marker;
    marker.seconds = to_float(fields.need("time"), fields.place_of("time"));
    fields.need("name");
    fields.read("name", marker.name);
    fields.refuse_others();
    return marker;
}

std::string seconds_text(float seconds) {
    return shown(OrderedJson(static_cast<double>(seconds))) + " s";
}

float inside(float seconds, const ClipSpan& span, const std::string& place) {
    if (seconds < span.start - kNear || seconds > span.end + kNear) {
        fail(place, seconds_text(seconds) + " is outside the clip, which lasts from " + seconds_text(span.start) +
                        " to " + seconds_text(span.end));
    }
    return std::clamp(seconds, span.start, span.end);
}

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
            from.marker.seconds = inside(from.marker.seconds, span, from.place);
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
    std::unordered_map<std::string_view, std::size_t> by_name;  // the first of a name
    for (std::size_t i = 0; i < scene.clips.size(); ++i) by_name.try_emplace(scene.clips[i].name, i);
    std::vector<bool> is_taken(scene.clips.size());
    for (const RigClip& entry : *rig.clips) {
        std::uint64_t number = 0;
        const bool is_number = parse_joint_number(entry.key, number);
        const auto named = by_name.find(entry.key);
        if (!is_number && named != by_name.end()) number = named->second;
        if (is_number ? number >= scene.clips.size() : named == by_name.end()) {
            report.warn("no clip takes " + quote(entry.key), rig.source + entry.place);
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

}  // namespace bendy::converter
