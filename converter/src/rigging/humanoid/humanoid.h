#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/records.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace bendy::converter {

/// The parts of a human skeleton for which chains and limits are made. Left and right are the character's own; the
/// right limbs follow the left ones in the same order.
enum class HumanBone : std::uint8_t {
    hips,
    spine,
    chest,
    upper_chest,
    neck,
    head,
    left_shoulder,  ///< the clavicle
    left_upper_arm,
    left_lower_arm,
    left_hand,
    left_thumb,  ///< its first bone, or the second: only used to tell the hand's sides apart
    left_upper_leg,
    left_lower_leg,
    left_foot,
    left_toes,
    right_shoulder,
    right_upper_arm,
    right_lower_arm,
    right_hand,
    right_thumb,
    right_upper_leg,
    right_lower_leg,
    right_foot,
    right_toes,
};
inline constexpr std::size_t kHumanBones = 24;
inline constexpr std::size_t kLimbBones = 9;  ///< per side

constexpr bool is_right(HumanBone bone) {
    return bone >= HumanBone::right_shoulder;
}

/// The right-hand counterpart of a left bone.
constexpr HumanBone mirrored(HumanBone left) {
    return static_cast<HumanBone>(static_cast<std::size_t>(left) + kLimbBones);
}

/// Maps bones to joints; kNone: the bone is missing.
class Humanoid {
public:
    Humanoid() { joints_.fill(kNone); }

    std::uint32_t& operator[](HumanBone bone) { return joints_[static_cast<std::size_t>(bone)]; }
    std::uint32_t operator[](HumanBone bone) const { return joints_[static_cast<std::size_t>(bone)]; }
    [[nodiscard]] bool has(HumanBone bone) const { return (*this)[bone] != kNone; }

private:
    std::array<std::uint32_t, kHumanBones> joints_{};
};

/// VRM's name of the bone, as `leftUpperArm`.
std::string_view vrm_name(HumanBone bone);

/// The bone with that VRM name; nothing for the other finger bones, eyes, jaw and unknown names.
std::optional<HumanBone> bone_of_vrm_name(std::string_view name);

/// The part of a body that a joint's name refers to.
enum class BodyPart : std::uint8_t {
    hips,
    spine,
    chest,
    neck,
    head,
    shoulder,
    upper_arm,
    lower_arm,
    hand,
    thumb,
    upper_leg,
    lower_leg,
    foot,
    toes,
    arm,  ///< upper or lower: decided by the other one's name
    leg,  ///< like arm
};
inline constexpr std::size_t kBodyParts = 16;

enum class BodySide : std::uint8_t { none, left, right };

struct BoneName {
    BodyPart part = BodyPart::hips;
    BodySide side = BodySide::none;  ///< always left or right for the parts of a limb
    std::uint8_t rank = 0;           ///< 0 for an unambiguous name, 1 for a loose one, such as `palm` for a hand
};

/// Parses a joint's name as written by Mixamo, VRM, Unreal, Rigify, Biped, Daz, H-Anim and most others:
/// `mixamorig:LeftArm`, `J_Bip_L_UpperArm`, `upperarm_l`, `DEF-upper_arm.L`, `Bip01 L UpperArm`. Nothing for controls,
/// twist and other helper segments, fingers, and unrecognised names.
std::optional<BoneName> read_bone_name(std::string_view name);

/// The humanoid that a VRM extension describes.
struct VrmHumanoid {
    Humanoid bones;
    bool faces_backward = false;  ///< VRM 0.x faces -Z, 1.0 +Z
    const char* place = "";       ///< JSON path of the humanoid
};

/// The humanoid of VRMC_vrm (1.0) or VRM (0.x) in Scene::extensions, where nodes are joint numbers; nothing if the
/// scene has none. Malformed entries are named in `report`, by JSON path, and left out.
std::optional<VrmHumanoid> read_vrm_humanoid(const Scene& scene, Report& report);

}  // namespace bendy::converter
