#include "passes/attach_rigs.h"

#include "failure.h"
#include "humanoid/auto_rig.h"
#include "humanoid/vrm.h"
#include "rig/attach_rig.h"
#include "rig/curves.h"

#include <unordered_set>

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

}  // namespace

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

}  // namespace bendy::converter
