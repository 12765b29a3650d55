#include <bendy/converter/convert.h>

#include "collapse/collapse_vertices.h"
#include "compact/build_compact.h"
#include "failure.h"
#include "passes/attach_rigs.h"
#include "passes/auto_skin.h"
#include "passes/merge_clips.h"
#include "passes/mesh_order.h"
#include "passes/move_links.h"
#include "rig/parse_rig.h"
#include "source/importers.h"
#include "source/source_file.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/source_format.h>
#include <bendy/format/byte_reader.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/validate.h>

#include <algorithm>
#include <new>
#include <string>
#include <utility>

namespace bendy::converter {
namespace {

constexpr std::string_view kGenerator = "bendy " BENDY_VERSION;

using Buffer = std::vector<std::byte>;

/// The scene of a source of any kind, with its rig.
Result<Scene, ImportError> import_source(std::optional<Buffer> source, const std::filesystem::path& file,
                                         const ConvertOptions& options, const std::optional<Rig>& rig, Report& report) {
    if (std::string why = source ? why_not_convertible(*source, file) : why_not_convertible(file); !why.empty())
        return ImportError{{}, std::move(why)};
    if (!source) {
        auto bytes = without_throwing<Buffer>([&] { return read_file(file, {}); });
        if (!bytes) return bytes.error();
        source = *std::move(bytes);
    }
    const SourceFormat format = find_source_format(*source, file);
    const Importer& importer = importer_of(format);
    if (!importer.takes_scene && options.gltf.scene) return ImportError{{}, "a scene can be chosen in glTF files only"};
    if (!importer.takes_ticks && options.ticks_per_second != 0.0)
        return ImportError{{}, "ticks per second can be set for X-files only"};
    auto scene = importer.import(*std::move(source), file, options, report);
    if (!scene) return scene;
    // Where images are to be embedded, a link is what could not be read: it stays what the source says.
    if (format == SourceFormat::bendy || !options.gltf.embed_images)
        move_links(*scene, file, options.output.empty() ? file : options.output, report);
    if (format == SourceFormat::gltf) {
        attach_rigs(*scene, rig, options.auto_rig, report);
    } else {
        change_rig(*scene, rig, options.auto_rig, report);
    }
    return scene;
}

Result<Buffer, ImportError> convert_any(std::optional<Buffer> source, const std::filesystem::path& file,
                                        const ConvertOptions& options, Report& report) {
    std::optional<Rig> rig;
    try {
        if (!source) report.add_source(file);
        if (options.rig_text) {
            rig = parse_rig(*options.rig_text, report);
            if (options.rig) rig->source = options.rig->filename().string() + ": ";
        } else if (options.rig) {
            report.add_source(*options.rig);
            rig = read_rig(*options.rig, report);
        }
        auto scene = import_source(std::move(source), file, options, rig, report);
        if (!scene) return scene.error();
        if (options.merge_clips) {
            merge_clips(*scene, report);
        } else if (is_spread_motion(*scene)) {
            report.suggest("the motion is spread over " + std::to_string(scene->clips.size()) +
                           " clips, most of one joint each: --merge-clips makes one of them");
        }
        if (options.auto_skin) {
            if (auto bound = auto_skin(*scene, options.skeleton, report); !bound) return bound.error();
        }
        if (options.lod) collapse_vertices(*scene);
        if (options.sort_vertices && !options.lod && !options.compact)
            std::for_each(scene->meshes.begin(), scene->meshes.end(), sort_by_bones);
        Buffer bytes = options.compact ? build_compact(*scene, *options.compact, kGenerator, report, options.progress,
                                                       options.threads)
                                       : build_chunks(*std::move(scene), kGenerator, report);
        // The importer has checked the source; this checks the importer, before anything is written.
        const Faults faults = validate(bytes);
        if (!faults.empty())
            return ImportError{{}, "cannot be held: " + describe_with_place(faults.list().front(), bytes)};
        return bytes;
    } catch (const Failure& failure) {  // only of the rig: importers throw nothing
        return ImportError{failure.error.place, failure.error.message, options.rig.value_or(file)};
    } catch (const std::bad_alloc&) {
        return ImportError{{}, "not enough memory"};
    }
}

}  // namespace

Result<Buffer, ImportError> convert(const std::filesystem::path& file, const ConvertOptions& options, Report& report) {
    return convert_any(std::nullopt, file, options, report);
}

Result<Buffer, ImportError> convert(Buffer source, const std::filesystem::path& name, const ConvertOptions& options,
                                    Report& report) {
    return convert_any(std::move(source), name, options, report);
}

}  // namespace bendy::converter
