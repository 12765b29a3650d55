#include "optimise/compact/pack_clips.h"

#include "optimise/compact/grid.h"
#include "optimise/compact/quantise_clip.h"
#include "optimise/sample_limits.h"
#include "scene/frame_shapes.h"
#include "scene/in_parallel.h"
#include "scene/progress.h"

#include <bendy/format/codec.h>
#include <bendy/format/packed_clip.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

namespace bendy::converter {
namespace {

constexpr double kMostBetween = 0.7;  // of the bound, for interpolation between frames: more leaves too fine steps

struct Packed {
    std::vector<std::byte> bytes;
    WorstError worst;
    std::optional<std::uint64_t> cost{};  // see cost_of
};

/// The payload with the segment length that makes it smallest.
std::vector<std::byte> smallest_payload(PackedSamples samples) {
    std::vector<std::byte> smallest;
    for (const std::uint32_t frames : {0u, 16u, 24u, 32u, 48u, 64u, 96u, 128u}) {
        if (frames != 0 && frames + 1 >= samples.frames) break;
        samples.segment_frames = frames;
        auto written = write_packed(samples);
        if (written && (smallest.empty() || written->size() < smallest.size())) smallest = *std::move(written);
    }
    return smallest;
}

/// Bytes in memory and on disk, which count equally. Computed when first needed: most clips have no rival.
std::uint64_t cost_of(Packed& packed) {
    if (!packed.cost) {
        const std::uint64_t size = packed.bytes.size();
        const auto encoded = encode_payload(Codec::clip, packed.bytes, 0, 0);
        packed.cost = size + (encoded ? std::min<std::uint64_t>(encoded->size(), size) : size);
    }
    return *packed.cost;
}

bool is_smaller(Packed& a, Packed& b) {
    return cost_of(a) < cost_of(b);
}

/// The clip's tracks, packed within the bound; nothing if that is impossible.
/// \param share    of the bound that the frames may use; the rest is for the times between them
/// \param rival    if set: a result that is not smaller is returned unmeasured
std::optional<Packed> pack(SourceMotion& source, const ClipFrames& frames, const GridTracks& tracks,
                           const std::vector<bool>& is_replaced, const std::vector<std::vector<glm::dvec3>>& probes,
                           double max_error, double share, bool corrects, Packed* rival) {
    constexpr int kAttempts = 6;
    double aim = 0.998 * share * max_error;  // less than the bound: floats are rounded, and frames are not everything
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
        Packed packed;
        packed.bytes = smallest_payload(quantise(frames, source.clip(), tracks, probes, {aim, corrects}));
        Faults faults;
        const auto joints = static_cast<std::uint32_t>(frames.joints());
        const auto view = read_packed(packed.bytes, joints, 0, faults);
        if (!view) return std::nullopt;
        if (rival != nullptr && !is_smaller(packed, *rival)) return packed;
        packed.worst = measure_packed(source, is_replaced, *view, probes, 8.0 * max_error);
        if (packed.worst.metres <= max_error) return packed;
        constexpr double kHopeless = 4.0;
        if (packed.worst.metres > kHopeless * max_error) return std::nullopt;
        aim *= 0.97 * max_error / packed.worst.metres;
    }
    return std::nullopt;
}

std::uint64_t key_bytes(const Clip& clip, const std::vector<bool>* only = nullptr) {
    std::set<std::vector<float>> times;
    std::uint64_t numbers = 0;
    for (std::size_t k = 0; k < clip.tracks.size(); ++k) {
        if (only != nullptr && !(*only)[k]) continue;
        const Track& track = clip.tracks[k];
        if (times.insert(track.times).second) numbers += track.times.size();
        numbers += track.values.size();
    }
    return numbers * sizeof(float);
}

/// Packs with corrections, which makes most clips smaller; without them if their error is too large.
std::optional<Packed> pack_frames(SourceMotion& source, const GridTracks& tracks, const std::vector<bool>& is_replaced,
                                  const std::vector<std::vector<glm::dvec3>>& probes, double max_error, double share,
                                  Packed* rival = nullptr) {
    const ClipFrames frames(source.scene(), source.clip(), tracks.grid);
    for (const bool corrects : {true, false}) {
        if (auto packed = pack(source, frames, tracks, is_replaced, probes, max_error, share, corrects, rival))
            return packed;
    }
    return std::nullopt;
}

/// Keeps reducing the number of frames while that makes the clip smaller; it does if the motion is smooth and long.
void pack_thinner(SourceMotion& source, const GridTracks& tracks, const std::vector<bool>& is_replaced,
                  const std::vector<std::vector<glm::dvec3>>& probes, double max_error, Packed& best,
                  const Progress& progress) {
    constexpr std::array kFewer{1u, 2u, 3u, 4u, 6u, 8u, 12u};
    const bool is_even = tracks.grid.rate != 0.0f;
    for (std::size_t k = is_even ? 1 : 0; k < kFewer.size(); ++k) {
        const std::optional<ThinGrid> thin =
            thin_grid(source.scene(), source.clip(), tracks, kFewer.at(k), probes, kMostBetween * max_error);
        if (!thin) return;
        const GridTracks thinner{thin->grid, tracks.tracks};
        auto packed =
            pack_frames(source, thinner, is_replaced, probes, max_error, 1.0 - thin->error / max_error, &best);
        if (!packed || !is_smaller(*packed, best)) return;
        best = *std::move(packed);
        if (progress) progress(static_cast<double>(k + 1) / static_cast<double>(kFewer.size()));
    }
}

/// The clip's span, extended a little if the first frame's time is rounded down.
ClipSpan with_frames(ClipSpan span, Bytes payload) {
    PackRecord record;
    std::memcpy(&record, payload.data(), sizeof record);
    return {std::min(span.start, record.start), span.end};
}

PackedReport pack_clip(const Scene& scene, Clip& clip, const std::vector<std::vector<glm::dvec3>>& probes,
                       double max_error, const ClipLimits& limits, std::size_t pose_bytes, const Progress& progress) {
    constexpr double kPackedOnce = 0.5;  // of the work, roughly
    PackedReport report;
    report.name = clip.name;
    report.source_bytes = report.kept_bytes = key_bytes(clip);
    const auto grids = find_grids(clip, limits.frames, find_still(scene, clip, probes, max_error));
    if (grids.empty()) return report;
    SourceMotion source(scene, clip, limits.samples, pose_bytes);
    std::optional<Packed> best;
    std::vector<bool> is_replaced;
    for (const GridTracks& tracks : grids) {
        const double most = kMostBetween * max_error;
        const bool is_last = &tracks == &grids.back();
        if (!is_last && grid_error(scene, clip, grids.back(), tracks.grid, probes, most) > most) continue;
        is_replaced.assign(clip.tracks.size(), false);
        for (const std::uint32_t number : tracks.tracks) is_replaced[number] = true;
        best = pack_frames(source, tracks, is_replaced, probes, max_error, 1.0);
        if (!best) continue;
        if (progress) progress(kPackedOnce);
        pack_thinner(
            source, tracks, is_replaced, probes, max_error, *best,
            progress ? Progress([&](double done) { progress(kPackedOnce + (1.0 - kPackedOnce) * done); }) : Progress());
        if (best->bytes.size() < key_bytes(clip, &is_replaced) + tracks.tracks.size() * sizeof(TrackRecord)) break;
        best.reset();
    }
    if (!best) return report;
    clip.stated_span = with_frames(span_of(clip), best->bytes);  // constant tracks may be omitted
    std::size_t number = 0;
    std::erase_if(clip.tracks, [&](const Track&) { return is_replaced[number++]; });
    report.packed_bytes = best->bytes.size();
    report.kept_bytes = key_bytes(clip);
    report.worst_error = best->worst.metres;
    report.worst_joint = best->worst.joint;
    report.worst_time = best->worst.seconds;
    clip.packed = std::move(best->bytes);
    return report;
}

/// Bounded by the memory for the joints at all frames of the largest clip.
std::size_t most_threads(const Scene& scene) {
    constexpr std::size_t kMostFrameBytes = std::size_t{1} << 30U;
    constexpr std::size_t kJointBytes = 128;  // at one frame, roughly
    std::size_t keys = 1;
    for (const Clip& clip : scene.clips) {
        for (const Track& track : clip.tracks) keys = std::max(keys, track.times.size());
    }
    return std::max<std::size_t>(kMostFrameBytes / kJointBytes / keys / std::max<std::size_t>(scene.joints.size(), 1),
                                 1);
}

}  // namespace

std::vector<PackedReport> pack_clips(Scene& scene, std::span<const double> max_errors, const PackOptions& options) {
    const auto probes = find_probes(scene, options.probes);
    WorkLimits limits = find_limits(scene);
    if (options.only_keys) {
        for (ClipLimits& clip : limits.clips) clip.samples = 0;
    }
    // A clip's time is roughly proportional to its keys. Longest first, so that no thread ends up alone with a long
    // one.
    std::vector<double> sizes;
    for (std::size_t k = 0; k < scene.clips.size(); ++k)
        sizes.push_back(max_errors[k] > 0.0 ? 1.0 + static_cast<double>(key_bytes(scene.clips[k])) : 0.0);
    std::vector<std::size_t> order(sizes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
    SharedProgress shared(options.progress, std::accumulate(sizes.begin(), sizes.end(), 0.0));
    std::vector<PackedReport> reports(sizes.size());
    in_parallel(std::min(options.threads, most_threads(scene)), sizes.size(), [&](std::size_t k, std::size_t) {
        const std::size_t number = order[k];
        if (!(max_errors[number] > 0.0)) return;
        double told = 0.0;
        const auto tell = [&](double done) {
            if (!(done > told)) return;  // another grid is tried
            shared.add((done - told) * sizes[number]);
            told = done;
        };
        reports[number] = pack_clip(scene, scene.clips[number], probes, max_errors[number], limits.clips[number],
                                    limits.pose_bytes, shared.is_heard() ? Progress(tell) : Progress());
        tell(1.0);
    });
    return reports;
}

}  // namespace bendy::converter
