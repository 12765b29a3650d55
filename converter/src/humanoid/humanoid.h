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

/// The parts of a human's skeleton that chains and limits are made for. Left and right are the character's own; the
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
    left_thumb,  ///< its first bone, or the second: only its side of the hand counts
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
inline constexpr std::size_t kLimbBones = 9;  ///< of one side

constexpr bool is_right(HumanBone bone) {
    return bone >= HumanBone::right_shoulder;
}

/// The right-hand counterpart of a left bone.
constexpr HumanBone mirrored(HumanBone left) {
    return static_cast<HumanBone>(static_cast<std::size_t>(left) + kLimbBones);
}

/// Which joint is which bone; kNone: none is.
class Humanoid {
public:
    Humanoid() { joints_.fill(kNone); }

    std::uint32_t& operator[](HumanBone bone) { return joints_[static_cast<std::size_t>(bone)]; }
    std::uint32_t operator[](HumanBone bone) const { return joints_[static_cast<std::size_t>(bone)]; }
    [[nodiscard]] bool has(HumanBone bone) const { return (*this)[bone] != kNone; }

private:
    std::array<std::uint32_t, kHumanBones> joints_{};
};

/// The name that VRM has for the bone, as `leftUpperArm`.
std::string_view vrm_name(HumanBone bone);

/// The bone of that VRM name; nothing for fingers' further bones, eyes, jaw and what VRM does not know.
std::optional<HumanBone> bone_of_vrm_name(std::string_view name);

/// The part of a body that a joint's name speaks of.
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
    arm,  ///< upper or lower: the other one's name decides
    leg,  ///< as arm
};
inline constexpr std::size_t kBodyParts = 16;

enum class BodySide : std::uint8_t { none, left, right };

struct BoneName {
    BodyPart part = BodyPart::hips;
    BodySide side = BodySide::none;  ///< always left or right for the parts of a limb
    std::uint8_t rank = 0;           ///< 0 a name that is sure, 1 a loose one, as `palm` for a hand
};

/// Reads a joint's name as Mixamo, VRM, Unreal, Rigify, Biped, Daz, H-Anim and most others write them:
/// `mixamorig:LeftArm`, `J_Bip_L_UpperArm`, `upperarm_l`, `DEF-upper_arm.L`, `Bip01 L UpperArm`. Nothing for names of
/// controls, of twist and other helper segments, of fingers, and for names that say nothing.
std::optional<BoneName> read_bone_name(std::string_view name);

/// What a VRM extension says of a character.
struct VrmHumanoid {
    Humanoid bones;
    bool faces_backward = false;  ///< VRM 0.x: looks along -Z; 1.0 along +Z
    const char* place = "";       ///< JSON path of the humanoid
};

/// The humanoid of VRMC_vrm (1.0) or VRM (0.x) in Scene::extensions, whose nodes are joint numbers there; nothing if
/// the scene has none. What is malformed is named in `report`, by JSON path, and left out.
std::optional<VrmHumanoid> read_vrm_humanoid(const Scene& scene, Report& report);

}  // namespace bendy::converter
