#include "rigging/humanoid/humanoid.h"

#include <gtest/gtest.h>

#include <string>

namespace bendy::converter::bone_names_test {
namespace {

constexpr BodySide kLeft = BodySide::left;
constexpr BodySide kRight = BodySide::right;
constexpr BodySide kMiddle = BodySide::none;

void expect(const char* name, BodyPart part, BodySide side) {
    const auto bone = read_bone_name(name);
    ASSERT_TRUE(bone.has_value()) << name;
    EXPECT_EQ(bone->part, part) << name;
    EXPECT_EQ(bone->side, side) << name;
}

TEST(BoneNames, AreReadAsToolsWriteThem) {
    expect("mixamorig:LeftArm", BodyPart::arm, kLeft);
    expect("mixamorig1_LeftArm", BodyPart::arm, kLeft);
    expect("mixamorig:RightUpLeg", BodyPart::upper_leg, kRight);
    expect("mixamorig:LeftForeArm", BodyPart::lower_arm, kLeft);
    expect("mixamorig:LeftHandThumb1", BodyPart::thumb, kLeft);
    expect("b_LeftLeg01_015", BodyPart::upper_leg, kLeft);
    expect("b_RightLeg02_020", BodyPart::lower_leg, kRight);
    expect("b_Hip_01", BodyPart::hips, kMiddle);
    expect("l_hip", BodyPart::upper_leg, kLeft);
    expect("lThighBend", BodyPart::upper_leg, kLeft);
    expect("rShldrBend", BodyPart::upper_arm, kRight);
    expect("CC_Base_L_Upperarm", BodyPart::upper_arm, kLeft);
    expect("DEF-upper_arm.L.001", BodyPart::upper_arm, kLeft);
    expect("Armature|Forearm.R", BodyPart::lower_arm, kRight);
    expect("UpperArm.L", BodyPart::upper_arm, kLeft);
    expect("Bip001 R Foot", BodyPart::foot, kRight);
    expect("spine_03", BodyPart::spine, kMiddle);
    expect("J_Bip_C_UpperChest", BodyPart::chest, kMiddle);
    expect("Palm2.L", BodyPart::hand, kLeft);
    EXPECT_EQ(read_bone_name("Palm2.L")->rank, 1);
    expect("rthigh", BodyPart::upper_leg, kRight);
    expect("lshldr", BodyPart::upper_arm, kLeft);
    expect("larm", BodyPart::arm, kLeft);
    expect("LHipJoint", BodyPart::upper_leg, kLeft);
    EXPECT_EQ(read_bone_name("LHipJoint")->rank, 1);
}

TEST(BoneNames, HelpersFingersAndOthersHaveNone) {
    for (const char* name : {"",
                             "root",
                             "ctl_LeftFoot",
                             "ik_hand_l",
                             "upperarm_twist_01_l",
                             "PoleTarget.L",
                             "Bip01 HeadNub",
                             "HeadTop_End",
                             "mixamorig:LeftHandIndex1",
                             "MCH-thigh.L",
                             "ORG-thigh.L",
                             "pelvis.L",
                             "foot",
                             "Head_L",
                             "LeftForeArmRoll",
                             "hand_l_weapon",
                             "Cube.001",
                             "LeftArmour",
                             "Spinebuster",
                             "b_Tail01_012",
                             "breast.L"}) {
        EXPECT_FALSE(read_bone_name(name).has_value()) << name;
    }
    EXPECT_FALSE(read_bone_name(std::string(100'000, 'L') + " hand").has_value());
}

}  // namespace
}  // namespace bendy::converter::bone_names_test
