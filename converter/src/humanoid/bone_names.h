#pragma once

#include "humanoid.h"

#include <cstdint>
#include <optional>
#include <string_view>

namespace bendy::converter {

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

}  // namespace bendy::converter
