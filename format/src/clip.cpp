#include <bendy/format/clip.h>

#include <bendy/format/read_record.h>
#include <bendy/format/text.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace bendy {
namespace {

/// Reads a leaf of floats. Returns an empty span if the leaf does not exist; returns nothing, and adds a fault, if it
/// cannot be read.
std::optional<std::span<const float>> read_floats(const ChunkTree& tree, std::uint32_t clip, FourCC id,
                                                  Faults& faults) {
    const std::uint32_t number = tree.find(clip, id);
    if (number == kNone) return std::span<const float>();
    if (tree[number].is_container()) return std::nullopt;  // check_grammar reports it
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

/// Returns true if the mesh has frames that could not be read (a mesh with frames has at least one), so that its number
/// of targets is unknown.
bool has_lost_frames(const ChunkTree& tree, const MeshView& mesh) {
    return mesh.frames() == 1 && tree.find(mesh.chunk, FourCC("FRMS")) != kNone;
}

std::uint32_t components_of(TrackPath path, std::uint32_t target, std::span<const MeshView> meshes) {
    if (path == TrackPath::weights) return static_cast<std::uint32_t>(meshes[target].targets.size());
    return path == TrackPath::rotation ? 4 : 3;
}

/// Checks that the times of each track ascend.
void check_key_order(const ClipView& clip, std::span<const float> times, std::uint64_t offset, Faults& faults) {
    std::vector<std::size_t> run_start(times.size());  // start of the ascending run that contains each time
    for (std::size_t k = 1; k < times.size(); ++k) run_start[k] = times[k] > times[k - 1] ? run_start[k - 1] : k;
    for (std::size_t index = 0; index < clip.tracks.size(); ++index) {
        const TrackView& track = clip.tracks[index];
        if (track.times.empty()) continue;
        const auto first = static_cast<std::size_t>(track.times.data() - times.data());
        if (run_start[first + track.keys - 1] > first) faults.add({ErrorCode::kKeyOrder, offset, index});
    }
}

/// Checks that two tracks share all their values or none, so that the total of the shares does not exceed the array;
/// and that the values of rotations are unit quaternions, except for cubic ones, which are normalised after
/// interpolation.
void check_shared_values(const ClipView& clip, std::uint64_t offset, Faults& faults) {
    struct Share {
        const float* first;
        const float* last;
        bool must_be_unit;
        std::size_t track;

        [[nodiscard]] auto key() const { return std::tie(first, last, must_be_unit, track); }
    };
    std::vector<Share> shares;
    for (std::size_t index = 0; index < clip.tracks.size(); ++index) {
        const TrackView& track = clip.tracks[index];
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
        const TrackView& track = clip.tracks[share.track];
        for (std::size_t key = 0; key < track.keys; ++key) {
            if (is_unit(track.values.subspan(key * 4).first<4>(), kUnitTolerance)) continue;
            faults.add({ErrorCode::kRotationNotUnit, offset, key});
            break;
        }
    }
}

bool holds_frames(const ClipView& clip, const PackedView& packed) {
    const double length = double{clip.end} - clip.start;
    const double tolerance = 1e-6 * std::max({length, std::abs(double{clip.end}), 1e-3});  // `end` is a rounded float
    return packed.record.start >= clip.start && packed.time_of(packed.record.frames - 1) <= clip.end + tolerance;
}

/// Returns true if start does not exceed end, and no key is outside them.
bool holds_all_keys(const ClipView& clip) {
    if (!(clip.start <= clip.end && clip.frame_rate >= 0.0f)) return false;
    if (clip.packed && !holds_frames(clip, *clip.packed)) return false;
    constexpr double kFrames = 1e-3;  // of a frame: `end` is a rounded float
    const double most = (double{clip.end} - clip.start) * clip.frame_rate + kFrames;
    const auto fits = [&](const PlayRecord& play) { return play.frames - 1.0 + play.closed <= most; };
    if (!std::all_of(clip.plays.begin(), clip.plays.end(), fits)) return false;
    const auto holds = [&](const CurveView& curve) {
        return curve.times.front() >= clip.start && curve.times.back() <= clip.end;
    };
    if (!std::all_of(clip.curves.begin(), clip.curves.end(), holds)) return false;
    return std::all_of(clip.tracks.begin(), clip.tracks.end(), [&](const TrackView& track) {
        if (!track.times.empty()) return track.times.front() >= clip.start && track.times.back() <= clip.end;
        return track.keys - 1.0 <= most;
    });
}

/// Checks that a mesh is played once at most, and not also animated by a track.
void check_repeated_plays(const ClipView& clip, std::uint64_t offset, Faults& faults) {
    std::vector<std::pair<std::uint32_t, std::size_t>> meshes;
    for (std::size_t index = 0; index < clip.plays.size(); ++index) meshes.emplace_back(clip.plays[index].mesh, index);
    std::sort(meshes.begin(), meshes.end());
    for (std::size_t k = 1; k < meshes.size(); ++k) {
        if (meshes[k].first == meshes[k - 1].first) faults.add({ErrorCode::kTrackRepeated, offset, meshes[k].second});
    }
    for (const TrackView& track : clip.tracks) {
        if (track.path != TrackPath::weights) continue;
        const auto play = std::lower_bound(meshes.begin(), meshes.end(), std::pair(track.target, std::size_t{0}));
        if (play != meshes.end() && play->first == track.target)
            faults.add({ErrorCode::kTrackRepeated, offset, play->second});
    }
}

std::vector<PlayRecord> read_plays(const ChunkTree& tree, const ClipView& clip, std::span<const MeshView> meshes,
                                   Faults& faults) {
    std::vector<PlayRecord> plays;
    const std::uint32_t number = tree.find(clip.chunk, FourCC("PLAY"));
    if (number == kNone || tree[number].is_container() || !clip.has_info) return plays;
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
        if (record.mesh >= meshes.size()) {
            faults.add({ErrorCode::kMeshRange, offset, record.mesh, meshes.size()});
            continue;
        }
        if (has_lost_frames(tree, meshes[record.mesh])) continue;
        const std::uint32_t frames = meshes[record.mesh].frames();
        const bool is_there = record.frames != 0 && record.first <= frames && record.frames <= frames - record.first;
        if (!is_there || !(clip.frame_rate > 0.0f)) {
            faults.add({ErrorCode::kFrameRange, offset, index});
            continue;
        }
        plays.push_back(record);
    }
    return plays;
}

void check_repeated_tracks(const ClipView& clip, std::uint64_t offset, Faults& faults) {
    std::vector<std::tuple<std::uint32_t, TrackPath, std::size_t>> properties;
    for (std::size_t index = 0; index < clip.tracks.size(); ++index) {
        properties.emplace_back(clip.tracks[index].target, clip.tracks[index].path, index);
    }
    std::sort(properties.begin(), properties.end());
    for (const auto& [target, path, index] : properties) {
        if (clip.packed && path != TrackPath::weights && clip.packed->animates(target, path))
            faults.add({ErrorCode::kTrackRepeated, offset, index});
    }
    for (std::size_t k = 1; k < properties.size(); ++k) {
        const auto& [target, path, index] = properties[k];
        if (target == std::get<0>(properties[k - 1]) && path == std::get<1>(properties[k - 1])) {
            faults.add({ErrorCode::kTrackRepeated, offset, index});
        }
    }
}

std::vector<Marker> read_marker_leaf(const ChunkTree& tree, std::uint32_t clip, Faults& faults) {
    const std::uint32_t number = tree.find(clip, FourCC("MARK"));
    if (number == kNone || tree[number].is_container()) return {};
    if (const auto fault = tree.encoding_fault(number)) {
        faults.add(*fault);
        return {};
    }
    return read_markers(tree.payload(number), tree[number].offset, faults).value_or(std::vector<Marker>());
}

std::vector<CurveView> read_curve_leaves(const ChunkTree& tree, std::uint32_t clip, const TargetCounts& counts,
                                         Faults& faults) {
    std::vector<CurveView> curves;
    for (const std::uint32_t number : tree.children(clip)) {
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

void check_curves(const ChunkTree& tree, const ClipView& clip, Faults& faults) {
    for (const CurveView& curve : clip.curves) check_curve_values(curve, tree[curve.chunk].offset, faults);
    std::vector<const CurveView*> sorted;
    for (const CurveView& curve : clip.curves) {
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

std::optional<PackedView> read_packed_leaf(const ChunkTree& tree, std::uint32_t clip, std::uint32_t joints,
                                           Faults& faults) {
    const std::uint32_t number = tree.find(clip, FourCC("PACK"));
    if (number == kNone || tree[number].is_container()) return std::nullopt;
    if (const auto fault = tree.encoding_fault(number)) {
        faults.add(*fault);
        return std::nullopt;
    }
    return read_packed(tree.payload(number), joints, tree[number].offset, faults);
}

void check_markers(const ClipView& clip, std::uint64_t offset, Faults& faults) {
    const auto first_of = [&](auto is_wrong, ErrorCode code) {
        for (std::size_t k = 0; k < clip.markers.size(); ++k) {
            if (!is_wrong(k)) continue;
            faults.add({code, offset, k});
            return;
        }
    };
    const auto time = [&](std::size_t k) { return clip.markers[k].seconds; };
    first_of([&](std::size_t k) { return !std::isfinite(time(k)); }, ErrorCode::kNotFinite);
    first_of([&](std::size_t k) { return k > 0 && !(time(k - 1) <= time(k)); }, ErrorCode::kMarkerOrder);
    if (!clip.has_info) return;
    first_of([&](std::size_t k) { return !(time(k) >= clip.start && time(k) <= clip.end); }, ErrorCode::kMarkerOutside);
}

}  // namespace

ClipView read_clip(const ChunkTree& tree, std::uint32_t chunk, const TargetCounts& counts,
                   std::span<const MeshView> meshes, Faults& faults) {
    const std::uint32_t joints = counts.joints;
    ClipView clip;
    clip.chunk = chunk;
    clip.name = read_text(tree, chunk, FourCC("NAME"), faults);
    clip.extras = read_text(tree, chunk, FourCC("EXTR"), faults);
    clip.more = read_text(tree, chunk, FourCC("MORE"), faults);
    const auto read_info = read_child_record<ClipRecord>(tree, chunk, FourCC("CINF"), faults);
    const ClipRecord info = read_info.value_or(ClipRecord{});
    clip.has_info = read_info.has_value();
    clip.start = info.start;
    clip.end = info.end;
    clip.frame_rate = info.frame_rate;
    clip.loop = info.loop == 1;
    const std::uint64_t info_offset = offset_of(tree, chunk, FourCC("CINF"));
    check_enum(info.loop, 2, info_offset, faults);
    check_reserved(info.reserved, info_offset, faults);

    clip.packed = read_packed_leaf(tree, chunk, joints, faults);
    clip.markers = read_marker_leaf(tree, chunk, faults);
    clip.plays = read_plays(tree, clip, meshes, faults);
    clip.curves = read_curve_leaves(tree, chunk, counts, faults);
    const auto read_times = read_floats(tree, chunk, FourCC("TIME"), faults);
    const auto read_values = read_floats(tree, chunk, FourCC("KEYV"), faults);

    const std::uint32_t table = tree.find(chunk, FourCC("TRAK"));
    if (table == kNone || tree[table].is_container()) return clip;
    const std::uint64_t offset = tree[table].offset;
    const Bytes payload = tree.payload(table);
    if (const auto fault = tree.encoding_fault(table)) {
        faults.add(*fault);
        return clip;
    }
    const std::uint64_t count = payload.size() / sizeof(TrackRecord);
    if (payload.size() % sizeof(TrackRecord) != 0) {
        faults.add({ErrorCode::kRecordSize, offset, payload.size(), count * sizeof(TrackRecord)});
        return clip;
    }
    if (!read_times || !read_values || !clip.has_info) return clip;  // tracks cannot be checked without them
    const std::span<const float> times = *read_times;
    const std::span<const float> values = *read_values;
    clip.tracks.reserve(count);
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
        const bool on_mesh = track.path == TrackPath::weights;
        const std::uint64_t targets = on_mesh ? meshes.size() : joints;
        if (track.target >= targets) {
            faults.add({on_mesh ? ErrorCode::kMeshRange : ErrorCode::kJointRange, offset, track.target, targets});
            continue;
        }
        if (on_mesh && has_lost_frames(tree, meshes[track.target])) continue;
        if (track.components == 0 || track.components != components_of(track.path, track.target, meshes)) {
            faults.add({ErrorCode::kTrackComponents, offset, index});
            continue;
        }
        const bool fixed_frames = record.first_time == kNone;
        const std::uint64_t per_key =
            std::uint64_t{track.components} * (track.interpolation == Interpolation::cubic ? 3 : 1);
        const bool times_fit =
            fixed_frames ? clip.frame_rate > 0.0f
                         : record.first_time <= times.size() && track.keys <= times.size() - record.first_time;
        const bool values_fit =
            record.first_value <= values.size() && track.keys <= (values.size() - record.first_value) / per_key;
        if (track.keys == 0 || !times_fit || !values_fit) {
            faults.add({ErrorCode::kKeyRange, offset, index});
            continue;
        }
        if (!fixed_frames) track.times = times.subspan(record.first_time, track.keys);
        track.values = values.subspan(record.first_value, track.keys * per_key);
        clip.tracks.push_back(track);
    }
    return clip;
}

void check_clip_values(const ChunkTree& tree, const ClipView& clip, Faults& faults) {
    const std::uint64_t info_offset = offset_of(tree, clip.chunk, FourCC("CINF"));
    const std::uint64_t table_offset = offset_of(tree, clip.chunk, FourCC("TRAK"));
    check_finite(std::array{clip.start, clip.end, clip.frame_rate}, info_offset, faults);

    // Many tracks may share keys, so checks of every key run over the arrays once, not over each track's share.
    Faults unread;  // already reported by read_clip
    constexpr std::span<const float> kNoFloats;
    const auto times = read_floats(tree, clip.chunk, FourCC("TIME"), unread).value_or(kNoFloats);
    check_finite(times, offset_of(tree, clip.chunk, FourCC("TIME")), faults);
    check_finite(read_floats(tree, clip.chunk, FourCC("KEYV"), unread).value_or(kNoFloats),
                 offset_of(tree, clip.chunk, FourCC("KEYV")), faults);
    check_key_order(clip, times, table_offset, faults);
    check_shared_values(clip, table_offset, faults);
    if (clip.has_info && !holds_all_keys(clip)) faults.add({ErrorCode::kClipLength, info_offset});
    check_repeated_tracks(clip, table_offset, faults);
    check_repeated_plays(clip, offset_of(tree, clip.chunk, FourCC("PLAY")), faults);
    check_markers(clip, offset_of(tree, clip.chunk, FourCC("MARK")), faults);
    check_curves(tree, clip, faults);
    if (clip.packed) check_packed_values(*clip.packed, offset_of(tree, clip.chunk, FourCC("PACK")), faults);
}

}  // namespace bendy
