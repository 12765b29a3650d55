#include "convert/build_compact.h"

#include "optimise/compact/compact_geometry.h"
#include "optimise/compact/pack_clips.h"
#include "optimise/compact/pack_curve.h"
#include "optimise/compact/round_weights.h"
#include "optimise/measure_error.h"
#include "optimise/sample_limits.h"
#include "scene/evaluate.h"
#include "scene/failure.h"
#include "scene/frame_shapes.h"
#include "scene/progress.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/import.h>
#include <bendy/format/chunk_reader.h>
#include <bendy/format/chunk_writer.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <new>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace bendy::converter {
namespace {

// Shares of the bound for positions, weights and targets, and for clips. The two errors seldom occur at one point at
// the same time, so the sum may exceed 1: the measurement decides.
constexpr double kGeometryShare = 0.35;
constexpr double kClipShare = 0.9;
constexpr double kTrackShare = 0.3;  // rounding of the weights of morph targets in clips

/// The geometry's share of the bound: nearly all of it if no clip moves a joint.
double geometry_share_of(const Scene& scene) {
    constexpr double kStillShare = 0.9;  // the geometry is measured at the weights of some keys only
    if (scene.clips.empty()) return 1.0;
    const bool moves = std::any_of(scene.clips.begin(), scene.clips.end(), [](const Clip& clip) {
        return std::any_of(clip.tracks.begin(), clip.tracks.end(),
                           [](const Track& track) { return track.path != TrackPath::weights; });
    });
    return moves ? kGeometryShare : kStillShare;
}

/// The vertex of a scene, or of one of its meshes, that is farthest from the origin at rest, as `mesh "Body", vertex
/// 3`; empty if all are at the origin.
std::string farthest_vertex(const Scene& scene, std::uint32_t only_mesh = kNone) {
    EvaluatedPose rest;
    evaluate_rest(scene, rest);
    MeasuredError farthest;
    for (std::uint32_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        if (only_mesh != kNone && mesh != only_mesh) continue;
        const std::vector<glm::dvec3> places = evaluate_vertices(scene.meshes[mesh], {}, rest.joints);
        for (std::uint32_t vertex = 0; vertex < places.size(); ++vertex) {
            const double metres = glm::length(places[vertex]);
            if (metres <= farthest.metres) continue;
            farthest.metres = metres;
            farthest.mesh = mesh;
            farthest.vertex = vertex;
        }
    }
    std::string place = place_of(scene, farthest);
    return place.substr(0, place.rfind(", at rest"));
}

/// Warns of meshes whose positions could not be quantised, with the place of the first one.
void report_exact_positions(const Scene& scene, const CompactGeometry& geometry, Report& report) {
    std::uint64_t count = 0;
    std::uint32_t first = kNone;
    for (std::uint32_t number = 0; number < scene.meshes.size(); ++number) {
        const Mesh& mesh = scene.meshes[number];
        if (geometry.meshes[number].positions || mesh.positions.empty() || has_frames(mesh) || mesh.grid) continue;
        if (count++ == 0) first = number;
    }
    if (count == 0) return;
    report.warn("positions written exactly: steps as small as the error bound do not reach that far",
                farthest_vertex(scene, first), count);
}

/// Measures the clips with measure_clips on the file's bytes.
/// \param why  receives what is wrong if they cannot be read back; the errors are infinite then
std::vector<MeasuredError> measure(const Scene& exact, const CompactGeometry& geometry, Bytes bytes,
                                   std::span<const std::uint32_t> clips, MeasureOptions options, std::string& why) {
    Report unheard;
    auto decoded = import_bendy(bytes, unheard, MeshParts::motion);
    if (!decoded) {
        const ImportError& error = decoded.error();
        if (error.message == kNotEnoughMemory) throw std::bad_alloc();
        why = error.message + (error.place.empty() ? "" : " (" + error.place + ')');
        MeasuredError infinite;
        infinite.metres = std::numeric_limits<double>::infinity();
        std::vector<MeasuredError> errors(clips.size() + 1, infinite);
        return errors;
    }
    std::vector<std::vector<std::uint32_t>> maps;
    maps.reserve(geometry.meshes.size());
    for (const CompactMesh& mesh : geometry.meshes) maps.push_back(mesh.vertex_of);
    options.vertex_maps = maps;
    return measure_clips(exact, *decoded, clips, options);
}

/// Bytes of the same file without levels of detail, which has its vertices in another order.
/// \param scene   with the clips as they are written
/// \param clips   before they were packed: steps of positions follow from these
/// \param meshes  before their vertices were sorted for levels
std::size_t size_without_levels(Scene scene, const std::vector<Clip>& clips, const std::vector<Mesh>& meshes,
                                double geometry_error, std::string_view generator) {
    scene.meshes = meshes;
    scene.levels.clear();
    std::vector<Clip> packed = std::exchange(scene.clips, clips);
    const CompactGeometry geometry = compact_geometry(scene, geometry_error, {});
    scene.clips = std::move(packed);
    BuildOptions how;
    how.compact = true;
    how.geometry = &geometry;
    Report unheard;
    return build_chunks(scene, generator, unheard, how).size();
}

/// The file with BNDS after VERS, where build_chunks puts it: its contents are known only after the file is measured.
std::vector<std::byte> with_bound(Bytes file, const BoundRecord& bound) {
    const Result<ChunkTree> tree = read_chunk_tree(file);
    assert(tree);
    ChunkWriter out;
    out.reserve(file.size() + kChunkHeaderSize + padded(sizeof bound));
    out.begin(FourCC("HEAD"));
    for (const std::uint32_t number : tree->children(0)) {
        const Chunk& chunk = (*tree)[number];
        out.copy(file.subspan(chunk.offset, kChunkHeaderSize + padded(chunk.size)));
        if (chunk.id == FourCC("VERS")) out.leaf(FourCC("BNDS"), bytes_of(bound));
    }
    out.end();
    return std::move(out).finish();
}

/// Whether measuring at the keys first saves time. It costs microseconds for each vertex; measuring in full costs a
/// fraction of one for each joint and sample.
bool are_drafts_worth(const Scene& scene, double seconds) {
    constexpr double kJointsPerVertex = 8.0;
    std::size_t vertices = 0;
    for (const Mesh& mesh : scene.meshes) vertices += mesh.positions.size();
    const double poses = seconds * kSamplesPerSecond * static_cast<double>(scene.joints.size());
    return poses > kJointsPerVertex * static_cast<double>(vertices);
}

/// Counts the curves and the packed ones as put_curves writes them, and finds their largest error.
void count_curves(const Scene& scene, CompactReport& report) {
    for (const Clip& clip : scene.clips) {
        report.curves += clip.curves.size();
        for (const Curve& curve : clip.curves) {
            const std::optional<PackedCurve> packed = pack_curve(curve);
            if (!packed) continue;
            ++report.packed_curves;
            report.curve_error = std::max(report.curve_error, packed->share);
        }
    }
}

}  // namespace

std::vector<std::byte> build_compact(const Scene& exact, const CompactOptions& options, std::string_view generator,
                                     Report& report) {
    const auto& bound = options.bound;
    const auto& progress = options.progress;
    const std::size_t threads = options.threads;
    constexpr int kAttempts = 10;           // the last one leaves the clips unchanged
    constexpr double kPackingShare = 0.6;   // of an attempt
    constexpr double kDraftShare = 0.2;     // of the rest of an attempt
    constexpr double kAttemptShare = 0.75;  // of the remaining work
    constexpr double kOvershoot = 1.1;      // factor on the reduction of a clip's share when its error is too large
    constexpr double kLeast = 0.2;          // smallest factor on a clip's share from one attempt to the next
    constexpr double kStep = 0.02;  // minimum reduction, doubled at each attempt: small changes may have no effect
    constexpr int kLastDoubling = 4;
    constexpr std::size_t kFirstClips = 6;  // of many
    constexpr std::size_t kFewClips = 12;

    CompactReport result;
    result.height = height_at_rest(exact);
    result.max_error = bound.is_share ? bound.value * result.height : bound.value;
    result.exact = count_bytes(build_chunks(exact, generator, report));
    Report unheard;  // discarded: all files give the same warnings
    const auto exactly = [&](std::string_view why, std::string place = {}) {
        report.warn(std::string(why) + ": written exactly", std::move(place));
        return build_chunks(exact, generator, unheard);
    };
    // The file says both as 32-bit numbers.
    constexpr double kLargest = std::numeric_limits<float>::max();
    if (!(result.height <= kLargest))
        return exactly("the character's height is too large for an error bound", farthest_vertex(exact));
    if (!(result.max_error <= kLargest)) return exactly("the error bound is too large a number of metres");
    if (!find_limits(exact).can_be_measured)
        return exactly("the clips have too many keys for the error to be measured");

    Scene scene = exact;
    const double geometry_share = geometry_share_of(exact);
    // Rough estimate: the geometry takes as long as five seconds of clips.
    constexpr double kGeometryWork = 5.0;
    double seconds = 0.0;
    for (const Clip& clip : exact.clips) seconds += span_of(clip).at(1.0) - span_of(clip).at(0.0);
    const double geometry_done = std::min(0.8, kGeometryWork / (kGeometryWork + seconds));
    const CompactGeometry geometry =
        compact_geometry(scene, result.max_error * geometry_share, part_of(progress, 0.0, geometry_done));

    report_exact_positions(exact, geometry, report);

    std::vector<std::vector<float>> steps;  // of the targets' weights in clips
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        const double most = kTrackShare * result.max_error / geometry.meshes[mesh].stretch;
        steps.push_back(weight_steps(scene.meshes[mesh], most));
    }

    const std::size_t clips = exact.clips.size();
    const auto shell = find_probes(exact, Probes::shell);
    std::vector<double> shares(clips, kClipShare);  // of the bound, for each clip
    std::vector<MeasuredError> errors(clips + 1);   // of each clip, and at rest
    std::vector<std::uint32_t> all(clips);
    std::iota(all.begin(), all.end(), 0u);
    const bool has_drafts = are_drafts_worth(exact, seconds);
    // The numbers of clips that are not yet within the bound: first some, from which the others' shares follow.
    const std::size_t stride = has_drafts && clips >= kFewClips ? clips / kFirstClips : 1;
    std::vector<std::uint32_t> to_pack;
    std::vector<std::uint32_t> waiting;
    for (const std::uint32_t clip : all) (clip % stride == 0 ? to_pack : waiting).push_back(clip);
    std::vector<std::byte> bytes;
    std::string why_unreadable;
    double done = geometry_done;
    // Builds the file and measures clips of it; returns those that are above the bound.
    const auto above_bound = [&](const std::vector<std::uint32_t>& measured, bool is_draft, double until) {
        BuildOptions how;
        how.compact = true;
        how.is_draft = is_draft;
        how.geometry = &geometry;
        bytes = build_chunks(scene, generator, unheard, how);
        MeasureOptions what{.progress = part_of(progress, done, until),
                            .threads = threads,
                            .limit = result.max_error,
                            .only_keys = is_draft};
        if (!is_draft) what.shell = shell;
        for (const std::uint32_t clip : all) {  // what was measured before is in this file, too
            if (errors[clip].metres <= result.max_error) what.known = std::max(what.known, errors[clip].metres);
        }
        const std::vector<MeasuredError> found = measure(exact, geometry, bytes, measured, what, why_unreadable);
        done = until;
        errors.back() = found.back();
        std::vector<std::uint32_t> above;
        for (std::size_t k = 0; k < measured.size(); ++k) {
            errors[measured[k]] = found[k];
            if (!(found[k].metres <= result.max_error)) above.push_back(measured[k]);
        }
        return above;
    };
    for (int number = 0; number < kAttempts; ++number) {
        // The first attempt usually is the last: progress never decreases, and keeps some room for more.
        const double attempt_done = done + kAttemptShare * (1.0 - done);
        const double packing_done = done + kPackingShare * (attempt_done - done);
        const double draft_done = packing_done + kDraftShare * (attempt_done - packing_done);
        std::vector<double> bounds(clips, 0.0);
        for (const std::uint32_t clip : to_pack) {
            scene.clips[clip] = exact.clips[clip];
            errors[clip] = {};
            if (number + 1 == kAttempts) continue;
            round_weights(scene.clips[clip], steps, 2 * number);
            bounds[clip] = result.max_error * shares[clip];
        }
        pack_clips(scene, bounds,
                   {.progress = part_of(progress, done, packing_done), .threads = threads, .only_keys = true});
        done = packing_done;
        // At the keys first, which finds nearly all errors; in full once nothing is left to correct.
        const std::vector<std::uint32_t> packed = std::exchange(to_pack, {});
        if (has_drafts) to_pack = above_bound(packed, true, draft_done);
        if (to_pack.empty() && waiting.empty()) to_pack = above_bound(all, false, attempt_done);
        if ((to_pack.empty() && waiting.empty()) || !(errors.back().metres <= result.max_error)) break;
        for (const std::uint32_t clip : to_pack) {
            const double excess = errors[clip].metres / result.max_error - 1.0;
            const double less = std::max(kOvershoot * excess, kStep * (1 << std::min(number, kLastDoubling)));
            shares[clip] = std::max(shares[clip] - less, kLeast * shares[clip]);
        }
        if (waiting.empty()) continue;
        double sum = 0.0;
        for (const std::uint32_t clip : packed) sum += shares[clip];
        for (const std::uint32_t clip : waiting) shares[clip] = sum / static_cast<double>(packed.size());
        to_pack.insert(to_pack.end(), waiting.begin(), waiting.end());
        waiting.clear();
    }
    MeasuredError worst = errors.back();
    for (const MeasuredError& error : errors) {
        if (error.metres > worst.metres) worst = error;
    }
    if (!why_unreadable.empty()) return exactly("the compact form could not be read back, " + why_unreadable);
    if (!(worst.metres <= result.max_error)) {
        return exactly("the compact form exceeds the requested error");
    }
    if (options.meshes_without_levels != nullptr) {
        const std::size_t without = size_without_levels(std::move(scene), exact.clips, *options.meshes_without_levels,
                                                        result.max_error * geometry_share, generator);
        result.lod_bytes = static_cast<std::int64_t>(bytes.size()) - static_cast<std::int64_t>(without);
    }
    bytes = with_bound(bytes, {static_cast<float>(result.max_error), static_cast<float>(worst.metres),
                               static_cast<float>(result.height)});
    result.measured_error = worst.metres;
    result.place = place_of(exact, worst);
    result.compact = count_bytes(bytes);
    count_curves(exact, result);
    report.compact = std::move(result);
    return bytes;
}

}  // namespace bendy::converter
