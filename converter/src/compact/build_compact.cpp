#include "compact/build_compact.h"

#include "compact/compact_geometry.h"
#include "compact/pack_clips.h"
#include "compact/pack_curve.h"
#include "evaluate.h"
#include "frame_shapes.h"
#include "measure_error.h"
#include "progress.h"
#include "sample_limits.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/import.h>
#include <bendy/format/chunk_reader.h>
#include <bendy/format/chunk_writer.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace bendy::converter {
namespace {

struct Unit {
    std::string_view name;
    double factor;
    bool is_share;
};
constexpr std::array<Unit, 5> kUnits{
    {{"mm", 1e-3, false}, {"cm", 1e-2, false}, {"um", 1e-6, false}, {"m", 1.0, false}, {"%", 1e-2, true}}};

std::string quoted(std::string_view text) {
    return '"' + std::string(text) + '"';
}

}  // namespace

Result<ErrorBound, std::string> parse_error_bound(std::string_view text) {
    double value = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc())
        return quoted(text) + " is no error bound; write a length, as 0.1mm, or a share, as 0.005%";
    std::string_view unit = text.substr(static_cast<std::size_t>(end - text.data()));
    while (unit.starts_with(' ')) unit.remove_prefix(1);
    if (unit.empty()) {
        const std::string number(text);
        return quoted(text) + " has no unit; write " + number + "mm, " + number + "cm, " + number + "m, " + number +
               "um, or " + number + "% of the character's height";
    }
    for (const Unit& known : kUnits) {
        if (unit != known.name) continue;
        if (!(value > 0.0) || !std::isfinite(value)) return quoted(text) + " is not above zero";
        return ErrorBound{value * known.factor, known.is_share};
    }
    return quoted(unit) + " is no unit of " + quoted(text) + "; the units are mm, cm, m, um and %";
}

namespace {

struct KindOfChunk {
    FourCC id;
    std::string_view kind;
};
/// A chunk is of the first of these that it or one of its containers is, nearest first.
constexpr std::array kKinds{KindOfChunk{FourCC("SKIN"), "skeleton"}, KindOfChunk{FourCC("JNTS"), "skeleton"},
                            KindOfChunk{FourCC("JNAM"), "skeleton"}, KindOfChunk{FourCC("IKCH"), "skeleton"},
                            KindOfChunk{FourCC("PALT"), "PALT"},     KindOfChunk{FourCC("POSI"), "POSI"},
                            KindOfChunk{FourCC("NORM"), "NORM"},     KindOfChunk{FourCC("TANG"), "TANG"},
                            KindOfChunk{FourCC("TEXC"), "TEXC"},     KindOfChunk{FourCC("COLR"), "COLR"},
                            KindOfChunk{FourCC("BONE"), "BONE"},     KindOfChunk{FourCC("WGHT"), "WGHT"},
                            KindOfChunk{FourCC("INDX"), "indices"},  KindOfChunk{FourCC("TARG"), "targets"},
                            KindOfChunk{FourCC("FRMS"), "frames"},   KindOfChunk{FourCC("NLST"), "NORM"},
                            KindOfChunk{FourCC("LODD"), "LODD"},     KindOfChunk{FourCC("CYCL"), "clips"},
                            KindOfChunk{FourCC("TEXT"), "textures"}, KindOfChunk{FourCC("HEAD"), "other"}};

}  // namespace

std::vector<ByteCount> count_bytes(Bytes file) {
    std::vector<ByteCount> counts;
    std::array<std::size_t, kKinds.size()> place{};
    for (std::size_t k = 0; k < kKinds.size(); ++k) {
        const auto known = std::find_if(counts.begin(), counts.end(),
                                        [&](const ByteCount& count) { return count.kind == kKinds[k].kind; });
        place[k] = static_cast<std::size_t>(known - counts.begin());
        if (known == counts.end()) counts.push_back({std::string(kKinds[k].kind), 0});
    }
    const auto tree = read_chunk_tree(file);
    if (!tree) return counts;
    std::vector<std::size_t> kind_of(tree->chunks().size(), counts.size() - 1);
    for (std::uint32_t number = 0; number < kind_of.size(); ++number) {
        const Chunk& chunk = (*tree)[number];
        const auto known =
            std::find_if(kKinds.begin(), kKinds.end(), [&](const KindOfChunk& k) { return k.id == chunk.id; });
        const std::string_view above = number == 0 ? std::string_view() : counts[kind_of[chunk.parent]].kind;
        const bool in_target = above == "targets" || above == "frames";
        if (known != kKinds.end() && !in_target) {
            kind_of[number] = place[static_cast<std::size_t>(known - kKinds.begin())];
        } else if (number != 0) {
            kind_of[number] = kind_of[chunk.parent];
        }
        counts[kind_of[number]].bytes += kChunkHeaderSize + (chunk.is_container() ? 0 : padded(chunk.size));
    }
    return counts;
}

namespace {

// Of the bound, what positions, weights and targets may use up, and what clips may. The two seldom meet at one point
// at one time, so their sum may be above 1: the measurement decides.
constexpr double kGeometryShare = 0.35;
constexpr double kClipShare = 0.9;

/// What measure_clips finds in the file's bytes; infinite if they cannot be read.
std::vector<MeasuredError> measure(const Scene& exact, const CompactGeometry& geometry, Bytes bytes,
                                   std::span<const std::uint32_t> clips, MeasureOptions options) {
    Report unheard;
    const auto decoded = import_bendy(bytes, unheard);
    if (!decoded) {
        std::vector<MeasuredError> unknown(clips.size() + 1);
        for (MeasuredError& error : unknown) error.metres = std::numeric_limits<double>::infinity();
        return unknown;
    }
    std::vector<std::vector<std::uint32_t>> maps;
    maps.reserve(geometry.meshes.size());
    for (const CompactMesh& mesh : geometry.meshes) maps.push_back(mesh.vertex_of);
    options.vertex_maps = maps;
    return measure_clips(exact, *decoded, clips, options);
}

/// A file with BNDS after VERS, where build_chunks puts it: what it says is known only when the file has been measured.
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

/// What put_curves does to the curves.
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
    const auto& [bound, progress, threads] = options;
    constexpr int kAttempts = 6;            // the last leaves the clips as they are
    constexpr double kPackingShare = 0.6;   // of an attempt
    constexpr double kAttemptShare = 0.75;  // of what is left of the work
    constexpr double kOvershoot = 1.1;      // of what is taken off a clip, for what is too much
    constexpr double kLeast = 0.2;          // of its share, from one attempt to the next
    constexpr double kStep =
        0.02;  // taken off at least, twice as much at each attempt: small changes may change nothing

    CompactReport result;
    result.height = height_at_rest(exact);
    result.max_error = bound.is_share ? bound.value * result.height : bound.value;
    std::vector<std::byte> plain = build_chunks(exact, generator, report);
    result.exact = count_bytes(plain);
    if (!find_limits(exact).can_be_measured) {
        report.warn("poses too much for its size to be measured: written exactly");
        return plain;
    }

    Report unheard;  // the compact file's warnings are the same
    Scene geometry_scene = exact;
    const double geometry_share = exact.clips.empty() ? 1.0 : kGeometryShare;
    // About: the geometry takes as long as five seconds of clips.
    constexpr double kGeometryWork = 5.0;
    double seconds = 0.0;
    for (const Clip& clip : exact.clips) seconds += span_of(clip).at(1.0) - span_of(clip).at(0.0);
    const double geometry_done = std::min(0.8, kGeometryWork / (kGeometryWork + seconds));
    const CompactGeometry geometry =
        compact_geometry(geometry_scene, result.max_error * geometry_share, part_of(progress, 0.0, geometry_done));

    const std::size_t clips = exact.clips.size();
    Scene scene = geometry_scene;
    std::vector<double> shares(clips, kClipShare);  // of the bound, for each clip
    std::vector<MeasuredError> errors(clips + 1);   // of each clip, and at rest
    std::vector<std::uint32_t> to_pack(clips);      // numbers of clips that are not within the bound yet
    std::iota(to_pack.begin(), to_pack.end(), 0u);
    std::vector<std::byte> bytes;
    double done = geometry_done;
    for (int number = 0; number < kAttempts; ++number) {
        // The first is mostly the last: what is told never falls, and leaves some room for others.
        const double attempt_done = done + kAttemptShare * (1.0 - done);
        const double packing_done = done + kPackingShare * (attempt_done - done);
        std::vector<double> bounds(clips, 0.0);
        for (const std::uint32_t clip : to_pack) {
            scene.clips[clip] = geometry_scene.clips[clip];
            if (number + 1 < kAttempts) bounds[clip] = result.max_error * shares[clip];
        }
        pack_clips(scene, bounds, {.progress = part_of(progress, done, packing_done), .threads = threads});
        BuildOptions how;
        how.compact = true;
        how.geometry = &geometry;
        bytes = build_chunks(scene, generator, unheard, how);
        const std::vector<MeasuredError> found =
            measure(exact, geometry, bytes, to_pack,
                    {.progress = part_of(progress, packing_done, attempt_done), .threads = threads});
        done = attempt_done;
        for (std::size_t k = 0; k < to_pack.size(); ++k) errors[to_pack[k]] = found[k];
        errors.back() = found.back();
        std::erase_if(to_pack, [&](std::uint32_t clip) { return errors[clip].metres <= result.max_error; });
        if (to_pack.empty() || !(errors.back().metres <= result.max_error)) break;
        for (const std::uint32_t clip : to_pack) {
            const double excess = errors[clip].metres / result.max_error - 1.0;
            const double less = std::max(kOvershoot * excess, kStep * (1 << number));
            shares[clip] = std::max(shares[clip] - less, kLeast * shares[clip]);
        }
    }
    MeasuredError worst = errors.back();
    for (const MeasuredError& error : errors) {
        if (error.metres > worst.metres) worst = error;
    }
    if (!(worst.metres <= result.max_error)) {
        report.warn("cannot be kept inside the error that was asked for: written exactly");
        return plain;
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
