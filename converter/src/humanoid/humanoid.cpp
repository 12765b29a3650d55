#include "humanoid.h"

#include <algorithm>

namespace bendy::converter {
namespace {

constexpr std::array<std::string_view, kHumanBones> kVrmNames{"hips",
                                                              "spine",
                                                              "chest",
                                                              "upperChest",
                                                              "neck",
                                                              "head",
                                                              "leftShoulder",
                                                              "leftUpperArm",
                                                              "leftLowerArm",
                                                              "leftHand",
                                                              "leftThumbProximal",
                                                              "leftUpperLeg",
                                                              "leftLowerLeg",
                                                              "leftFoot",
                                                              "leftToes",
                                                              "rightShoulder",
                                                              "rightUpperArm",
                                                              "rightLowerArm",
                                                              "rightHand",
                                                              "rightThumbProximal",
                                                              "rightUpperLeg",
                                                              "rightLowerLeg",
                                                              "rightFoot",
                                                              "rightToes"};

}  // namespace

std::string_view vrm_name(HumanBone bone) {
    return kVrmNames[static_cast<std::size_t>(bone)];
}

std::optional<HumanBone> bone_of_vrm_name(std::string_view name) {
    const auto* const found = std::find(kVrmNames.begin(), kVrmNames.end(), name);
    if (found == kVrmNames.end()) return std::nullopt;
    return static_cast<HumanBone>(found - kVrmNames.begin());
}

}  // namespace bendy::converter
