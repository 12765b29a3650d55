#include "find_body.h"

#include "assumed_stand.h"
#include "complete_human.h"
#include "posture.h"
#include "standing_pose.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace bendy::converter {
namespace {

using Bone = HumanBone;

/// Completes the humanoid from the skeleton's shape: limbs that are missing on one or both sides, hips, spine and head.
void complete(const Scene& scene, const RestFrames& rest, const ClipRotations& clips, const std::vector<bool>& chosen,
              NamedHumanoid& found) {
    Humanoid& bones = found.bones;
    const auto has_pair = [&](Limb left, Limb right) {
        return bones.has(bones_of(left).lower) && bones.has(bones_of(right).lower);
    };
    const bool has_arms = has_pair(Limb::left_arm, Limb::right_arm);
    const bool has_legs = has_pair(Limb::left_leg, Limb::right_leg);
    if (!has_arms || !has_legs) {
        if (const std::optional<ShapedHumanoid> shaped = find_by_shape(scene, rest, clips, chosen)) {
            found.is_by_shape = true;
            found.contradicts_names = shaped->contradicts_names;
            const auto take = [&](Bone first, Bone last, std::size_t loose) {
                for (auto left = static_cast<std::size_t>(first); left <= static_cast<std::size_t>(last); ++left) {
                    for (const Bone bone : {static_cast<Bone>(left), mirrored(static_cast<Bone>(left))})
                        bones[bone] = shaped->bones[bone];
                }
                for (const std::size_t side : {0u, 1u}) {
                    found.loose_ends[loose + side] = kNone;
                    found.mesh_ends[loose + side].reset();
                }
            };
            if (!has_arms) take(Bone::left_shoulder, Bone::left_hand, 0);
            if (!has_legs) take(Bone::left_upper_leg, Bone::left_toes, 2);
            if (!has_arms) bones[Bone::left_thumb_metacarpal] = bones[Bone::right_thumb_metacarpal] = kNone;
            for (const Bone bone : {Bone::hips, Bone::spine, Bone::neck, Bone::head}) {
                if (!has_arms && !has_legs && !bones.has(Bone::head)) bones[bone] = shaped->bones[bone];
            }
        }
    }
    find_mesh_ends(scene, rest, found);
    find_trunk_by_shape(scene, rest, chosen, bones);
}

bool has_all_limbs(const Humanoid& bones) {
    return bones.has(Bone::left_lower_arm) && bones.has(Bone::right_lower_arm) && bones.has(Bone::left_lower_leg) &&
           bones.has(Bone::right_lower_leg);
}

/// Completes a humanoid found by name from the shape of the bound joints; if that is not enough, from all joints.
NamedHumanoid find_the_rest(const Scene& scene, const RestFrames& rest, const ClipRotations& clips,
                            const std::vector<bool>& bound, const std::vector<bool>& among, NamedHumanoid named) {
    complete(scene, rest, clips, bound, named);
    if (has_all_limbs(named.bones)) return named;
    // A file may contain only some of its character's meshes.
    std::vector<bool> all = among;
    for (const Mesh& mesh : scene.meshes) {
        if (mesh.joint != kNone && mesh.influences > 0) all[mesh.joint] = false;  // carries a mesh, is not a bone
    }
    NamedHumanoid among_all = find_humanoid(scene, rest, all);
    complete(scene, rest, clips, all, among_all);
    return has_all_limbs(among_all.bones) ? among_all : named;
}

/// Whether the names give both arms and legs of a body whose spine goes up from the legs. Front legs may be an
/// animal's.
bool is_upright_human(const RestFrames& rest, const NamedHumanoid& named) {
    if (!has_all_limbs(named.bones) || named.has_front_legs) return false;
    const std::optional<Posture> posture = measure_posture(rest, named);
    return posture && posture->is_upright;
}

/// Whether the names are those of all parts of a human. Those of a wolf may be, too.
bool has_all_names(const NamedHumanoid& named) {
    constexpr std::array kParts{Bone::hips, Bone::head, Bone::left_foot, Bone::right_foot};
    return has_all_limbs(named.bones) && !named.has_front_legs && !named.is_by_shape &&
           std::all_of(kParts.begin(), kParts.end(), [&](Bone bone) { return named.bones.has(bone); });
}

/// Whether this is a human, however it is posed: no animal has thumbs.
bool is_human_by_name(const NamedHumanoid& named) {
    return has_all_names(named) && named.bones.has(Bone::left_thumb_metacarpal) &&
           named.bones.has(Bone::right_thumb_metacarpal);
}

/// Whether meshes are bound to joints: to a pose that was made for the body, while the rest pose may be that of a clip.
bool has_skin(const Scene& scene) {
    return std::any_of(scene.meshes.begin(), scene.meshes.end(),
                       [](const Mesh& mesh) { return !mesh.palette.joints.empty(); });
}

FoundBody find_in_pose(const Scene& scene, const RestFrames& pose, const ClipRotations& clips,
                       const std::vector<bool>& among) {
    FoundBody body;
    std::vector<bool> bound = find_bound_joints(scene);
    for (std::size_t joint = 0; joint < bound.size(); ++joint) bound[joint] = bound[joint] && among[joint];
    const NamedHumanoid named = find_humanoid(scene, pose, bound);
    if (!is_upright_human(pose, named) && !is_human_by_name(named)) body.animal = find_animal(scene, pose, bound);
    if (body.animal && body.animal->legs.size() == kFourLegs) return body;
    // Coats reach the ground, too: what has more legs may be a human.
    body.human = find_the_rest(scene, pose, clips, bound, among, named);
    body.whole_human = complete_human(scene, pose, body.human);
    if (body.whole_human) body.animal.reset();
    return body;
}

}  // namespace

FoundBody find_body(const Scene& scene, const ClipRotations& clips, const std::vector<bool>& among) {
    FoundBody at_rest = find_in_pose(scene, RestFrames(scene), clips, among);
    if (at_rest.is_whole()) return at_rest;
    const auto find_in = [&](CandidatePose pose) {
        FoundBody body = find_in_pose(scene, RestFrames(scene, pose.locals), clips, among);
        body.pose = std::move(pose.locals);
        return body;
    };
    for (CandidatePose& pose : find_bind_poses(scene)) {
        FoundBody body = find_in(std::move(pose));
        if (body.is_whole()) return body;
    }
    const Humanoid& named = at_rest.human.bones;
    const glm::dvec3 up = find_up(scene, named);
    std::optional<CandidatePose> frame = find_standing_frame(scene, named, up);
    const auto standing = frame ? judge_stand(RestFrames(scene, frame->locals), named, up) : std::nullopt;
    std::vector<Transform> base = frame ? frame->locals : rest_of(scene);
    if (standing && standing->is_upright()) {
        FoundBody body = find_in(*std::move(frame));
        if (body.is_whole()) return body;
    }
    // Where a body stands at rest, its shape has contradicted the names.
    const auto rests = judge_stand(RestFrames(scene), named, up);
    const bool is_clear = is_human_by_name(at_rest.human) || (has_all_names(at_rest.human) && !has_skin(scene));
    if (is_clear && !(rests && rests->stands())) {
        FoundBody body = find_in({StandingEvidence::assumed, assume_stand(scene, named, base, std::nullopt)});
        if (body.is_whole()) return body;
    }
    return at_rest;
}

}  // namespace bendy::converter
