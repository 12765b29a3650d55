#include "clip_keys.h"

#include <bendy/format/packed_clip.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <map>
#include <string_view>
#include <utility>

namespace bendy::edit {
namespace {

constexpr std::uint64_t kMostKeyCopies = 64;         // as a multiple of the file's size
constexpr std::uint64_t kMostNumbers = 1u << 28u;    // 1 GiB
constexpr std::uint64_t kAlwaysAllowed = 1u << 16u;  // numbers, in a small file

bool ascend(std::span<const float> times) {
    return std::adjacent_find(times.begin(), times.end(), [](float a, float b) { return !(a < b); }) == times.end();
}

/// Fixed frames as times: frame k is at start + k / frame_rate.
std::vector<float> times_of(const TrackView& track, const ClipView& clip) {
    if (!track.times.empty()) return {track.times.begin(), track.times.end()};
    std::vector<float> times;
    times.reserve(track.keys);
    for (std::uint32_t k = 0; k < track.keys; ++k)
        times.push_back(std::min(static_cast<float>(clip.start + k / double{clip.frame_rate}), clip.end));
    return times;
}

ClipTrack read_track(const TrackView& track, const ClipView& clip) {
    ClipTrack read;
    read.path = track.path;
    read.target = track.target;
    read.has_frames = track.times.empty();
    read.interpolation = track.interpolation;
    read.is_rotation = track.path == TrackPath::rotation;
    read.components = track.components;
    read.times = times_of(track, clip);
    read.values.assign(track.values.begin(), track.values.end());
    return read;
}

ClipCurve read_curve_keys(const CurveView& curve) {
    ClipCurve read;
    read.view = &curve;
    read.target = curve.target;
    read.name = curve.name;
    read.path = curve.path;
    read.interpolation = curve.interpolation;
    read.components = curve.components;
    read.times.assign(curve.times.begin(), curve.times.end());
    for (std::size_t k = 0; k < curve.value_count(); ++k) read.values.push_back(curve.value(k));
    return read;
}

/// Lists of numbers of tracks, one after another; equal lists are stored once.
class Lists {
public:
    std::uint64_t add(std::span<const float> list) {
        const auto* text = reinterpret_cast<const char*>(list.data());
        const auto [known, is_new] = places_.try_emplace(std::string_view(text, list.size_bytes()), numbers_.size());
        if (is_new) numbers_.insert(numbers_.end(), list.begin(), list.end());
        return known->second;
    }
    [[nodiscard]] const std::vector<float>& numbers() const { return numbers_; }

private:
    std::map<std::string_view, std::uint64_t> places_;  // by the bytes, which the tracks own
    std::vector<float> numbers_;
};

class Writer {
public:
    Writer(const ChunkTree& tree, const ClipKeys& keys, Rewrite& rewrite)
        : tree_(tree), keys_(keys), rewrite_(rewrite), clip_(keys.view->chunk) {}

    void write() {
        Lists times;
        Lists values;
        std::vector<TrackRecord> table;
        for (const ClipTrack& track : keys_.tracks) {
            TrackRecord& record = table.emplace_back();
            record.target = track.target;
            record.path = static_cast<std::uint8_t>(track.path);
            record.interpolation = static_cast<std::uint8_t>(track.interpolation);
            record.components = static_cast<std::uint16_t>(track.components);
            record.keys = static_cast<std::uint32_t>(track.times.size());
            record.first_time = track.has_frames ? kNone : static_cast<std::uint32_t>(times.add(track.times));
            record.first_value = values.add(track.values);
            has_frames_ = has_frames_ || track.has_frames;
        }
        put_leaf(tree_, clip_, FourCC("TRAK"), std::as_bytes(std::span(table)), rewrite_);
        put_leaf(tree_, clip_, FourCC("TIME"), std::as_bytes(std::span(times.numbers())), rewrite_);
        put_leaf(tree_, clip_, FourCC("KEYV"), std::as_bytes(std::span(values.numbers())), rewrite_);
        put_leaf(tree_, clip_, FourCC("PLAY"), std::as_bytes(std::span(keys_.plays)), rewrite_);
        if (keys_.view->packed) put_leaf(tree_, clip_, FourCC("PACK"), {}, rewrite_);
        for (const ClipCurve& curve : keys_.curves) put_curve(curve);
        put_markers();
        put_info();
    }

private:
    void put_curve(const ClipCurve& curve) {
        CurveView view = *curve.view;
        view.target = curve.target;
        view.name = curve.name;
        view.path = curve.path;
        if (curve.has_new_keys) {
            view.interpolation = curve.interpolation;
            view.keys = static_cast<std::uint32_t>(curve.times.size());
            view.times = curve.times;
            view.values = curve.values;
            view.packed = {};
            view.box = {};
        }
        rewrite_.replace(curve.view->chunk, write_curve(view));
    }

    void put_markers() {
        std::vector<Marker> markers;
        for (const ClipMarker& marker : keys_.markers) markers.push_back({marker.seconds, marker.name});
        if (tree_.find(clip_, FourCC("MARK")) == kNone) return;
        put_leaf(tree_, clip_, FourCC("MARK"), markers.empty() ? Buffer() : write_markers(markers), rewrite_);
    }

    void put_info() {
        const std::uint32_t chunk = tree_.find(clip_, FourCC("CINF"));
        ClipRecord record;
        copy_at(tree_.payload(chunk), 0, record);
        record.start = keys_.start;
        record.end = keys_.end;
        record.loop = keys_.loop ? 1 : 0;
        if (!has_frames_ && keys_.plays.empty()) record.frame_rate = 0.0f;
        rewrite_.overwrite(chunk, 0, bytes_of(record));
    }

    const ChunkTree& tree_;
    const ClipKeys& keys_;
    Rewrite& rewrite_;
    std::uint32_t clip_;
    bool has_frames_ = false;
};

bool is_finite(std::span<const float> numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](float number) { return std::isfinite(number); });
}

}  // namespace

Result<ClipKeys, Problem> read_keys(const ChunkTree& tree, const ObjectView& object, const ClipView& clip) {
    std::uint64_t numbers = 0;
    for (const TrackView& track : clip.tracks) numbers += track.values.size() + track.keys;
    if (numbers > kMostKeyCopies * (tree.bytes().size() / sizeof(float)) + kAlwaysAllowed)
        return Problem{"too many tracks share one set of values"};
    ClipKeys keys;
    keys.object = &object;
    keys.view = &clip;
    keys.start = clip.start;
    keys.end = clip.end;
    keys.loop = clip.loop;
    for (const TrackView& track : clip.tracks) keys.tracks.push_back(read_track(track, clip));
    if (clip.packed) {
        std::vector<RestRecord> rests;
        for (const JointView& joint : object.skeleton.joints) rests.push_back(joint.rest);
        for (UnpackedTrack& track : unpack_clip(*clip.packed, rests)) {
            ClipTrack& read = keys.tracks.emplace_back();
            read.path = track.path;
            read.target = track.joint;
            read.is_rotation = track.path == TrackPath::rotation;
            read.components = track.components;
            read.times = std::move(track.times);
            read.values = std::move(track.values);
            for (float& time : read.times) time = std::clamp(time, clip.start, clip.end);
            ++keys.decoded;
        }
    }
    const auto is_ordered = [](const ClipTrack& track) { return ascend(track.times); };
    if (!std::all_of(keys.tracks.begin(), keys.tracks.end(), is_ordered))
        return Problem{"its frames follow one another so fast that their times are the same number"};
    for (const CurveView& curve : clip.curves) keys.curves.push_back(read_curve_keys(curve));
    for (const Marker& marker : clip.markers) keys.markers.push_back({marker.seconds, std::string(marker.name)});
    keys.plays = clip.plays;
    return keys;
}

Result<void, Problem> write_keys(const ChunkTree& tree, const ClipKeys& keys, Rewrite& rewrite) {
    std::uint64_t numbers = 0;
    for (const ClipTrack& track : keys.tracks) {
        numbers += track.values.size() + track.times.size();
        if (!is_finite(track.values)) return Problem{"its numbers are too large for that"};
    }
    for (const ClipCurve& curve : keys.curves) {
        numbers += curve.values.size() + curve.times.size();
        if (!is_finite(curve.values)) return Problem{"its numbers are too large for that"};
    }
    if (numbers > kMostNumbers) return Problem{"it would have " + std::to_string(numbers) + " numbers"};
    Writer(tree, keys, rewrite).write();
    return {};
}

}  // namespace bendy::edit
