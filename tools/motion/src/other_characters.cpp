#include "other_characters.h"

#include <bendy/format/role.h>

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace bendy::motion {
namespace {

/// By joint: how many bones are at and below it. All joints are bones if no mesh is bound.
std::vector<std::uint32_t> count_bones(const Model& model) {
    std::vector<std::uint32_t> counts(model.joints().size());
    bool has_any = false;
    for (const Mesh& mesh : model.meshes()) {
        for (const std::uint32_t joint : mesh.palette.joints) counts[joint] = has_any = true;
    }
    if (!has_any) counts.assign(counts.size(), 1);
    for (std::size_t joint = counts.size(); joint-- > 0;) {  // parents come first
        if (model.parents()[joint] != kNone) counts[model.parents()[joint]] += counts[joint];
    }
    return counts;
}

std::string shown(const Model& model, std::uint32_t joint) {
    return '"' + std::string(model.joints()[joint].name) + "\" (#" + std::to_string(joint) + ')';
}

}  // namespace

std::optional<std::string> tell_other_characters(const Model& model, const char* what) {
    const auto parents = model.parents();
    const std::vector<std::uint32_t> counts = count_bones(model);
    std::vector<bool> carries(counts.size());  // a joint with a role
    std::uint32_t hips = kNone;
    for (const JointRole& role : model.roles()) {
        if (static_cast<Role>(role.role) == Role::hips) hips = role.joint;
        for (std::uint32_t joint = role.joint; joint != kNone && !carries[joint]; joint = parents[joint])
            carries[joint] = true;
    }
    if (hips == kNone) return std::nullopt;
    std::string others;
    std::uint32_t carrier = kNone;  // the lowest joint above the hips that another character is beside, or none
    for (std::uint32_t joint = 0; joint < counts.size(); ++joint) {
        const bool is_beside = !carries[joint] && (parents[joint] == kNone || carries[parents[joint]]);
        if (!is_beside || counts[joint] < kFewestCharacterJoints || 2 * counts[joint] < counts[hips]) continue;
        bool is_above = parents[joint] == kNone;
        for (std::uint32_t above = parents[hips]; above != kNone; above = parents[above])
            is_above = is_above || above == parents[joint];
        if (!is_above) continue;
        others += (others.empty() ? "" : ", ") + shown(model, joint);
        carrier = parents[joint];
    }
    if (others.empty()) return std::nullopt;
    std::uint32_t root = hips;
    while (parents[root] != carrier && parents[root] != kNone) root = parents[root];
    return std::string(what) + " is the character below the joint " + shown(model, root) + "; its file has " + others +
           " beside it. To take another one, convert the file with a rig file (--rig) that names its hips: "
           "{\"bendy_rig\": 1, \"roles\": {\"hips\": \"NAME\"}}";
}

}  // namespace bendy::motion
