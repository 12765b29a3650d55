#pragma once

#include "clip_rotations.h"
#include "humanoid.h"
#include "rest_frames.h"

#include <bendy/converter/scene.h>

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace bendy::converter {

/// By joint: whether a mesh is bound to it, or to one below it. All where no mesh is bound.
std::vector<bool> find_bound_joints(const Scene& scene);

/// The limbs that two bones make, by their place in arrays.
enum class Limb : std::uint8_t { left_arm, right_arm, left_leg, right_leg };
inline constexpr std::size_t kLimbs = 4;

/// A humanoid found in a skeleton.
struct NamedHumanoid {
    Humanoid bones;
    /// Hands and feet that are not below their limb, as those that an IK rig moves; kNone where the limb has its end or
    /// none is found.
    std::array<std::uint32_t, kLimbs> loose_ends{kNone, kNone, kNone, kNone};
    /// Where the mesh of a limb ends that has no joint there, in model space.
    std::array<std::optional<glm::dvec3>, kLimbs> mesh_ends{};
    /// The hand's joint is one of several that spread from the forearm: no wrist turns them all.
    bool has_split_hands = false;
    bool is_by_shape = false;        ///< its limbs, or some of them, were found by the skeleton's shape
    bool contradicts_names = false;  ///< left and right are the other way round than the names say
};

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

/// Where a limb ends at rest, in model space: at its last joint, at one that is moved by itself, or with its mesh.
std::optional<glm::dvec3> end_of(const NamedHumanoid& found, const RestFrames& rest, Limb limb);

/// Fills in what has no joint at a limb's end.
void find_mesh_ends(const Scene& scene, const RestFrames& rest, NamedHumanoid& found);

/// Looks for limbs, spine and head by name. A limb's bones lie below one another, other joints may be between. Of
/// several fitting joints one that moves vertices, or has such below it, counts before a control, and of these the one
/// nearest the root. \param chosen  by joint: only these are looked at
NamedHumanoid find_humanoid(const Scene& scene, const RestFrames& rest, const std::vector<bool>& chosen);

struct ShapedHumanoid {
    Humanoid bones;
    bool contradicts_names = false;  ///< left and right are the other way round than pairs of names say
};

/// A humanoid found by its skeleton's shape alone: two pairs of limbs that are each other's mirror images, of two long
/// bones each, one pair that the character stands on and one above it, on a trunk that goes up from the legs. Animals
/// on four legs, hands and vehicles have none. Left and right, which the shape leaves open, are what pairs of names
/// say (`lhip`, `rhip`), which way the toes and knees point, and how the clips bend knees and elbows: together these
/// outweigh names. Where all are silent the character looks along +Z, as glTF asks.
/// \param chosen  by joint: only these are looked at
std::optional<ShapedHumanoid> find_by_shape(const Scene& scene, const RestFrames& rest, const ClipRotations& clips,
                                            const std::vector<bool>& chosen);

/// Fills in hips, spine, neck and head where they are not known: what lies between the legs and the arms, and what goes
/// on upward from there.
void find_trunk_by_shape(const Scene& scene, const RestFrames& rest, const std::vector<bool>& chosen,
                         Humanoid& humanoid);

}  // namespace bendy::converter
