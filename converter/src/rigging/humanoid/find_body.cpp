#include "find_body.h"

#include <glm/geometric.hpp>

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

class Measurer {
public:
    Measurer(const RestFrames& rest, const NamedHumanoid& found) : rest_(rest), found_(found) {}

    [[nodiscard]] std::optional<Posture> measure() const {
        const auto arms = line(Bone::right_upper_arm, Bone::left_upper_arm);
        const auto legs = line(Bone::right_upper_leg, Bone::left_upper_leg);
        if (!arms && !legs) return std::nullopt;
        const auto left = unit((arms ? *arms : glm::dvec3(0.0)) + (legs ? *legs : glm::dvec3(0.0)));
        const auto stands = up_from_legs();
        const auto spine = up_spine();
        if (!left || (!stands && !spine)) return std::nullopt;
        Posture posture;
        posture.is_upright = !stands || !spine || glm::dot(*stands, *spine) > kUpright;
        const auto up = unit_across(posture.is_upright && spine ? *spine : *stands, *left);
        if (!up) return std::nullopt;
        posture.stance = {*left, *up, glm::cross(*left, *up)};
        posture.has_feet_forward = has_feet_forward(posture.stance);
        return posture;
    }

private:
    [[nodiscard]] bool has_feet_forward(const Stance& stance) const {
        for (const auto& [foot, toes] :
             {std::pair(Bone::left_foot, Bone::left_toes), std::pair(Bone::right_foot, Bone::right_toes)}) {
            const auto direction = line(foot, toes);
            if (direction && glm::dot(*direction, stance.forward) < -0.3) return false;
        }
        return true;
    }

    static constexpr double kUpright = 0.7;  // cosine: 45 degrees

    [[nodiscard]] std::optional<glm::dvec3> line(Bone from, Bone to) const {
        if (!found_.bones.has(from) || !found_.bones.has(to)) return std::nullopt;
        return rest_.direction(found_.bones[from], found_.bones[to]);
    }

    [[nodiscard]] std::optional<glm::dvec3> up_from_legs() const {
        glm::dvec3 sum(0.0);
        for (const Limb leg : {Limb::left_leg, Limb::right_leg}) {
            const LimbBones bones = bones_of(leg);
            if (!found_.bones.has(bones.upper) || !found_.bones.has(bones.lower)) continue;
            const std::optional<glm::dvec3> end = end_of(found_, rest_, leg);
            const glm::dvec3 foot = end ? *end : rest_.position(found_.bones[bones.lower]);
            if (const auto up = unit(rest_.position(found_.bones[bones.upper]) - foot)) sum += *up;
        }
        return unit(sum);
    }

    [[nodiscard]] std::optional<glm::dvec3> up_spine() const {
        for (const Bone top : {Bone::neck, Bone::head}) {
            for (const Bone bottom : {Bone::hips, Bone::spine}) {
                if (const auto up = line(bottom, top)) return up;
            }
        }
        return std::nullopt;
    }

    const RestFrames& rest_;
    const NamedHumanoid& found_;
};

/// Whether the names give both arms and legs of a body whose spine goes up from the legs.
bool is_upright_human(const RestFrames& rest, const NamedHumanoid& named) {
    if (!has_all_limbs(named.bones)) return false;
    const std::optional<Posture> posture = measure_posture(rest, named);
    return posture && posture->is_upright;
}

}  // namespace

std::optional<Posture> measure_posture(const RestFrames& rest, const NamedHumanoid& found) {
    return Measurer(rest, found).measure();
}

FoundBody find_body(const Scene& scene, const RestFrames& rest, const ClipRotations& clips,
                    const std::vector<bool>& among) {
    FoundBody body;
    std::vector<bool> bound = find_bound_joints(scene);
    for (std::size_t joint = 0; joint < bound.size(); ++joint) bound[joint] = bound[joint] && among[joint];
    body.human = find_humanoid(scene, rest, bound);
    if (!is_upright_human(rest, body.human)) body.animal = find_quadruped(scene, rest, bound);
    if (!body.animal) body.human = find_the_rest(scene, rest, clips, bound, among, body.human);
    return body;
}

}  // namespace bendy::converter
