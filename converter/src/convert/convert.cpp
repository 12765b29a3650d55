#include <bendy/converter/convert.h>

#include "collapse/collapse_vertices.h"
#include "compact/build_compact.h"
#include "failure.h"
#include "humanoid/auto_rig.h"
#include "passes/auto_skin.h"
#include "passes/merge_clips.h"
#include "passes/mesh_order.h"
#include "progress.h"
#include "rig/attach_rig.h"
#include "rig/clips.h"
#include "rig/parse_rig.h"
#include "source/importers.h"
#include "source/source_file.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/source_format.h>
#include <bendy/format/byte_reader.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>

#include <algorithm>
#include <new>
#include <string>
#include <unordered_set>
#include <utility>

namespace bendy::converter {
namespace {

/// The rig that `bendy export` has left in the scene. True if nothing else may speak.
bool attach_exported_rig(Scene& scene, const JointIndex& index, Claims& claims, bool markers_are_told, Report& report) {
    const std::optional<Rig> rig = take_rig_from_extras(scene, report);
    if (!rig) return false;
    try {
        attach_rig(scene, *rig, index, claims, report);
        if (!markers_are_told) attach_markers(scene, *rig, report);
        attach_curves(scene, *rig, index, report);
        return rig->complete;
    } catch (const Failure& failure) {
        report.warn("rig left out: " + failure.error.message, rig->source + failure.error.place);
        return false;
    }
}

/// Gives a scene its joint constraints and IK chains, and clips the markers and curves of rig files. The sources come
/// in the order of their authority (spec/rig.md): what an earlier one says of a joint, or of a chain's name, no later
/// one changes. Fails where the rig file does not go with the scene. \param with_proposals  what is left gets
/// constraints and chains by the joints' names
void attach_rigs(Scene& scene, const std::optional<Rig>& rig_file, bool with_proposals, Report& report) {
    const JointIndex index(scene);
    Claims claims{std::vector<bool>(scene.joints.size()), {}};
    if (rig_file) {
        attach_rig(scene, *rig_file, index, claims, report);
        attach_markers(scene, *rig_file, report);
        attach_curves(scene, *rig_file, index, report);
    }
    const bool is_told = rig_file && rig_file->complete;
    const bool markers_are_told = rig_file && rig_file->clips;
    if (is_told || attach_exported_rig(scene, index, claims, markers_are_told, report)) return;
    attach_extras(scene, index, claims, report);
    add_vrm_chains(scene, report);
    add_articulations(scene, claims.joints, report);
    if (with_proposals) auto_rig(scene, claims.joints, report);
}

/// The same for a scene that has its rig already: only the rig file goes before what is there, "complete" ones replace
/// all of it; extras and extensions have spoken when the rig was made.
void change_rig(Scene& scene, const std::optional<Rig>& rig_file, bool with_proposals, Report& report) {
    const JointIndex index(scene);
    Claims claims{std::vector<bool>(scene.joints.size()), {}};
    if (rig_file) {
        if (rig_file->complete) {
            for (Joint& joint : scene.joints) joint.constraints.clear();
        }
        std::unordered_set<std::string_view> renewed;
        for (const RigChain& chain : rig_file->chains) renewed.insert(chain.name);
        std::erase_if(scene.chains,
                      [&](const Chain& chain) { return rig_file->complete || renewed.contains(chain.name); });
        attach_rig(scene, *rig_file, index, claims, report);
        attach_markers(scene, *rig_file, report);
        attach_curves(scene, *rig_file, index, report);
        if (rig_file->complete) return;
    }
    if (with_proposals) auto_rig(scene, claims.joints, report);
}

constexpr std::string_view kGenerator = "bendy " BENDY_VERSION;

using Buffer = std::vector<std::byte>;

/// The scene of a source of any kind, with its rig.
Result<Scene, ImportError> import_source(std::optional<Buffer> source, const std::filesystem::path& file,
                                         const ConvertOptions& options, const std::optional<Rig>& rig, Report& report) {
    if (std::string why = source ? why_not_convertible(*source, file) : why_not_convertible(file); !why.empty())
        return ImportError{{}, std::move(why)};
    const ReadableFolders folders =
        source ? folders_of_bytes(file, options.gltf.root) : ReadableFolders::of(file, options.gltf.root);
    const std::filesystem::path named = source || file.has_parent_path() ? file : "." / file;
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
    if (!importer.takes_texture && !options.texture.empty())
        return ImportError{{}, "a texture can be set for Quake II models only"};
    auto scene = importer.import(*std::move(source), named, options, report);
    if (!scene) return scene;
    // Where images are to be embedded, a link is what could not be read: it stays what the source says.
    if (format == SourceFormat::bendy || !options.gltf.embed_images)
        move_links(*scene, file, options.output.empty() ? file : options.output, folders, report);
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
        constexpr double kLodDone = 0.4;  // of the work, where both are asked for
        if (options.progress) options.progress(0.0);
        if (options.lod) collapse_vertices(*scene, part_of(options.progress, 0.0, options.compact ? kLodDone : 1.0));
        const Progress compact_progress = part_of(options.progress, options.lod ? kLodDone : 0.0, 1.0);
        if (options.sort_vertices && !options.lod && !options.compact)
            std::for_each(scene->meshes.begin(), scene->meshes.end(), sort_by_bones);
        Buffer bytes = options.compact ? build_compact(*scene, {*options.compact, compact_progress, options.threads},
                                                       kGenerator, report)
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
