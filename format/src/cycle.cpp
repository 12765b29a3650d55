#include <bendy/format/cycle.h>

#include <bendy/format/read_record.h>
#include <bendy/format/text.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace bendy {
namespace {

/// A leaf that is nothing but floats: none if there is none; nothing, and a fault, if it is there and cannot be read.
std::optional<std::span<const float>> read_floats(const ChunkTree& tree, std::uint32_t cycle, FourCC id,
                                                  Faults& faults) {
    const std::uint32_t number = tree.find(cycle, id);
    if (number == kNone) return std::span<const float>();
    if (tree[number].is_container()) return std::nullopt;  // check_grammar says so
    if (const auto fault = tree.encoding_fault(number)) {
        faults.add(*fault);
        return std::nullopt;
    }
    const Bytes payload = tree.payload(number);
    const std::uint64_t count = payload.size() / sizeof(float);
    if (payload.size() % sizeof(float) != 0) {
        faults.add({ErrorCode::kRecordSize, tree[number].offset, payload.size(), count * sizeof(float)});
        return std::nullopt;
    }
    return view_at<float>(payload, 0, count);
}

/// Whether the pool has frames that could not be read, so that nobody knows how many targets there are: there is one at
/// least where there are any.
bool has_lost_frames(const ChunkTree& tree, const PoolView& pool) {
    return pool.frames() == 1 && tree.find(pool.chunk, FourCC("FRMS")) != kNone;
}

std::uint32_t components_of(TrackPath path, std::uint32_t target, std::span<const PoolView> pools) {
    if (path == TrackPath::weights) return static_cast<std::uint32_t>(pools[target].targets.size());
    return path == TrackPath::rotation ? 4 : 3;
}

/// Each track's times must ascend.
void check_key_order(const CycleView& cycle, std::span<const float> times, std::uint64_t offset, Faults& faults) {
    std::vector<std::size_t> run_start(times.size());  // where the ascending run that holds each time begins
    for (std::size_t k = 1; k < times.size(); ++k) run_start[k] = times[k] > times[k - 1] ? run_start[k - 1] : k;
    for (std::size_t index = 0; index < cycle.tracks.size(); ++index) {
        const TrackView& track = cycle.tracks[index];
        if (track.times.empty()) continue;
        const auto first = static_cast<std::size_t>(track.times.data() - times.data());
        if (run_start[first + track.keys - 1] > first) faults.add({ErrorCode::kKeyOrder, offset, index});
    }
}

/// Two tracks share all their values or none, so that the shares add up to no more than the array; and a rotation's
/// values are unit quaternions, but for cubic ones: those are normalised after interpolation.
void check_shared_values(const CycleView& cycle, std::uint64_t offset, Faults& faults) {
    struct Share {
        const float* first;
        const float* last;
        bool must_be_unit;
        std::size_t track;

        [[nodiscard]] auto key() const { return std::tie(first, last, must_be_unit, track); }
    };
    std::vector<Share> shares;
    for (std::size_t index = 0; index < cycle.tracks.size(); ++index) {
        const TrackView& track = cycle.tracks[index];
        const bool must_be_unit = track.path == TrackPath::rotation && track.interpolation != Interpolation::cubic;
        shares.push_back({track.values.data(), track.values.data() + track.values.size(), must_be_unit, index});
    }
    std::sort(shares.begin(), shares.end(), [](const Share& a, const Share& b) { return a.key() < b.key(); });
    const Share* before = nullptr;
    for (const Share& share : shares) {
        const bool is_same = before != nullptr && before->first == share.first && before->last == share.last;
        if (before != nullptr && !is_same && share.first < before->last) {
            faults.add({ErrorCode::kKeyOverlap, offset, share.track});
            return;
        }
        const bool is_checked = is_same && before->must_be_unit;
        before = &share;
        if (!share.must_be_unit || is_checked) continue;
        const TrackView& track = cycle.tracks[share.track];
        for (std::size_t key = 0; key < track.keys; ++key) {
            if (is_unit(track.values.subspan(key * 4).first<4>(), kUnitTolerance)) continue;
            faults.add({ErrorCode::kRotationNotUnit, offset, key});
            break;
        }
    }
}

bool holds_frames(const CycleView& cycle, const PackedView& packed) {
    const double length = double{cycle.end} - cycle.start;
    const double tolerance = 1e-6 * std::max({length, std::abs(double{cycle.end}), 1e-3});  // `end` is a rounded float
    return packed.record.start >= cycle.start && packed.time_of(packed.record.frames - 1) <= cycle.end + tolerance;
}

/// True when start and end ascend and no key lies outside them.
bool holds_all_keys(const CycleView& cycle) {
    if (!(cycle.start <= cycle.end && cycle.frame_rate >= 0.0f)) return false;
    if (cycle.packed && !holds_frames(cycle, *cycle.packed)) return false;
    constexpr double kFrames = 1e-3;  // of a frame: `end` is a rounded float
    const double most = (double{cycle.end} - cycle.start) * cycle.frame_rate + kFrames;
    const auto fits = [&](const PlayView& play) { return play.frames - 1.0 + (play.closed ? 1.0 : 0.0) <= most; };
    if (!std::all_of(cycle.plays.begin(), cycle.plays.end(), fits)) return false;
    const auto holds = [&](const CurveView& curve) {
        return curve.times.front() >= cycle.start && curve.times.back() <= cycle.end;
    };
    if (!std::all_of(cycle.curves.begin(), cycle.curves.end(), holds)) return false;
    return std::all_of(cycle.tracks.begin(), cycle.tracks.end(), [&](const TrackView& track) {
        if (!track.times.empty()) return track.times.front() >= cycle.start && track.times.back() <= cycle.end;
        return track.keys - 1.0 <= most;
    });
}

/// A pool is played once, and by no track.
void check_repeated_plays(const CycleView& cycle, std::uint64_t offset, Faults& faults) {
    std::vector<std::pair<std::uint32_t, std::size_t>> pools;
    for (std::size_t index = 0; index < cycle.plays.size(); ++index) pools.emplace_back(cycle.plays[index].pool, index);
    std::sort(pools.begin(), pools.end());
    for (std::size_t k = 1; k < pools.size(); ++k) {
        if (pools[k].first == pools[k - 1].first) faults.add({ErrorCode::kTrackRepeated, offset, pools[k].second});
    }
    for (const TrackView& track : cycle.tracks) {
        if (track.path != TrackPath::weights) continue;
        const auto play = std::lower_bound(pools.begin(), pools.end(), std::pair(track.target, std::size_t{0}));
        if (play != pools.end() && play->first == track.target)
            faults.add({ErrorCode::kTrackRepeated, offset, play->second});
    }
}

std::vector<PlayView> read_plays(const ChunkTree& tree, const CycleView& cycle, std::span<const PoolView> pools,
                                 Faults& faults) {
    std::vector<PlayView> plays;
    const std::uint32_t number = tree.find(cycle.chunk, FourCC("PLAY"));
    if (number == kNone || tree[number].is_container() || !cycle.has_info) return plays;
    const std::uint64_t offset = tree[number].offset;
    if (const auto fault = tree.encoding_fault(number)) {
        faults.add(*fault);
        return plays;
    }
    const Bytes payload = tree.payload(number);
    const std::uint64_t count = payload.size() / sizeof(PlayRecord);
    if (payload.size() % sizeof(PlayRecord) != 0) {
        faults.add({ErrorCode::kRecordSize, offset, payload.size(), count * sizeof(PlayRecord)});
        return plays;
    }
    plays.reserve(count);
    for (std::uint64_t index = 0; index < count; ++index) {
        PlayRecord record;
        copy_at(payload, index * sizeof(PlayRecord), record);
        check_reserved(record.reserved, offset, faults);
        if (!check_enum(record.closed, 2, offset, faults)) continue;
        if (record.pool >= pools.size()) {
            faults.add({ErrorCode::kPoolRange, offset, record.pool, pools.size()});
            continue;
        }
        if (has_lost_frames(tree, pools[record.pool])) continue;
        const std::uint32_t frames = pools[record.pool].frames();
        const bool is_there = record.frames != 0 && record.first <= frames && record.frames <= frames - record.first;
        if (!is_there || !(cycle.frame_rate > 0.0f)) {
            faults.add({ErrorCode::kFrameRange, offset, index});
            continue;
        }
        plays.push_back({record.pool, record.first, record.frames, record.closed != 0});
    }
    return plays;
}

void check_repeated_tracks(const CycleView& cycle, std::uint64_t offset, Faults& faults) {
    std::vector<std::tuple<std::uint32_t, TrackPath, std::size_t>> properties;
    for (std::size_t index = 0; index < cycle.tracks.size(); ++index) {
        properties.emplace_back(cycle.tracks[index].target, cycle.tracks[index].path, index);
    }
    std::sort(properties.begin(), properties.end());
    for (const auto& [target, path, index] : properties) {
        if (cycle.packed && path != TrackPath::weights && cycle.packed->animates(target, path))
            faults.add({ErrorCode::kTrackRepeated, offset, index});
    }
    for (std::size_t k = 1; k < properties.size(); ++k) {
        const auto& [target, path, index] = properties[k];
        if (target == std::get<0>(properties[k - 1]) && path == std::get<1>(properties[k - 1])) {
            faults.add({ErrorCode::kTrackRepeated, offset, index});
        }
    }
}

std::vector<Marker> read_marker_leaf(const ChunkTree& tree, std::uint32_t cycle, Faults& faults) {
    const std::uint32_t number = tree.find(cycle, FourCC("MARK"));
    if (number == kNone || tree[number].is_container()) return {};
    if (const auto fault = tree.encoding_fault(number)) {
        faults.add(*fault);
        return {};
    }
    return read_markers(tree.payload(number), tree[number].offset, faults).value_or(std::vector<Marker>());
}

std::vector<CurveView> read_curve_leaves(const ChunkTree& tree, std::uint32_t cycle, const TargetCounts& counts,
                                         Faults& faults) {
    std::vector<CurveView> curves;
    for (const std::uint32_t number : tree.children(cycle)) {
        if (tree[number].id != FourCC("CURV") || tree[number].is_container()) continue;
        if (const auto fault = tree.encoding_fault(number)) {
            faults.add(*fault);
            continue;
        }
        auto curve = read_curve(tree.payload(number), counts, tree[number].offset, faults);
        if (!curve) continue;
        curve->chunk = number;
        curves.push_back(*curve);
    }
    return curves;
}

void check_curves(const ChunkTree& tree, const CycleView& cycle, Faults& faults) {
    for (const CurveView& curve : cycle.curves) check_curve_values(curve, tree[curve.chunk].offset, faults);
    std::vector<const CurveView*> sorted;
    for (const CurveView& curve : cycle.curves) {
        if (!curve.path.empty()) sorted.push_back(&curve);
    }
    const auto property = [](const CurveView* curve) { return std::tie(curve->kind, curve->target, curve->path); };
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](const CurveView* a, const CurveView* b) { return property(a) < property(b); });
    for (std::size_t k = 1; k < sorted.size(); ++k) {
        if (property(sorted[k]) == property(sorted[k - 1]))
            faults.add({ErrorCode::kCurveRepeated, tree[sorted[k]->chunk].offset});
    }
}

std::optional<PackedView> read_packed_leaf(const ChunkTree& tree, std::uint32_t cycle, std::uint32_t joints,
                                           Faults& faults) {
    const std::uint32_t number = tree.find(cycle, FourCC("PACK"));
    if (number == kNone || tree[number].is_container()) return std::nullopt;
    if (const auto fault = tree.encoding_fault(number)) {
        faults.add(*fault);
        return std::nullopt;
    }
    return read_packed(tree.payload(number), joints, tree[number].offset, faults);
}

void check_markers(const CycleView& cycle, std::uint64_t offset, Faults& faults) {
    const auto first_of = [&](auto is_wrong, ErrorCode code) {
        for (std::size_t k = 0; k < cycle.markers.size(); ++k) {
            if (!is_wrong(k)) continue;
            faults.add({code, offset, k});
            return;
        }
    };
    const auto time = [&](std::size_t k) { return cycle.markers[k].seconds; };
    first_of([&](std::size_t k) { return !std::isfinite(time(k)); }, ErrorCode::kNotFinite);
    first_of([&](std::size_t k) { return k > 0 && !(time(k - 1) <= time(k)); }, ErrorCode::kMarkerOrder);
    if (!cycle.has_info) return;
    first_of([&](std::size_t k) { return !(time(k) >= cycle.start && time(k) <= cycle.end); },
             ErrorCode::kMarkerOutside);
}

}  // namespace

CycleView read_cycle(const ChunkTree& tree, std::uint32_t chunk, const TargetCounts& counts,
                     std::span<const PoolView> pools, Faults& faults) {
    const std::uint32_t joints = counts.joints;
    CycleView cycle;
    cycle.chunk = chunk;
    cycle.name = read_text(tree, chunk, FourCC("NAME"), faults);
    cycle.extras = read_text(tree, chunk, FourCC("EXTR"), faults);
    cycle.more = read_text(tree, chunk, FourCC("MORE"), faults);
    const auto read_info = read_child_record<CycleRecord>(tree, chunk, FourCC("CINF"), faults);
    const CycleRecord info = read_info.value_or(CycleRecord{});
    cycle.has_info = read_info.has_value();
    cycle.start = info.start;
    cycle.end = info.end;
    cycle.frame_rate = info.frame_rate;
    cycle.loop = info.loop == 1;
    const std::uint64_t info_offset = offset_of(tree, chunk, FourCC("CINF"));
    check_enum(info.loop, 2, info_offset, faults);
    check_reserved(info.reserved, info_offset, faults);

    cycle.packed = read_packed_leaf(tree, chunk, joints, faults);
    cycle.markers = read_marker_leaf(tree, chunk, faults);
    cycle.plays = read_plays(tree, cycle, pools, faults);
    cycle.curves = read_curve_leaves(tree, chunk, counts, faults);
    const auto read_times = read_floats(tree, chunk, FourCC("TIME"), faults);
    const auto read_values = read_floats(tree, chunk, FourCC("KEYV"), faults);

    const std::uint32_t table = tree.find(chunk, FourCC("TRAK"));
    if (table == kNone || tree[table].is_container()) return cycle;
    const std::uint64_t offset = tree[table].offset;
    const Bytes payload = tree.payload(table);
    if (const auto fault = tree.encoding_fault(table)) {
        faults.add(*fault);
        return cycle;
    }
    const std::uint64_t count = payload.size() / sizeof(TrackRecord);
    if (payload.size() % sizeof(TrackRecord) != 0) {
        faults.add({ErrorCode::kRecordSize, offset, payload.size(), count * sizeof(TrackRecord)});
        return cycle;
    }
    if (!read_times || !read_values || !cycle.has_info) return cycle;  // no track can be held against them
    const std::span<const float> times = *read_times;
    const std::span<const float> values = *read_values;
    cycle.tracks.reserve(count);
    for (std::uint64_t index = 0; index < count; ++index) {
        TrackRecord record;
        copy_at(payload, index * sizeof(TrackRecord), record);
        if (!check_enum(record.path, kTrackPaths, offset, faults)) continue;
        if (!check_enum(record.interpolation, kInterpolations, offset, faults)) continue;
        TrackView track;
        track.path = static_cast<TrackPath>(record.path);
        track.interpolation = static_cast<Interpolation>(record.interpolation);
        track.target = record.target;
        track.components = record.components;
        track.keys = record.keys;
        const bool on_pool = track.path == TrackPath::weights;
        const std::uint64_t targets = on_pool ? pools.size() : joints;
        if (track.target >= targets) {
            faults.add({on_pool ? ErrorCode::kPoolRange : ErrorCode::kJointRange, offset, track.target, targets});
            continue;
        }
        if (on_pool && has_lost_frames(tree, pools[track.target])) continue;
        if (track.components == 0 || track.components != components_of(track.path, track.target, pools)) {
            faults.add({ErrorCode::kTrackComponents, offset, index});
            continue;
        }
        const bool fixed_frames = record.first_time == kNone;
        const std::uint64_t per_key =
            std::uint64_t{track.components} * (track.interpolation == Interpolation::cubic ? 3 : 1);
        const bool times_fit =
            fixed_frames ? cycle.frame_rate > 0.0f
                         : record.first_time <= times.size() && track.keys <= times.size() - record.first_time;
        const bool values_fit =
            record.first_value <= values.size() && track.keys <= (values.size() - record.first_value) / per_key;
        if (track.keys == 0 || !times_fit || !values_fit) {
            faults.add({ErrorCode::kKeyRange, offset, index});
            continue;
        }
        if (!fixed_frames) track.times = times.subspan(record.first_time, track.keys);
        track.values = values.subspan(record.first_value, track.keys * per_key);
        cycle.tracks.push_back(track);
    }
    return cycle;
}

void check_cycle_values(const ChunkTree& tree, const CycleView& cycle, Faults& faults) {
    const std::uint64_t info_offset = offset_of(tree, cycle.chunk, FourCC("CINF"));
    const std::uint64_t table_offset = offset_of(tree, cycle.chunk, FourCC("TRAK"));
    check_finite(std::array{cycle.start, cycle.end, cycle.frame_rate}, info_offset, faults);

    // Many tracks may share keys, so what takes a look at each key looks at the arrays once, not at each track's share.
    Faults unread;  // read_cycle has said it
    constexpr std::span<const float> kNoFloats;
    const auto times = read_floats(tree, cycle.chunk, FourCC("TIME"), unread).value_or(kNoFloats);
    check_finite(times, offset_of(tree, cycle.chunk, FourCC("TIME")), faults);
    check_finite(read_floats(tree, cycle.chunk, FourCC("KEYV"), unread).value_or(kNoFloats),
                 offset_of(tree, cycle.chunk, FourCC("KEYV")), faults);
    check_key_order(cycle, times, table_offset, faults);
    check_shared_values(cycle, table_offset, faults);
    if (cycle.has_info && !holds_all_keys(cycle)) faults.add({ErrorCode::kCycleLength, info_offset});
    check_repeated_tracks(cycle, table_offset, faults);
    check_repeated_plays(cycle, offset_of(tree, cycle.chunk, FourCC("PLAY")), faults);
    check_markers(cycle, offset_of(tree, cycle.chunk, FourCC("MARK")), faults);
    check_curves(tree, cycle, faults);
    if (cycle.packed) check_packed_values(*cycle.packed, offset_of(tree, cycle.chunk, FourCC("PACK")), faults);
}

}  // namespace bendy
