#include <bendy/converter/convert.h>

#include "compact/compact_geometry.h"
#include "compact/measure_skin.h"
#include "failure.h"
#include "passes/attach_rigs.h"
#include "rig/parse_rig.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/validate.h>

#include <new>
#include <utility>

namespace bendy::converter {
namespace {

constexpr std::string_view kGenerator = "bendy " BENDY_VERSION;

/// Of the bound, what positions, weights and targets may use up; cycles have the rest.
constexpr double kGeometryShare = 0.25;

std::vector<std::byte> build_compact(const Scene& exact, const ConvertOptions& options, Report& report) {
    CompactReport result;
    result.height = height_at_rest(exact);
    const ErrorBound& asked = *options.compact;
    result.max_error = asked.is_share ? asked.value * result.height : asked.value;
    Report unheard;  // the compact file's warnings are the same
    result.exact = count_bytes(build_chunks(exact, kGenerator, unheard));

    Scene scene = exact;
    const double share = exact.cycles.empty() ? 1.0 : kGeometryShare;
    const CompactGeometry geometry = compact_geometry(scene, result.max_error * share, options.progress);
    // Cycles are still written as they are. The measurement of whole cycles belongs here, too: this one takes the error
    // of positions, weights and targets, in poses of the exact cycles.
    const SkinError measured = measure_skin(exact, scene, geometry);
    result.measured_error = measured.metres;
    result.place = measured.place;

    BuildOptions build;
    build.compact = true;
    build.geometry = &geometry;
    build.bound = BoundRecord{static_cast<float>(result.max_error), static_cast<float>(result.measured_error),
                              static_cast<float>(result.height)};
    std::vector<std::byte> bytes = build_chunks(scene, kGenerator, report, build);
    result.compact = count_bytes(bytes);
    report.compact = std::move(result);
    return bytes;
}

}  // namespace

Result<std::vector<std::byte>, ImportError> convert(const std::filesystem::path& file, const ConvertOptions& options,
                                                    Report& report) {
    std::optional<Rig> rig;
    try {
        if (options.rig) rig = read_rig(*options.rig, report);
        auto scene = import_gltf(file, options.gltf, report);
        if (!scene) return scene.error();
        attach_rigs(*scene, rig, options.auto_rig, report);
        std::vector<std::byte> bytes =
            options.compact ? build_compact(*scene, options, report) : build_chunks(*scene, kGenerator, report);
        // The importer has checked the source; this checks the importer, before anything is written.
        const Faults faults = validate(bytes);
        if (!faults.empty())
            return ImportError{{}, "cannot be held: " + describe_with_place(faults.list().front(), bytes)};
        return bytes;
    } catch (const Failure& failure) {  // only of the rig: import_gltf throws nothing
        return ImportError{failure.error.place, failure.error.message, options.rig.value_or(file)};
    } catch (const std::bad_alloc&) {
        return ImportError{{}, "there is not enough memory"};
    }
}

}  // namespace bendy::converter
