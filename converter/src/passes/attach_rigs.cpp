#include "passes/attach_rigs.h"

#include "rig/attach_extras.h"
#include "rig/attach_rig.h"

namespace bendy::converter {

void attach_rigs(Scene& scene, const std::optional<Rig>& rig_file, Report& report) {
    const JointIndex index(scene);
    Claims claims{std::vector<bool>(scene.joints.size()), {}};
    if (rig_file) attach_rig(scene, *rig_file, index, claims, report);
    if (rig_file && rig_file->complete) return;
    attach_extras(scene, index, claims, report);
    // Sources of less authority follow here, each as a Rig given to attach_rig with the same claims: the extensions of
    // the file, then proposals by name.
}

}  // namespace bendy::converter
