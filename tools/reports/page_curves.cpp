#include "reports/page_curves.h"

#include "reports/json.h"
#include "reports/messages.h"

#include <bendy/runtime/sample.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace bendy::tools {
namespace {

using Json = OrderedJson;

constexpr std::uint64_t kMostNumbers = 400'000;  // for all tracks together
constexpr std::size_t kMostPoints = 240;         // per track
constexpr std::size_t kFewestPoints = 16;
constexpr std::size_t kMostCurves = 24;  // per track: weights of morph targets
constexpr std::size_t kMostClips = 1'000;

/// The time of a key, seconds.
float key_time(const TrackView& track, const ClipView& clip, std::size_t key) {
    if (!track.times.empty()) return track.times[key];
    return clip.frame_rate > 0.0f ? clip.start + static_cast<float>(key) / clip.frame_rate : clip.start;
}

/// Returns the times at which a track is sampled: at its keys, and between them if it is not linear there; if these are
/// too many, at equal intervals.
std::vector<float> times_of(const TrackView& track, const ClipView& clip, std::size_t most) {
    constexpr std::size_t kMostBetween = 8;
    const bool is_straight = track.interpolation == Interpolation::step ||
                             (track.interpolation == Interpolation::linear && track.path != TrackPath::rotation);
    const std::size_t intervals = track.keys - std::size_t{1};
    std::vector<float> times;
    const float first = key_time(track, clip, 0);
    const float last = key_time(track, clip, intervals);
    if (clip.start < first) times.push_back(clip.start);
    if (intervals + 1 > most) {
        const auto steps = static_cast<float>(most - 1);
        for (std::size_t k = 0; k < most; ++k) times.push_back(first + (last - first) * static_cast<float>(k) / steps);
    } else {
        const std::size_t parts =
            is_straight || intervals == 0 ? 1 : std::clamp<std::size_t>((most - 1) / intervals, 1, kMostBetween);
        for (std::size_t key = 0; key < intervals; ++key) {
            const float left = key_time(track, clip, key);
            const float right = key_time(track, clip, key + 1);
            for (std::size_t part = 0; part < parts; ++part)
                times.push_back(left + (right - left) * static_cast<float>(part) / static_cast<float>(parts));
        }
        times.push_back(last);
    }
    if (clip.end > last) times.push_back(clip.end);
    return times;
}

Json target_names(const MeshView& mesh) {
    Json names = Json::array();
    for (const MorphTargetView& target : mesh.targets) {
        if (names.size() == kMostCurves) break;
        names.push_back(brief(target.name));
    }
    return names;
}

std::uint32_t shown_components(TrackPath path) {
    return path == TrackPath::rotation ? 4 : 3;
}

/// Returns how many numbers one frame has in all tracks, as the page shows them.
std::uint64_t packed_numbers(const PackedView& packed) {
    std::uint64_t numbers = 0;
    for (std::size_t k = 0; k < kPackedLists; ++k)
        numbers += std::uint64_t{packed.lists[k].count} * shown_components(kPackedKinds[k].path);
    return numbers;
}

std::uint64_t packed_tracks(const PackedView& packed) {
    std::uint64_t tracks = 0;
    for (const PackedList& list : packed.lists) tracks += list.count;
    return tracks;
}

/// Converts a packed value, which is relative to rest, to a key's value; x y z, or x y z w for a rotation.
std::array<float, 4> unpacked_value(const PackedGroup& group, std::uint32_t track, const RestRecord& rest) {
    const std::array<double, 3> v{group.left[0][track], group.left[1][track], group.left[2][track]};
    std::array<float, 4> value{};
    if (group.kind.path == TrackPath::rotation) {
        const auto q = blend_packed_rotations(rest.rotation, v, v, 0.0);
        for (std::size_t c = 0; c < 4; ++c) value[c] = static_cast<float>(q[c]);
        return value;
    }
    const auto& at_rest = group.kind.path == TrackPath::translation ? rest.translation : rest.scale;
    for (std::size_t c = 0; c < 3; ++c)
        value[c] = static_cast<float>(static_cast<double>(at_rest[c]) + v[group.kind.components == 1 ? 0 : c]);
    return value;
}

/// Returns a clip's markers for the page, as [seconds, name] each, limited in number.
Json shown_markers(const ClipView& clip) {
    constexpr std::size_t kMostMarkers = 200;
    Json markers = Json::array();
    for (const Marker& marker : std::span(clip.markers).first(std::min(clip.markers.size(), kMostMarkers)))
        markers.push_back(Json::array({short_number(marker.seconds), brief(marker.name)}));
    return markers;
}

/// Returns the frames that a clip plays, and of which mesh.
Json shown_plays(const ClipView& clip, const ObjectView& object) {
    constexpr std::size_t kMostPlays = 24;
    Json plays = Json::array();
    for (const PlayRecord& play : std::span(clip.plays).first(std::min(clip.plays.size(), kMostPlays))) {
        plays.push_back({{"mesh", brief(object.meshes[play.mesh].name)},
                         {"first", play.first},
                         {"frames", play.frames},
                         {"closed", play.closed != 0}});
    }
    return plays;
}

}  // namespace

CurveSampler::CurveSampler(std::span<const ObjectView> objects) : budget_(kMostNumbers) {
    std::uint64_t components = 0;
    for (const ObjectView& object : objects) {
        for (const ClipView& clip : object.clips) {
            for (const TrackView& track : clip.tracks) components += track.components;
            if (clip.packed) components += packed_numbers(*clip.packed);
        }
    }
    points_ = static_cast<std::size_t>(
        std::clamp<std::uint64_t>(kMostNumbers / std::max<std::uint64_t>(components, 1), kFewestPoints, kMostPoints));
}

std::size_t CurveSampler::number_of(std::vector<float> times) {
    // NaN cannot be sorted.
    std::replace_if(
        times.begin(), times.end(), [](float time) { return !std::isfinite(time); }, 0.0f);
    const auto [found, is_new] = numbers_.try_emplace(std::move(times), lists_.size());
    if (is_new) lists_.push_back(found->first);
    return found->second;
}

Json CurveSampler::sampled(const TrackView& track, const ClipView& clip, const ObjectView& object) {
    const std::vector<float> times = times_of(track, clip, points_);
    constexpr std::uint64_t kTrackItself = 16;  // the size of a track on the page besides its numbers
    const std::uint64_t numbers = std::uint64_t{track.components} * times.size() + kTrackItself;
    if (numbers > budget_) {
        ++left_out_;
        return nullptr;
    }
    budget_ -= numbers;
    if (track.keys > points_) ++thinned_;
    const std::size_t shown = std::min<std::size_t>(track.components, kMostCurves);
    std::vector<Json> curves(shown, Json::array());
    std::vector<float> value(track.components);
    for (const float time : times) {
        sample_track(track, clip, time, value);
        for (std::size_t c = 0; c < shown; ++c) curves[c].push_back(short_number(value[c]));
    }
    Json json{{"path", static_cast<unsigned>(track.path)},
              {"target", track.target},
              {"interpolation", static_cast<unsigned>(track.interpolation)},
              {"keys", track.keys},
              {"components", track.components},
              {"times", number_of(times)},
              {"values", std::move(curves)}};
    if (track.path == TrackPath::weights && track.target < object.meshes.size()) {
        json["mesh"] = brief(object.meshes[track.target].name);
        json["names"] = target_names(object.meshes[track.target]);
    }
    return json;
}

void CurveSampler::add_packed(const PackedView& packed, const ClipView& clip, const ObjectView& object, Json& tracks) {
    const std::uint32_t frames = packed.record.frames;
    const std::size_t points = std::min<std::size_t>(frames, points_);
    constexpr std::uint64_t kTrackItself = 16;
    const std::uint64_t count = packed_tracks(packed);
    const std::uint64_t numbers = packed_numbers(packed) * points + count * kTrackItself;
    if (numbers > budget_) {
        left_out_ += count;
        return;
    }
    budget_ -= numbers;
    if (points < frames) thinned_ += count;
    const std::size_t first = tracks.size();
    std::vector<float> times;
    for (std::size_t point = 0; point < points; ++point) {
        const auto frame =
            static_cast<std::uint32_t>(points < 2 ? 0 : std::uint64_t{point} * (frames - 1) / (points - 1));
        times.push_back(static_cast<float>(packed.time_of(frame)));
        PackedGroupReader reader(packed, frame);
        std::size_t track = first;
        for (PackedGroup group; reader.next(group);) {
            for (std::uint32_t t = 0; t < group.count; ++t, ++track) {
                if (point == 0) tracks.push_back(packed_track(group, t, frames));
                if (point > 0 && !group.kind.animated) continue;
                const auto value = unpacked_value(group, t, object.skeleton.joints[group.joints[t]].rest);
                Json& curves = tracks[track]["values"];
                for (std::size_t c = 0; c < curves.size(); ++c) curves[c].push_back(short_number(value[c]));
            }
        }
    }
    const std::size_t moving = number_of(times);
    const std::size_t still = number_of({clip.start});
    for (std::size_t track = first; track < tracks.size(); ++track)
        tracks[track]["times"] = tracks[track]["values"][0].size() == times.size() ? moving : still;
}

Json CurveSampler::packed_track(const PackedGroup& group, std::uint32_t track, std::uint32_t frames) {
    Json values = Json::array();
    for (std::uint32_t c = 0; c < shown_components(group.kind.path); ++c) values.push_back(Json::array());
    return {{"path", static_cast<unsigned>(group.kind.path)},
            {"target", group.joints[track]},
            {"interpolation", static_cast<unsigned>(Interpolation::linear)},
            {"keys", group.kind.animated ? frames : 1},
            {"components", values.size()},
            {"times", 0},
            {"values", std::move(values)}};
}

Json CurveSampler::clips(const ObjectView& object) {
    Json list = Json::array();
    for (const ClipView& clip : object.clips) {
        if (list.size() == kMostClips) {
            left_out_ += clip.tracks.size() + (clip.packed ? packed_tracks(*clip.packed) : 0);
            continue;
        }
        Json tracks = Json::array();
        for (const TrackView& track : clip.tracks) {
            if (Json one = sampled(track, clip, object); !one.is_null()) tracks.push_back(std::move(one));
        }
        if (clip.packed) add_packed(*clip.packed, clip, object, tracks);
        list.push_back({{"name", brief(clip.name)},
                        {"chunk", clip.chunk},
                        {"start", short_number(clip.start)},
                        {"end", short_number(clip.end)},
                        {"rate", short_number(clip.frame_rate)},
                        {"loop", clip.loop},
                        {"total", clip.tracks.size() + (clip.packed ? packed_tracks(*clip.packed) : 0)},
                        {"plays", shown_plays(clip, object)},
                        {"markers", shown_markers(clip)},
                        {"tracks", std::move(tracks)}});
    }
    return {{"total", object.clips.size()}, {"list", std::move(list)}};
}

Json CurveSampler::times() const {
    Json lists = Json::array();
    for (const std::vector<float>& list : lists_) {
        Json numbers = Json::array();
        for (const float time : list) numbers.push_back(short_number(time));
        lists.push_back(std::move(numbers));
    }
    return lists;
}

}  // namespace bendy::tools
