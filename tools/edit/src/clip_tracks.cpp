#include "clip_tracks.h"

#include <bendy/format/packed_clip.h>
#include <bendy/format/records.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

namespace bendy::edit {
namespace {

/// Weights tracks are copied if their targets change: the limit on the size of the copies, as a multiple of the file's
/// size.
constexpr std::uint64_t kMostCopies = 64;

/// The parts of an array that are kept, in the order in which they are added first, as a converted file has them; parts
/// that are shared remain shared.
class KeptRuns {
public:
    void add(std::uint64_t first, std::uint64_t count) { added_.push_back({first, first + count, 0}); }
    void finish() {
        runs_ = added_;
        std::sort(runs_.begin(), runs_.end(), [](const Run& a, const Run& b) { return a.first < b.first; });
        std::vector<Run> joined;
        for (const Run& run : runs_) {
            if (!joined.empty() && (run.first < joined.back().end || run.first == joined.back().first)) {
                joined.back().end = std::max(joined.back().end, run.end);
            } else {
                joined.push_back({run.first, run.end, kNowhere});
            }
        }
        runs_ = std::move(joined);
        std::uint64_t count = 0;
        for (const Run& part : added_) {
            Run& run = *run_at(part.first);
            if (run.now != kNowhere) continue;
            run.now = count;
            count += run.end - run.first;
        }
    }
    [[nodiscard]] std::uint64_t now(std::uint64_t first) {
        const Run& run = *run_at(first);
        return run.now + first - run.first;
    }
    [[nodiscard]] std::vector<float> take(std::span<const float> from) const {
        std::vector<Run> ordered = runs_;
        std::sort(ordered.begin(), ordered.end(), [](const Run& a, const Run& b) { return a.now < b.now; });
        std::vector<float> out;
        for (const Run& run : ordered) {
            out.insert(out.end(), from.begin() + static_cast<std::ptrdiff_t>(run.first),
                       from.begin() + static_cast<std::ptrdiff_t>(run.end));
        }
        return out;
    }

private:
    struct Run {
        std::uint64_t first, end, now;
    };
    static constexpr std::uint64_t kNowhere = ~std::uint64_t{0};

    std::vector<Run>::iterator run_at(std::uint64_t first) {
        const auto after = std::upper_bound(runs_.begin(), runs_.end(), first,
                                            [](std::uint64_t wanted, const Run& run) { return wanted < run.first; });
        return std::prev(after);
    }

    std::vector<Run> added_, runs_;
};

std::span<const float> floats_in(const ChunkTree& tree, std::uint32_t clip, FourCC id) {
    const std::uint32_t chunk = tree.find(clip, id);
    if (chunk == kNone) return {};
    const Bytes payload = tree.payload(chunk);
    return view_at<float>(payload, 0, payload.size() / sizeof(float));
}

/// Returns true if the targets stay the same, in the same order.
bool is_identity(const std::vector<std::uint32_t>& from, std::uint32_t components) {
    if (from.size() != components) return false;
    for (std::uint32_t k = 0; k < components; ++k) {
        if (from[k] != k) return false;
    }
    return true;
}

class TrackRemapper {
public:
    TrackRemapper(const ChunkTree& tree, const ObjectView& object, const ClipView& clip, const TrackMap& map,
                  Rewrite& rewrite)
        : tree_(tree), object_(object), clip_(clip), map_(map), rewrite_(rewrite) {}

    Result<TrackCounts, Problem> send() {
        const std::uint32_t chunk = tree_.find(clip_.chunk, FourCC("TRAK"));
        if (chunk != kNone) {
            const Bytes payload = tree_.payload(chunk);
            table_ = view_at<TrackRecord>(payload, 0, payload.size() / sizeof(TrackRecord));
        }
        values_ = floats_in(tree_, clip_.chunk, FourCC("KEYV"));
        times_ = floats_in(tree_, clip_.chunk, FourCC("TIME"));
        for (const TrackRecord& record : table_) sort_out(record);
        decoded_ = map_.added;
        is_rebuilt_ = is_rebuilt_ || !decoded_.empty();
        send_packed();
        send_plays();
        if (is_rebuilt_) {
            if (!rebuild()) {
                return Problem{"clip \"" + std::string(clip_.name) +
                               "\": too many weights tracks share one set of values"};
            }
        } else if (is_renumbered_) {
            put(FourCC("TRAK"), std::as_bytes(std::span(kept_)));
        }
        return counts_;
    }

private:
    static bool is_weights(const TrackRecord& record) {
        return record.path == static_cast<std::uint8_t>(TrackPath::weights);
    }
    static std::uint64_t values_per_key(const TrackRecord& record) {
        const bool is_cubic = record.interpolation == static_cast<std::uint8_t>(Interpolation::cubic);
        return std::uint64_t{record.components} * (is_cubic ? 3 : 1);
    }

    void sort_out(TrackRecord record) {
        const std::uint32_t before = record.target;
        record.target = is_weights(record) ? map_.weights[before].mesh : map_.joints[before];
        const bool goes = record.target == kNone || (is_weights(record) && map_.weights[before].from.empty());
        if (goes) {
            is_rebuilt_ = true;
            ++counts_.go;
            return;
        }
        const bool is_laid_anew = is_weights(record) && !is_identity(map_.weights[before].from, record.components);
        is_rebuilt_ = is_rebuilt_ || is_laid_anew;
        is_renumbered_ = is_renumbered_ || record.target != before;
        ++counts_.stay;
        kept_.push_back(record);
        laid_anew_.push_back(is_laid_anew ? &map_.weights[before] : nullptr);
    }

    /// Keeps frames that are still consecutive in the other object.
    void send_plays() {
        const std::uint32_t chunk = tree_.find(clip_.chunk, FourCC("PLAY"));
        if (chunk == kNone) return;
        const Bytes payload = tree_.payload(chunk);
        const auto records = view_at<PlayRecord>(payload, 0, payload.size() / sizeof(PlayRecord));
        std::vector<PlayRecord> kept;
        bool is_changed = false;
        for (PlayRecord record : records) {
            const WeightMap& map = map_.weights[record.mesh];
            const std::uint32_t first = frame_there(map, record.first);
            bool stays = map.mesh != kNone && first != kNone;
            for (std::uint32_t k = 1; stays && k < record.frames; ++k)
                stays = frame_there(map, record.first + k) == first + k;
            if (!stays) {
                ++counts_.go;
                continue;
            }
            ++counts_.stay;
            is_changed = is_changed || record.mesh != map.mesh || record.first != first;
            record.mesh = map.mesh;
            record.first = first;
            kept.push_back(record);
        }
        plays_ = kept.size();
        if (plays_ == records.size() && !is_changed) return;
        if (plays_ == 0) is_rebuilt_ = true;  // the frame rate may no longer have a meaning
        put(FourCC("PLAY"), std::as_bytes(std::span(kept)));
    }

    /// Returns the frame's number in the other object; kNone: it is removed.
    [[nodiscard]] std::uint32_t frame_there(const WeightMap& map, std::uint32_t frame) {
        if (frame == 0) return 0;
        std::vector<std::uint32_t>& there = targets_there_[&map];
        if (there.empty()) {
            for (std::uint32_t k = 0; k < map.from.size(); ++k) {
                if (map.from[k] == kNone) continue;
                if (there.size() <= map.from[k]) there.resize(map.from[k] + std::size_t{1}, kNone);
                there[map.from[k]] = k;
            }
        }
        const std::uint64_t target = std::uint64_t{map.first_frame} + frame - 1;
        if (target >= there.size() || there[target] == kNone || there[target] < map.first_frame_there) return kNone;
        return there[target] - map.first_frame_there + 1;
    }

    [[nodiscard]] bool is_decoded(std::uint32_t joint) const { return !map_.decoded.empty() && map_.decoded[joint]; }

    void send_packed() {
        if (!clip_.packed) return;
        const std::uint32_t chunk = tree_.find(clip_.chunk, FourCC("PACK"));
        bool is_changed = clip_.packed->record.joints > map_.joint_count;
        for (std::uint32_t joint = 0; joint < clip_.packed->record.joints; ++joint)
            is_changed = is_changed || map_.joints[joint] != joint || is_decoded(joint);
        PackedSamples samples = packed_samples(*clip_.packed);
        if (!is_changed) {
            counts_.stay += static_cast<std::uint32_t>(samples.tracks.size());
            return;
        }
        decode(samples);
        samples.joints = map_.joint_count;
        std::vector<PackedTrack> kept;
        for (PackedTrack& track : samples.tracks) {
            const std::uint32_t joint = map_.joints[track.joint];
            if (joint == kNone) ++counts_.go;
            if (joint == kNone || is_decoded(track.joint)) continue;
            ++counts_.stay;
            track.joint = joint;
            kept.push_back(std::move(track));
        }
        samples.tracks = std::move(kept);
        std::stable_sort(samples.tracks.begin(), samples.tracks.end(),
                         [](const PackedTrack& a, const PackedTrack& b) { return a.joint < b.joint; });
        const auto payload = samples.tracks.empty() ? std::nullopt : write_packed(samples);
        if (!payload) return rewrite_.remove(chunk);
        rewrite_.replace(chunk, *payload);
    }

    /// Turns packed tracks that cannot stay packed into linear ones.
    void decode(const PackedSamples& samples) {
        const bool any = std::any_of(samples.tracks.begin(), samples.tracks.end(), [&](const PackedTrack& track) {
            return map_.joints[track.joint] != kNone && is_decoded(track.joint);
        });
        if (!any) return;
        std::vector<RestRecord> rests;
        for (const JointView& joint : object_.skeleton.joints) rests.push_back(joint.rest);
        is_rebuilt_ = true;
        for (UnpackedTrack& track : unpack_clip(*clip_.packed, rests)) {
            const std::uint32_t joint = map_.joints[track.joint];
            if (joint == kNone || !is_decoded(track.joint)) continue;
            ++counts_.stay;
            ++counts_.decoded;
            track.joint = joint;
            for (float& time : track.times) time = std::clamp(time, clip_.start, clip_.end);
            decoded_.push_back(std::move(track));
        }
    }

    /// Rebuilds TRAK, TIME and KEYV with only what is used.
    bool rebuild() {
        KeptRuns times;
        KeptRuns values;
        for (std::size_t t = 0; t < kept_.size(); ++t) {
            const TrackRecord& record = kept_[t];
            if (record.first_time != kNone) times.add(record.first_time, record.keys);
            if (laid_anew_[t] == nullptr) values.add(record.first_value, record.keys * values_per_key(record));
        }
        times.finish();
        values.finish();
        new_times_ = times.take(times_);
        new_values_ = values.take(values_);
        bool has_frames = plays_ != 0;
        for (std::size_t t = 0; t < kept_.size(); ++t) {
            TrackRecord& record = kept_[t];
            has_frames = has_frames || record.first_time == kNone;
            if (record.first_time != kNone)
                record.first_time = static_cast<std::uint32_t>(times.now(record.first_time));
            if (laid_anew_[t] == nullptr) {
                record.first_value = values.now(record.first_value);
            } else if (!lay_anew(record, *laid_anew_[t])) {
                return false;
            }
        }
        put_decoded();
        put(FourCC("TRAK"), std::as_bytes(std::span(kept_)));
        put(FourCC("TIME"), std::as_bytes(std::span(new_times_)));
        put(FourCC("KEYV"), std::as_bytes(std::span(new_values_)));
        if (!has_frames) forget_frame_rate();
        return new_times_.size() < kNone;
    }

    /// Rebuilds the track's values with one number per current target.
    bool lay_anew(TrackRecord& record, const WeightMap& map) {
        const auto key = std::make_tuple(record.first_value, record.keys, record.interpolation, &map);
        const auto [known, is_new] = laid_.try_emplace(key, new_values_.size());
        const std::uint64_t rows = record.keys * (values_per_key(record) / record.components);
        const bool is_cubic = values_per_key(record) != record.components;
        copied_ += rows * map.from.size() * sizeof(float);
        if (copied_ > kMostCopies * (tree_.bytes().size() + kKibibyte)) return false;
        for (std::uint64_t row = 0; is_new && row < rows; ++row) {
            const bool is_tangent = is_cubic && row % 3 != 1;
            for (std::size_t k = 0; k < map.from.size(); ++k) {
                const std::uint32_t from = map.from[k];
                if (from != kNone) {
                    new_values_.push_back(values_[record.first_value + row * record.components + from]);
                } else {
                    new_values_.push_back(is_tangent ? 0.0f : map.at_rest[k]);
                }
            }
        }
        record.first_value = known->second;
        record.components = static_cast<std::uint16_t>(map.from.size());
        return true;
    }

    void put_decoded() {
        std::map<std::vector<float>, std::uint32_t> known;  // frames of one clip: one or two lists of times
        for (const UnpackedTrack& track : decoded_) {
            const auto [times, is_new] = known.try_emplace(track.times, static_cast<std::uint32_t>(new_times_.size()));
            if (is_new) new_times_.insert(new_times_.end(), track.times.begin(), track.times.end());
            TrackRecord record;
            record.target = track.joint;
            record.path = static_cast<std::uint8_t>(track.path);
            record.interpolation = static_cast<std::uint8_t>(Interpolation::linear);
            record.components = static_cast<std::uint16_t>(track.components);
            record.keys = static_cast<std::uint32_t>(track.times.size());
            record.first_time = times->second;
            record.first_value = new_values_.size();
            new_values_.insert(new_values_.end(), track.values.begin(), track.values.end());
            kept_.push_back(record);
        }
    }

    /// Sets CINF.frame_rate to 0 if no track has fixed frames.
    void forget_frame_rate() {
        if (clip_.frame_rate == 0.0f) return;
        rewrite_.overwrite(tree_.find(clip_.chunk, FourCC("CINF")), offsetof(ClipRecord, frame_rate), bytes_of(0.0f));
    }

    void put(FourCC id, Bytes payload) { put_leaf(tree_, clip_.chunk, id, payload, rewrite_); }

    static constexpr std::uint64_t kKibibyte = 1024;

    const ChunkTree& tree_;
    const ObjectView& object_;
    const ClipView& clip_;
    const TrackMap& map_;
    Rewrite& rewrite_;
    std::span<const TrackRecord> table_;
    std::span<const float> times_, values_;
    std::vector<TrackRecord> kept_;
    std::vector<const WeightMap*> laid_anew_;  // one per remaining track; null: its values are unchanged
    std::size_t plays_ = 0;                    // number that remain
    std::map<const WeightMap*, std::vector<std::uint32_t>> targets_there_;  // for each target here, the one in the
                                                                            // other object
    std::vector<UnpackedTrack> decoded_;                                    // and added ones
    std::vector<float> new_times_, new_values_;
    std::map<std::tuple<std::uint64_t, std::uint32_t, std::uint8_t, const WeightMap*>, std::uint64_t> laid_;
    std::uint64_t copied_ = 0;
    bool is_rebuilt_ = false;
    bool is_renumbered_ = false;
    TrackCounts counts_;
};

}  // namespace

Result<TrackCounts, Problem> remap_tracks(const ChunkTree& tree, const ObjectView& object, const ClipView& clip,
                                          const TrackMap& map, Rewrite& rewrite) {
    return TrackRemapper(tree, object, clip, map, rewrite).send();
}

}  // namespace bendy::edit
