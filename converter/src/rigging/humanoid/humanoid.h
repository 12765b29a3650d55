#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/records.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace bendy::converter {

/// The bones of a human skeleton: the roles before the chains.
using HumanBone = Role;
inline constexpr std::size_t kHumanBones = static_cast<std::size_t>(kFirstChainRole);

/// The right-hand counterpart of a left bone. Left and right are the character's own.
constexpr HumanBone mirrored(HumanBone left) {
    const auto number = static_cast<std::size_t>(left);
    if (left == HumanBone::left_eye) return HumanBone::right_eye;
    return static_cast<HumanBone>(number + (left < HumanBone::left_thumb_metacarpal ? 4 : 15));
}
static_assert(mirrored(HumanBone::left_toes) == HumanBone::right_toes);
static_assert(mirrored(HumanBone::left_hand) == HumanBone::right_hand);
static_assert(mirrored(HumanBone::left_little_distal) == HumanBone::right_little_distal);

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
std::string vrm_name(HumanBone bone);

/// The bone with that name in VRM 1.0; nothing for unknown names.
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
    bool is_front_leg = false;       ///< the name is that of a front leg, as `FrontUpLeg`; the part is the arm's
};

/// The lower-case words and numbers of a joint's name, without a namespace: `mixamorig:LeftForeArm_010` has left, fore,
/// arm and 010. A name of more than 200 bytes has none.
class NameWords {
public:
    explicit NameWords(std::string_view name);

    /// Whether the name has the word, or the words in this order with nothing between them.
    [[nodiscard]] bool has(std::string_view word) const { return find(word) != std::string::npos; }
    /// The word after this one; empty if there is none.
    [[nodiscard]] std::string_view after(std::string_view word) const;
    [[nodiscard]] BodySide side() const;
    /// Returns true if a word marks a joint that is not a body part, such as a control, an end or a twist segment.
    [[nodiscard]] bool is_helper() const;
    /// The only word besides sides, prefixes and numbers; empty if there are several.
    [[nodiscard]] std::string_view only_word() const;

private:
    [[nodiscard]] std::size_t find(std::string_view word) const;

    std::string words_;  ///< with a space before, between and after them
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
