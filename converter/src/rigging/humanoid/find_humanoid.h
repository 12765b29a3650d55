#pragma once

#include "clip_rotations.h"
#include "humanoid.h"
#include "scene/rest_frames.h"

#include <bendy/converter/scene.h>

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace bendy::converter {

/// By joint: whether a mesh is bound to it or to a descendant. All true if no mesh is bound.
std::vector<bool> find_bound_joints(const Scene& scene);

/// The limbs with two bones, as array indices.
enum class Limb : std::uint8_t { left_arm, right_arm, left_leg, right_leg };
inline constexpr std::size_t kLimbs = 4;

/// A humanoid found in a skeleton.
struct NamedHumanoid {
    Humanoid bones;
    /// Hands and feet outside their limb, such as the controls of an IK rig; kNone if the limb has an end joint or none
    /// is found.
    std::array<std::uint32_t, kLimbs> loose_ends{kNone, kNone, kNone, kNone};
    /// The end of a limb's mesh if the limb has no end joint, in model space.
    std::array<std::optional<glm::dvec3>, kLimbs> mesh_ends{};
    /// The hand's joint is one of several that branch from the forearm: no single wrist joint turns them all.
    bool has_split_hands = false;
    bool has_front_legs = false;     ///< the arms' names are those of front legs
    bool is_by_shape = false;        ///< some or all limbs were found by the skeleton's shape
    bool contradicts_names = false;  ///< left and right are opposite to the names
};

/// By joint: whether it or a descendant moves vertices. All true if nothing moves any.
std::vector<bool> find_moving_joints(const Scene& scene);

/// The upper, lower and last bone of a limb.
struct LimbBones {
    HumanBone upper, lower, end;
};
constexpr LimbBones bones_of(Limb limb) {
    constexpr std::array<LimbBones, kLimbs> kBones{
        LimbBones{HumanBone::left_upper_arm, HumanBone::left_lower_arm, HumanBone::left_hand},
        LimbBones{HumanBone::right_upper_arm, HumanBone::right_lower_arm, HumanBone::right_hand},
        LimbBones{HumanBone::left_upper_leg, HumanBone::left_lower_leg, HumanBone::left_foot},
        LimbBones{HumanBone::right_upper_leg, HumanBone::right_lower_leg, HumanBone::right_foot}};
    return kBones[static_cast<std::size_t>(limb)];
}

/// The end of a limb at rest, in model space: its last joint, a separately moved joint, or the end of its mesh.
std::optional<glm::dvec3> end_of(const NamedHumanoid& found, const RestFrames& rest, Limb limb);

/// Sets mesh_ends for limbs without an end joint.
void find_mesh_ends(const Scene& scene, const RestFrames& rest, NamedHumanoid& found);

/// Finds limbs, spine and head by name. A limb's bones are descendants of one another, with other joints between them
/// allowed; a pair of limbs may have an upper bone only. Of several matching joints, one that moves vertices, or has
/// descendants that do, is preferred to a control, and then the one nearest the root.
/// \param chosen  by joint: only these are considered
NamedHumanoid find_humanoid(const Scene& scene, const RestFrames& rest, const std::vector<bool>& chosen);

struct ShapedHumanoid {
    Humanoid bones;
    bool contradicts_names = false;  ///< left and right are opposite to the sides in names
};

/// Finds a humanoid by its skeleton's shape alone: two pairs of mirrored limbs of two long bones each, one pair that
/// the character stands on and one above it, on a trunk that goes up from the legs. Four-legged animals, hands and
/// vehicles do not match. Left and right, which the shape leaves open, are decided by pairs of names (`lhip`, `rhip`),
/// the direction of toes and knees, and how the clips bend knees and elbows; shape and clips together outweigh names.
/// Without any evidence the character faces +Z, as glTF prescribes.
/// \param chosen  by joint: only these are considered
std::optional<ShapedHumanoid> find_by_shape(const Scene& scene, const RestFrames& rest, const ClipRotations& clips,
                                            const std::vector<bool>& chosen);

/// Fills in missing hips, spine, neck and head: the joints between the legs and the arms, and the branch that continues
/// upward from there.
void find_trunk_by_shape(const Scene& scene, const RestFrames& rest, const std::vector<bool>& chosen,
                         Humanoid& humanoid);

}  // namespace bendy::converter
