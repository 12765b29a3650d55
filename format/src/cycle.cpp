#include <bendy/format/cycle.h>

#include <bendy/format/read_record.h>
#include <bendy/format/text.h>

#include <algorithm>
#include <utility>

namespace bendy {
namespace {

/// A leaf that is nothing but floats.
std::span<const float> read_floats(const ChunkTree& tree, std::uint32_t cycle, FourCC id, Faults& faults) {
    const std::uint32_t number = tree.find(cycle, id);
    if (number == kNone || tree[number].is_container()) return {};
    const Chunk& chunk = tree[number];
    if (chunk.codec() != 0) {
        faults.add({ErrorCode::kUnsupportedCodec, chunk.offset, chunk.codec()});
        return {};
    }
    if (chunk.size % sizeof(float) != 0) {
        faults.add({ErrorCode::kRecordSize, chunk.offset, chunk.size, chunk.size / sizeof(float) * sizeof(float)});
        return {};
    }
    return view_at<float>(tree.payload(number), 0, chunk.size / sizeof(float));
}

std::uint32_t components_of(TrackPath path, std::uint32_t target, std::span<const PoolView> pools) {
    switch (path) {
        case TrackPath::translation:
        case TrackPath::scale: return 3;
        case TrackPath::rotation: return 4;
        case TrackPath::weights: return static_cast<std::uint32_t>(pools[target].targets.size());
    }
    return 0;
}

}  // namespace

CycleView read_cycle(const ChunkTree& tree, std::uint32_t chunk, std::uint32_t joints, std::span<const PoolView> pools, Faults& faults) {
    CycleView cycle;
    cycle.chunk = chunk;
    cycle.name = read_text(tree, chunk, FourCC("NAME"), faults);
    cycle.extras = read_text(tree, chunk, FourCC("EXTR"), faults);
    const auto info = read_child_record<CycleRecord>(tree, chunk, FourCC("CINF"), faults).value_or(CycleRecord{});
    cycle.start = info.start;
    cycle.end = info.end;
    cycle.frame_rate = info.frame_rate;
    cycle.loop = info.loop == 1;
    check_enum(info.loop, 2, tree[chunk].offset, faults);
    check_reserved(info.reserved, tree[chunk].offset, faults);

    const std::uint32_t table = tree.find(chunk, FourCC("TRAK"));
    if (table == kNone || tree[table].is_container()) return cycle;
    const std::uint64_t offset = tree[table].offset;
    const Bytes payload = tree.payload(table);
    if (tree[table].codec() != 0) {
        faults.add({ErrorCode::kUnsupportedCodec, offset, tree[table].codec()});
        return cycle;
    }
    const std::uint64_t count = payload.size() / sizeof(TrackRecord);
    if (payload.size() % sizeof(TrackRecord) != 0) {
        faults.add({ErrorCode::kRecordSize, offset, payload.size(), count * sizeof(TrackRecord)});
        return cycle;
    }
    const auto times = read_floats(tree, chunk, FourCC("TIME"), faults);
    const auto values = read_floats(tree, chunk, FourCC("KEYV"), faults);
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
        if (track.components == 0 || track.components != components_of(track.path, track.target, pools)) {
            faults.add({ErrorCode::kTrackComponents, offset, index});
            continue;
        }
        const bool fixed_frames = record.first_time == kNone;
        const std::uint64_t per_key = std::uint64_t{track.components} * (track.interpolation == Interpolation::cubic ? 3 : 1);
        const bool times_fit = fixed_frames ? cycle.frame_rate > 0.0f
                                            : record.first_time <= times.size() && track.keys <= times.size() - record.first_time;
        const bool values_fit = record.first_value <= values.size() && track.keys <= (values.size() - record.first_value) / per_key;
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
    const std::uint64_t offset = tree[cycle.chunk].offset;
    check_finite(std::array{cycle.start, cycle.end, cycle.frame_rate}, offset, faults);
    bool length_holds = cycle.start <= cycle.end && cycle.frame_rate >= 0.0f;
    std::vector<std::pair<std::uint64_t, std::size_t>> properties;
    for (std::size_t index = 0; index < cycle.tracks.size(); ++index) {
        const TrackView& track = cycle.tracks[index];
        properties.emplace_back(std::uint64_t{track.target} << 8 | static_cast<std::uint64_t>(track.path), index);
        check_finite(track.values, offset, faults);
        check_finite(track.times, offset, faults);
        for (std::size_t key = 1; key < track.times.size(); ++key) {
            if (track.times[key] > track.times[key - 1]) continue;
            faults.add({ErrorCode::kKeyOrder, offset, index});
            break;
        }
        if (!track.times.empty()) {
            length_holds = length_holds && track.times.front() >= cycle.start && track.times.back() <= cycle.end;
        }
        if (track.path != TrackPath::rotation) continue;
        const bool cubic = track.interpolation == Interpolation::cubic;
        for (std::size_t key = 0; key < track.keys; ++key) {
            const auto rotation = track.values.subspan(cubic ? key * 12 + 4 : key * 4).first<4>();
            if (is_unit(rotation, kUnitTolerance)) continue;
            faults.add({ErrorCode::kRotationNotUnit, offset, key});
            break;
        }
    }
    if (!length_holds) faults.add({ErrorCode::kCycleLength, offset});
    std::sort(properties.begin(), properties.end());
    for (std::size_t k = 1; k < properties.size(); ++k) {
        if (properties[k].first == properties[k - 1].first) faults.add({ErrorCode::kTrackRepeated, offset, properties[k].second});
    }
}

}  // namespace bendy
