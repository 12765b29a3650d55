#include <bendy/converter/convert.h>

#include "convert/build_compact.h"
#include "convert/importers.h"
#include "optimise/collapse/collapse_vertices.h"
#include "optimise/passes/auto_skin.h"
#include "optimise/passes/bone_order.h"
#include "optimise/passes/drop_unused.h"
#include "optimise/passes/merge_clips.h"
#include "rigging/humanoid/find_roles.h"
#include "rigging/humanoid/missing_roles.h"
#include "rigging/rig/attach_rig.h"
#include "rigging/rig/clips.h"
#include "rigging/rig/parse_rig.h"
#include "scene/failure.h"
#include "scene/progress.h"
#include "scene/source/source_file.h"
#ifdef BENDY_AUTO_RIG
#include "rigging/humanoid/auto_rig.h"
#include "rigging/humanoid/standing_pose.h"
#endif

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

#ifndef BENDY_AUTO_RIG
void auto_rig(Scene& /*scene*/, const std::vector<bool>& /*claimed*/, Report& /*report*/) {
    fail({}, "--auto-rig needs a program that was built with BENDY_AUTO_RIG=ON");
}
void add_vrm_chains(Scene& /*scene*/, Report& /*report*/) {}
void find_standing_pose(Scene& /*scene*/, Report& /*report*/) {}
void orient(Scene& /*scene*/, SourceUp up, bool faces_front, Report& /*report*/) {
    if (up == SourceUp::z || faces_front)
        fail({}, "--up and --face need a program that was built with BENDY_AUTO_RIG=ON");
}
#endif

/// Attaches the rig file in the scene's extras. Returns true if it is complete, so that other sources are ignored.
bool attach_exported_rig(Scene& scene, const JointIndex& index, Claims& claims, bool markers_are_told, Report& report) {
    const std::optional<Rig> rig = take_rig_from_extras(scene, report);
    if (!rig) return false;
    try {
        attach_rig(scene, *rig, index, claims, report);
        attach_roles(scene, *rig, index);
        attach_standing_pose(scene, *rig, index);
        if (!markers_are_told) attach_markers(scene, *rig, report);
        attach_curves(scene, *rig, index, report);
        return rig->complete;
    } catch (const Failure& failure) {
        report.warn("rig left out: " + failure.error.message, rig->source + failure.error.place);
        return false;
    }
}

/// Attaches joint constraints, IK chains, markers and curves to a scene. Sources are applied in the order of their
/// authority (spec/rig.md): a later one never changes a joint or a chain name that an earlier one has set. Fails if the
/// rig file does not fit the scene.
/// \param with_proposals  propose constraints and chains for the rest by the joints' names
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

/// As above, for a scene that already has a rig: the rig file overrides it, and replaces it if it is "complete". Extras
/// and other extensions are not read: they were when that rig was made.
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

bool has_rig(const Scene& scene) {
    return !scene.chains.empty() || std::any_of(scene.joints.begin(), scene.joints.end(),
                                                [](const Joint& joint) { return !joint.constraints.empty(); });
}

constexpr std::string_view kGenerator = "bendy " BENDY_VERSION;

using Buffer = std::vector<std::byte>;

/// Imports a source of any format, with its rig.
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
    if (!importer.takes_unit && options.unit != 0.0) return ImportError{{}, "a unit can be set for BVH files only"};
    if (!importer.takes_unit && options.up != SourceUp::found)
        return ImportError{{}, "the axis that is up can be set for BVH files only"};
    auto scene = importer.import(*std::move(source), named, options, report);
    if (!scene) return scene;
    // If images are embedded, the remaining links are files that could not be read: they keep the source's URI.
    if (format == SourceFormat::bendy || !options.gltf.embed_images)
        move_links(*scene, file, options.output.empty() ? file : options.output, folders, report);
    if (format == SourceFormat::gltf && !has_rig(*scene)) {
        attach_rigs(*scene, rig, options.auto_rig, report);
    } else {
        change_rig(*scene, rig, options.auto_rig, report);
    }
    const JointIndex index(*scene);
    if (!rig || !rig->complete || !rig->roles) find_roles(*scene, rig ? find_hips(*rig, index) : kNone, report);
    if (rig) attach_roles(*scene, *rig, index);
    warn_of_missing_roles(*scene, report);
    if (rig) attach_standing_pose(*scene, *rig, index);
    orient(*scene, importer.takes_unit ? options.up : SourceUp::y, options.faces_front, report);
    if (!rig || !rig->has_standing_pose) find_standing_pose(*scene, report);
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
        if (scene->was_compact && !options.compact && !options.exact)
            report.suggest("the source is compact, the result is not: --compact writes a compact file again");
        if (options.auto_skin) {
            if (auto bound = auto_skin(*scene, options.skeleton, report); !bound) return bound.error();
        }
        if (options.drop_unused) drop_unused(*scene, report);
        constexpr double kLodDone = 0.4;  // share of the work, if both are requested
        if (options.progress) options.progress(0.0);
        std::vector<Mesh> meshes_without_levels;
        if (options.lod && options.compact) meshes_without_levels = scene->meshes;
        if (options.lod) collapse_vertices(*scene, part_of(options.progress, 0.0, options.compact ? kLodDone : 1.0));
        const Progress compact_progress = part_of(options.progress, options.lod ? kLodDone : 0.0, 1.0);
        if (!options.keep_order && !options.compact) sort_by_bones(*scene);
        const bool has_new_levels = options.lod && !scene->levels.empty();
        if (options.lod && !has_new_levels) report.warn("no levels of detail: no vertex can collapse");
        Buffer bytes = options.compact ? build_compact(*scene,
                                                       {*options.compact, compact_progress, options.threads,
                                                        has_new_levels ? &meshes_without_levels : nullptr},
                                                       kGenerator, report)
                                       : build_chunks(*std::move(scene), kGenerator, report);
        // The importer has checked the source; this checks the importer before anything is written.
        const Faults faults = validate(bytes);
        if (!faults.empty())
            return ImportError{{}, "cannot be held: " + describe_with_place(faults.list().front(), bytes)};
        return bytes;
    } catch (const Failure& failure) {  // only from the rig: importers do not throw
        return ImportError{failure.error.place, failure.error.message, options.rig.value_or(file)};
    } catch (const std::bad_alloc&) {
        return ImportError{{}, std::string(kNotEnoughMemory)};
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
