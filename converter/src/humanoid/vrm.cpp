#include "vrm.h"

#include "json_text.h"
#include "limb_chains.h"
#include "rest_frames.h"

#include <string>

namespace bendy::converter {
namespace {

/// Fills a humanoid from JSON, bone by bone.
class Reader {
public:
    Reader(const Scene& scene, Report& report) : scene_(scene), report_(report) {}

    /// `entry` is {"node": joint}.
    void add(const std::string& name, const Json& entry, const std::string& place) {
        if (!entry.is_object()) return warn("a VRM bone is no object, left out", place);
        const auto node = entry.find("node");
        if (node == entry.end()) return warn("a VRM bone without a node is left out", place);
        if (node->is_null()) return;  // named when the extension was kept
        if (!node->is_number_unsigned() || node->get<std::uint64_t>() >= scene_.joints.size())
            return warn("the node of a VRM bone is no node's number, left out", place + ".node");
        const std::optional<HumanBone> bone = bone_of_vrm_name(name);
        if (!bone) return;
        if (humanoid.has(*bone)) return warn("a VRM bone is named twice, the first counts", place);
        humanoid[*bone] = node->get<std::uint32_t>();
    }

    void warn(const char* message, const std::string& place) { report_.warn(message, place); }

    Humanoid humanoid;

private:
    const Scene& scene_;
    Report& report_;
};

/// The member of an object that must be an object or array itself; null if it is not there, or of another type.
const Json* member(const Json& object, const char* name, bool is_array, const std::string& place, Reader& reader) {
    const auto found = object.find(name);
    if (found != object.end() && (is_array ? found->is_array() : found->is_object())) return &*found;
    reader.warn(is_array ? "a VRM humanoid's bones must be an array, left out"
                         : "a VRM extension without this object has no humanoid, left out",
                place + '.' + name);
    return nullptr;
}

void read_bones_1(const Json& vrm, const std::string& place, Reader& reader) {
    const Json* humanoid = member(vrm, "humanoid", false, place, reader);
    if (humanoid == nullptr) return;
    const std::string here = place + ".humanoid";
    const Json* bones = member(*humanoid, "humanBones", false, here, reader);
    if (bones == nullptr) return;
    for (auto bone = bones->begin(); bone != bones->end(); ++bone)
        reader.add(bone.key(), bone.value(), here + ".humanBones." + bone.key());
}

void read_bones_0(const Json& vrm, const std::string& place, Reader& reader, Report& report) {
    const Json* humanoid = member(vrm, "humanoid", false, place, reader);
    if (humanoid == nullptr) return;
    const std::string here = place + ".humanoid";
    const Json* bones = member(*humanoid, "humanBones", true, here, reader);
    if (bones == nullptr) return;
    std::uint64_t own_constraints = 0;
    std::string first_constraint;
    for (std::size_t i = 0; i < bones->size(); ++i) {
        const Json& entry = (*bones)[i];
        const std::string at = here + ".humanBones[" + std::to_string(i) + ']';
        const bool is_named = entry.is_object() && entry.contains("bone") && entry["bone"].is_string();
        if (!is_named) {
            reader.warn("a VRM bone without a name is left out", at);
            continue;
        }
        reader.add(entry["bone"].get<std::string>(), entry, at);
        if (const auto defaults = entry.find("useDefaultValues"); defaults != entry.end() && *defaults == false) {
            if (own_constraints++ == 0) first_constraint = at;
        }
    }
    if (own_constraints > 0) {
        report.warn("limits of VRM 0.x bones are kept as JSON, not interpreted: they are about Unity's muscle axes",
                    first_constraint, own_constraints);
    }
}

}  // namespace

std::optional<VrmHumanoid> read_vrm_humanoid(const Scene& scene, Report& report) {
    if (scene.extensions.empty()) return std::nullopt;
    const Json extensions = Json::parse(scene.extensions, nullptr, false);
    if (!extensions.is_object()) return std::nullopt;
    Reader reader(scene, report);
    VrmHumanoid result;
    if (const auto vrm = extensions.find("VRMC_vrm"); vrm != extensions.end()) {
        result.place = "extensions.VRMC_vrm.humanoid";
        read_bones_1(*vrm, "extensions.VRMC_vrm", reader);
    } else if (const auto old = extensions.find("VRM"); old != extensions.end()) {
        result.place = "extensions.VRM.humanoid";
        result.faces_backward = true;
        read_bones_0(*old, "extensions.VRM", reader, report);
    } else {
        return std::nullopt;
    }
    result.bones = reader.humanoid;
    return result;
}

void add_vrm_chains(Scene& scene, Report& report) {
    const std::optional<VrmHumanoid> vrm = read_vrm_humanoid(scene, report);
    if (!vrm) return;
    Stance stance;
    if (vrm->faces_backward) {
        stance.left = -stance.left;
        stance.forward = -stance.forward;
    }
    const RestFrames rest(scene);
    add_new_chains(scene, make_limb_chains(scene, rest, vrm->bones, stance, 0, vrm->place, report));
}

}  // namespace bendy::converter
