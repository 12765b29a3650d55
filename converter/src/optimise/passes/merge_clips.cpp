#include "optimise/passes/merge_clips.h"

#include "scene/curve_property.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bendy::converter {
namespace {

using Property = std::pair<TrackPath, std::uint32_t>;

Property property_of(const Track& track) {
    return {track.path, track.target};
}

/// The common prefix of two names, without a partial word at the end: "walk_hip", "walk_hand" -> "walk".
std::string_view common_start(std::string_view a, std::string_view b) {
    constexpr std::string_view kBetweenWords = "_-.:| ";
    const auto differ = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
    if (differ.first == a.end() && differ.second == b.end()) return a;
    std::string_view start = a.substr(0, static_cast<std::size_t>(differ.first - a.begin()));
    const auto ends_word = [&](std::string_view name) {
        return name.size() == start.size() || kBetweenWords.find(name[start.size()]) != std::string_view::npos;
    };
    if (!ends_word(a) || !ends_word(b)) {
        const std::size_t last = start.find_last_of(kBetweenWords);
        start = start.substr(0, last == std::string_view::npos ? 0 : last);
    }
    while (!start.empty() && kBetweenWords.find(start.back()) != std::string_view::npos) start.remove_suffix(1);
    return start;
}

/// A clip that others are being merged into.
struct Merged {
    Clip clip;
    std::string start;  // common prefix of all names
};

void merge(Clip&& clip, Merged& into, Report& report) {
    into.start = common_start(into.start, clip.name);
    into.clip.loop = into.clip.loop && clip.loop;
    std::move(clip.tracks.begin(), clip.tracks.end(), std::back_inserter(into.clip.tracks));
    std::move(clip.curves.begin(), clip.curves.end(), std::back_inserter(into.clip.curves));
    std::move(clip.markers.begin(), clip.markers.end(), std::back_inserter(into.clip.markers));
    if (!clip.extras.empty() && clip.extras != into.clip.extras)
        report.warn("extras of a merged clip left out, those of the first are kept", "clip \"" + clip.name + '"');
}

}  // namespace

std::uint32_t merge_clips(Scene& scene, Report& report) {
    std::vector<Merged> merged;
    std::map<Property, std::size_t> next;              // the first merged clip in which a property is still free
    std::map<OwnProperty, std::size_t> next_of_curve;  // the same
    for (Clip& clip : scene.clips) {
        std::size_t number = 0;
        for (const Track& track : clip.tracks) number = std::max(number, next[property_of(track)]);
        for (const Curve& curve : clip.curves) number = std::max(number, next_of_curve[own_property_of(curve)]);
        for (const Track& track : clip.tracks) next[property_of(track)] = number + 1;
        for (const Curve& curve : clip.curves) next_of_curve[own_property_of(curve)] = number + 1;
        if (number < merged.size()) {
            merge(std::move(clip), merged[number], report);
            continue;
        }
        Merged& begun = merged.emplace_back();
        begun.start = clip.name;
        begun.clip = std::move(clip);
    }
    scene.clips.clear();
    for (Merged& one : merged) {
        if (!one.start.empty()) one.clip.name = one.start;
        std::stable_sort(one.clip.markers.begin(), one.clip.markers.end(),
                         [](const Marker& a, const Marker& b) { return a.seconds < b.seconds; });
        scene.clips.push_back(std::move(one.clip));
    }
    return static_cast<std::uint32_t>(scene.clips.size());
}

bool is_spread_motion(const Scene& scene) {
    constexpr std::size_t kFewest = 3;
    if (scene.clips.size() < kFewest) return false;
    std::set<Property> properties;
    std::set<CurveProperty> curves;
    std::size_t single = 0;
    for (const Clip& clip : scene.clips) {
        if (clip.tracks.empty()) return false;
        for (const Track& track : clip.tracks) {
            if (!properties.insert(property_of(track)).second) return false;
        }
        for (const Curve& curve : clip.curves) {
            if (!curves.insert(property_of(curve)).second) return false;
        }
        const Track& first = clip.tracks.front();
        const bool is_single = std::all_of(clip.tracks.begin(), clip.tracks.end(), [&](const Track& track) {
            const bool is_same_kind = (track.path == TrackPath::weights) == (first.path == TrackPath::weights);
            return is_same_kind && track.target == first.target;
        });
        single += is_single ? 1 : 0;
    }
    return 2 * single > scene.clips.size();
}

}  // namespace bendy::converter
