#include "rigging/humanoid/find_roles.h"

#include "humanoid_gltf.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/format/document.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace bendy::converter::find_roles_test {
namespace {

using namespace test;

/// Role, with its place if it is a chain, to the joint's name.
using Roles = std::map<std::string, std::string>;

Roles roles_of(Scene scene) {
    Report unheard;
    find_roles(scene, kNone, unheard);
    Report report;
    EXPECT_TRUE(validate(build_chunks(scene, "test", report)).empty());
    Roles roles;
    for (const RoleRecord& record : scene.roles) {
        std::string word(kValueNames<Role>.at(record.role));
        if (record.role >= static_cast<std::uint16_t>(kFirstChainRole)) word += std::to_string(record.place);
        roles[word] = scene.joints[record.joint].name;
    }
    return roles;
}
Roles roles_of(const Gltf& gltf) {
    return roles_of(*gltf.import());
}
Roles roles_of(const HumanoidGltf& character) {
    return roles_of(character.build());
}

/// `leftUpperArm` of `left_upper_arm`.
std::string camel(std::string_view word) {
    std::string name;
    bool starts = false;
    for (const char c : word) {
        if (c != '_') name += starts ? static_cast<char>(c - 'a' + 'A') : c;
        starts = c == '_';
    }
    return name;
}

/// The roles of a character whose joints have VRM's names, or `names`.
Roles expected(const HumanoidGltf& character) {
    Roles roles;
    for (const std::string_view word : kValueNames<Role>) {
        for (const HumanoidGltf::Bone& bone : character.bones) {
            if (bone.name != camel(word)) continue;
            const auto renamed = character.names.find(bone.name);
            roles[std::string(word)] = renamed == character.names.end() ? bone.name : renamed->second;
        }
    }
    return roles;
}

/// With three joints for each finger, eyes and a jaw.
HumanoidGltf make_whole() {
    HumanoidGltf human;
    human.add("upperChest", "chest", {0, 1.4, 0});
    human["neck"].parent = "upperChest";
    human.add("jaw", "head", {0, 1.62, 0.05});
    for (const double side : {1.0, -1.0}) {
        const std::string s = side > 0 ? "left" : "right";
        human[s + "Shoulder"].parent = "upperChest";
        human.add(s + "Eye", "head", {side * 0.03, 1.7, 0.08});
        for (int finger = 0; finger < 5; ++finger) {
            const bool is_thumb = finger == 0;
            constexpr std::array kNames{"Thumb", "Index", "Middle", "Ring", "Little"};
            const std::array joints{is_thumb ? "Metacarpal" : "Proximal", is_thumb ? "Proximal" : "Intermediate",
                                    "Distal"};
            std::string parent = s + "Hand";
            for (std::size_t k = 0; k < joints.size(); ++k) {
                const std::string name = s + kNames.at(static_cast<std::size_t>(finger)) + joints.at(k);
                human.add(name, parent, {side * (0.85 + 0.03 * static_cast<double>(k)), 1.45, 0.04 - 0.02 * finger});
                parent = name;
            }
        }
    }
    return human;
}

/// How a tool names joints: `%` is the side, and the words of a finger's joints are those of `finger` and `numbers`.
struct Convention {
    const char* tool;
    std::array<const char*, 2> sides;
    std::map<std::string, std::string> middle;
    std::map<std::string, std::string> limbs;
    std::string finger;  ///< `@` is the finger, `#` its joint
    std::array<const char*, 5> fingers;
    std::array<const char*, 3> numbers;
};

std::string replaced(std::string text, char mark, const std::string& by) {
    if (const std::size_t at = text.find(mark); at != std::string::npos) text.replace(at, 1, by);
    return text;
}

void rename(HumanoidGltf& human, const Convention& convention) {
    for (const auto& [bone, name] : convention.middle) human.names[bone] = name;
    for (const std::size_t side : {0u, 1u}) {
        const std::string s = side == 0 ? "left" : "right";
        for (const auto& [bone, name] : convention.limbs)
            human.names[s + bone] = replaced(name, '%', convention.sides[side]);
        constexpr std::array kFingers{"Thumb", "Index", "Middle", "Ring", "Little"};
        for (std::size_t f = 0; f < kFingers.size(); ++f) {
            const std::array joints{f == 0 ? "Metacarpal" : "Proximal", f == 0 ? "Proximal" : "Intermediate", "Distal"};
            for (std::size_t k = 0; k < joints.size(); ++k) {
                std::string name = replaced(convention.finger, '%', convention.sides[side]);
                name = replaced(replaced(name, '@', convention.fingers[f]), '#', convention.numbers[k]);
                human.names[s + kFingers.at(f) + joints.at(k)] = name;
            }
        }
    }
}

const std::vector<Convention> kConventions{{"Mixamo",
                                            {"Left", "Right"},
                                            {{"hips", "mixamorig:Hips"},
                                             {"spine", "mixamorig:Spine"},
                                             {"chest", "mixamorig:Spine1"},
                                             {"upperChest", "mixamorig:Spine2"},
                                             {"neck", "mixamorig:Neck"},
                                             {"head", "mixamorig:Head"}},
                                            {{"Shoulder", "mixamorig:%Shoulder"},
                                             {"UpperArm", "mixamorig:%Arm"},
                                             {"LowerArm", "mixamorig:%ForeArm"},
                                             {"Hand", "mixamorig:%Hand"},
                                             {"UpperLeg", "mixamorig:%UpLeg"},
                                             {"LowerLeg", "mixamorig:%Leg"},
                                             {"Foot", "mixamorig:%Foot"},
                                             {"Toes", "mixamorig:%ToeBase"},
                                             {"Eye", "mixamorig:%Eye"}},
                                            "mixamorig:%Hand@#",
                                            {"Thumb", "Index", "Middle", "Ring", "Pinky"},
                                            {"1", "2", "3"}},
                                           {"Unreal",
                                            {"l", "r"},
                                            {{"hips", "pelvis"},
                                             {"spine", "spine_01"},
                                             {"chest", "spine_02"},
                                             {"upperChest", "spine_03"},
                                             {"neck", "neck_01"},
                                             {"head", "head"}},
                                            {{"Shoulder", "clavicle_%"},
                                             {"UpperArm", "upperarm_%"},
                                             {"LowerArm", "lowerarm_%"},
                                             {"Hand", "hand_%"},
                                             {"UpperLeg", "thigh_%"},
                                             {"LowerLeg", "calf_%"},
                                             {"Foot", "foot_%"},
                                             {"Toes", "ball_%"},
                                             {"Eye", "eye_%"}},
                                            "@_#_%",
                                            {"thumb", "index", "middle", "ring", "pinky"},
                                            {"01", "02", "03"}},
                                           {"Rigify",
                                            {"L", "R"},
                                            {{"hips", "DEF-spine"},
                                             {"spine", "DEF-spine.001"},
                                             {"chest", "DEF-spine.002"},
                                             {"upperChest", "DEF-spine.003"},
                                             {"neck", "DEF-spine.004"},
                                             {"head", "DEF-spine.006"}},
                                            {{"Shoulder", "DEF-shoulder.%"},
                                             {"UpperArm", "DEF-upper_arm.%"},
                                             {"LowerArm", "DEF-forearm.%"},
                                             {"Hand", "DEF-hand.%"},
                                             {"UpperLeg", "DEF-thigh.%"},
                                             {"LowerLeg", "DEF-shin.%"},
                                             {"Foot", "DEF-foot.%"},
                                             {"Toes", "DEF-toe.%"},
                                             {"Eye", "DEF-eye.%"}},
                                            "DEF-@.#.%",
                                            {"thumb", "f_index", "f_middle", "f_ring", "f_pinky"},
                                            {"01", "02", "03"}},
                                           {"Biped",
                                            {"L", "R"},
                                            {{"hips", "Bip01 Pelvis"},
                                             {"spine", "Bip01 Spine"},
                                             {"chest", "Bip01 Spine1"},
                                             {"upperChest", "Bip01 Spine2"},
                                             {"neck", "Bip01 Neck"},
                                             {"head", "Bip01 Head"}},
                                            {{"Shoulder", "Bip01 % Clavicle"},
                                             {"UpperArm", "Bip01 % UpperArm"},
                                             {"LowerArm", "Bip01 % Forearm"},
                                             {"Hand", "Bip01 % Hand"},
                                             {"UpperLeg", "Bip01 % Thigh"},
                                             {"LowerLeg", "Bip01 % Calf"},
                                             {"Foot", "Bip01 % Foot"},
                                             {"Toes", "Bip01 % Toe0"},
                                             {"Eye", "Bip01 % Eye"}},
                                            "Bip01 % Finger@#",
                                            {"0", "1", "2", "3", "4"},
                                            {"", "1", "2"}},
                                           {"CMU",
                                            {"Left", "Right"},
                                            {{"hips", "Hips"},
                                             {"spine", "LowerBack"},
                                             {"chest", "Spine"},
                                             {"upperChest", "Spine1"},
                                             {"neck", "Neck1"},
                                             {"head", "Head"}},
                                            {{"Shoulder", "%Shoulder"},
                                             {"UpperArm", "%Arm"},
                                             {"LowerArm", "%ForeArm"},
                                             {"Hand", "%Hand"},
                                             {"UpperLeg", "%UpLeg"},
                                             {"LowerLeg", "%Leg"},
                                             {"Foot", "%Foot"},
                                             {"Toes", "%ToeBase"},
                                             {"Eye", "%Eye"}},
                                            "%Hand@#",
                                            {"Thumb", "Index", "Middle", "Ring", "Pinky"},
                                            {"1", "2", "3"}},
                                           {"Quaternius",
                                            {"L", "R"},
                                            {{"hips", "Hips"},
                                             {"spine", "Abdomen"},
                                             {"chest", "Torso"},
                                             {"upperChest", "Chest"},
                                             {"neck", "Neck"},
                                             {"head", "Head"}},
                                            {{"Shoulder", "Shoulder.%"},
                                             {"UpperArm", "UpperArm.%"},
                                             {"LowerArm", "LowerArm.%"},
                                             {"Hand", "Palm.%"},
                                             {"UpperLeg", "UpperLeg.%"},
                                             {"LowerLeg", "LowerLeg.%"},
                                             {"Foot", "Foot.%"},
                                             {"Toes", "Toes.%"},
                                             {"Eye", "Eye.%"}},
                                            "@#.%",
                                            {"Thumb", "Index", "Middle", "Ring", "Pinky"},
                                            {"1", "2", "3"}},
                                           {"Daz",
                                            {"l", "r"},
                                            {{"hips", "hip"},
                                             {"spine", "abdomenLower"},
                                             {"chest", "abdomenUpper"},
                                             {"upperChest", "chestLower"},
                                             {"neck", "neckLower"},
                                             {"head", "head"}},
                                            {{"Shoulder", "%Collar"},
                                             {"UpperArm", "%ShldrBend"},
                                             {"LowerArm", "%ForearmBend"},
                                             {"Hand", "%Hand"},
                                             {"UpperLeg", "%ThighBend"},
                                             {"LowerLeg", "%Shin"},
                                             {"Foot", "%Foot"},
                                             {"Toes", "%Toe"},
                                             {"Eye", "%Eye"}},
                                            "%@#",
                                            {"Thumb", "Index", "Mid", "Ring", "Pinky"},
                                            {"1", "2", "3"}}};

TEST(FindRoles, ByTheNamesThatToolsGive) {
    for (const Convention& convention : kConventions) {
        HumanoidGltf human = make_whole();
        rename(human, convention);
        EXPECT_EQ(roles_of(human), expected(human)) << convention.tool;
    }
}

TEST(FindRoles, InAPoseOfAnyKindAndFacingAnyWay) {
    HumanoidGltf human = make_whole();
    rename(human, kConventions[1]);
    for (const double side : {1.0, -1.0}) {  // arms down
        const std::string s = side > 0 ? "left" : "right";
        for (HumanoidGltf::Bone& bone : human.bones) {
            const double out = side * bone.position.x - 0.2;
            if (out > 0 && bone.position.y > 1.3)
                bone.position = {side * (0.2 + 0.2 * out), bone.position.y - out, bone.position.z};
        }
    }
    for (const double turn : {0.0, 1.0, 3.0}) {
        HumanoidGltf turned = human;
        const glm::dquat about_y = glm::angleAxis(turn, glm::dvec3(0, 1, 0));
        turned.move([&](glm::dvec3 p) { return about_y * p; });
        EXPECT_EQ(roles_of(turned), expected(turned)) << turn;
    }
}

/// Turns what is above the hips forward, and lets arms hang from there.
HumanoidGltf bent_forward(HumanoidGltf human, double degrees, double arm_length = 1.0) {
    const glm::dquat lean = glm::angleAxis(degrees * kTestDegree, glm::dvec3(1, 0, 0));
    human.move([&](glm::dvec3 p) {
        if (p.y <= 1.0) return p;
        const double out = std::max(std::abs(p.x) - 0.2, 0.0);
        const glm::dvec3 at(std::copysign(std::abs(p.x) - out, p.x), p.y - 1.0, p.z);
        return glm::dvec3(0, 1, 0) + lean * at - glm::dvec3(0, arm_length * out, 0);
    });
    return human;
}

TEST(FindRoles, ClearNamesAreEnoughHoweverTheBodyRests) {
    const HumanoidGltf whole = bent_forward(make_whole(), 80.0);
    EXPECT_EQ(roles_of(whole), expected(whole));
    Scene with_skin = *whole.build().import();
    bind_at_rest(with_skin);
    EXPECT_EQ(roles_of(with_skin), expected(whole)) << "it has thumbs";
    const HumanoidGltf no_fingers = bent_forward(HumanoidGltf(), 80.0);
    EXPECT_EQ(roles_of(no_fingers), expected(no_fingers));
    Scene bound = *no_fingers.build().import();
    bind_at_rest(bound);
    EXPECT_EQ(roles_of(bound), Roles()) << "it was made for this pose";
}

TEST(FindRoles, OnAllFoursAHumanHasThumbs) {
    constexpr double kToTheGround = 1.6;
    const HumanoidGltf whole = bent_forward(make_whole(), 90.0, kToTheGround);
    EXPECT_EQ(roles_of(whole), expected(whole));
    const Roles animal = roles_of(bent_forward(HumanoidGltf(), 90.0, kToTheGround));
    EXPECT_EQ(animal.count("left_front_leg0"), 1u);
    EXPECT_EQ(animal.count("left_upper_arm"), 0u);
}

TEST(FindRoles, VrmSaysThem) {
    HumanoidGltf human = make_whole();
    EXPECT_EQ(roles_of(human.build_vrm()), expected(human));
    HumanoidGltf odd = make_whole();  // what VRM says is not doubted
    odd.names["hips"] = "left hand";
    EXPECT_EQ(roles_of(odd.build_vrm()), expected(odd));
}

TEST(FindRoles, OldVrmNamesTheThumbAsTheFingers) {
    HumanoidGltf human;
    human.add("leftThumbProximal", "leftHand", {0.8, 1.45, 0});
    human.add("leftThumbIntermediate", "leftThumbProximal", {0.83, 1.45, 0});
    human.add("leftThumbDistal", "leftThumbIntermediate", {0.86, 1.45, 0});
    human.move([](glm::dvec3 p) { return glm::dvec3(-p.x, p.y, -p.z); });
    const Roles roles = roles_of(human.build_vrm(true));
    EXPECT_EQ(roles.at("left_thumb_metacarpal"), "leftThumbProximal");
    EXPECT_EQ(roles.at("left_thumb_proximal"), "leftThumbIntermediate");
    EXPECT_EQ(roles.at("left_thumb_distal"), "leftThumbDistal");
    EXPECT_EQ(roles.at("right_lower_leg"), "rightLowerLeg");
}

TEST(FindRoles, ByShapeWhereNamesSayNothing) {
    HumanoidGltf human;
    std::size_t number = 0;
    for (const HumanoidGltf::Bone& bone : human.bones) human.names[bone.name] = "Bone" + std::to_string(number++);
    EXPECT_EQ(roles_of(human), expected(human));
}

TEST(FindRoles, AFootOfItsOwnRigIsTheFoot) {
    HumanoidGltf human;
    for (const char* foot : {"leftFoot", "rightFoot"}) human[foot].parent = "hips";
    rename(human, kConventions[5]);
    EXPECT_EQ(roles_of(human).at("left_foot"), "Foot.L");
}

/// A robot's leg may end in a part of the foot, while the foot itself hangs on nothing.
TEST(FindRoles, OfTwoFeetInOnePlaceTheFootMovesMore) {
    HumanoidGltf robot;
    for (const std::string side : {"left", "right"}) {
        std::erase_if(robot.bones, [&](const HumanoidGltf::Bone& bone) { return bone.name == side + "Toes"; });
        robot.add(side + "FootPlate", "", robot[side + "Foot"].position);
    }
    Scene scene = *robot.build().import();
    bind_at_rest(scene);
    for (const bool is_plate : {false, true}) {
        for (const std::string side : {"left", "right"}) {
            const std::uint32_t most = joint_named(scene, side + (is_plate ? "FootPlate" : "Foot"));
            scene.meshes[0].bones[side == "left" ? 0 : 1] = most;
        }
        const Roles roles = roles_of(scene);
        EXPECT_EQ(roles.at("left_foot"), is_plate ? "leftFootPlate" : "leftFoot");
        EXPECT_EQ(roles.at("right_foot"), is_plate ? "rightFootPlate" : "rightFoot");
    }
}

TEST(FindRoles, AHandThatBranchesIsTheMiddle) {
    HumanoidGltf robot;
    for (const double side : {1.0, -1.0}) {
        const std::string s = side > 0 ? "left" : "right";
        robot.add(s + "Index", s + "LowerArm", {side * 0.75, 1.45, 0.04});
        robot.add(s + "Index2", s + "Index", {side * 0.8, 1.45, 0.04});
        robot.add(s + "Thumb", s + "LowerArm", {side * 0.75, 1.45, 0.08});
        robot.add(s + "Palm2", s + "LowerArm", {side * 0.75, 1.45, 0});
        robot.add(s + "Middle", s + "Palm2", {side * 0.8, 1.45, 0});
    }
    std::erase_if(robot.bones, [](const HumanoidGltf::Bone& bone) { return bone.name.ends_with("Hand"); });
    const Roles roles = roles_of(robot);
    EXPECT_EQ(roles.at("left_hand"), "leftPalm2");
    EXPECT_EQ(roles.at("right_hand"), "rightPalm2");
    EXPECT_EQ(roles.at("left_index_proximal"), "leftIndex");
    EXPECT_EQ(roles.at("left_index_intermediate"), "leftIndex2");
    EXPECT_EQ(roles.at("left_middle_proximal"), "leftMiddle");
    // Without a palm there is no hand.
    for (const char* middle : {"leftMiddle", "rightMiddle"})
        robot[middle].parent = std::string(middle).replace(std::string(middle).size() - 6, 6, "LowerArm");
    std::erase_if(robot.bones, [](const HumanoidGltf::Bone& bone) { return bone.name.ends_with("Palm2"); });
    EXPECT_EQ(roles_of(robot).count("left_hand"), 0u);
}

TEST(FindRoles, HipsCarryTheLegsAndTheSpine) {
    HumanoidGltf human;
    human.bones.insert(human.bones.begin(), {"body", "", {0, 1, 0}});
    human["hips"].parent = "body";
    for (const char* leg : {"leftUpperLeg", "rightUpperLeg"}) human[leg].parent = "body";
    const Roles roles = roles_of(human);
    EXPECT_EQ(roles.at("hips"), "body");
    EXPECT_EQ(roles.at("spine"), "spine");
    // A root on the ground is not the hips.
    human["body"].position = {0, 0, 0};
    EXPECT_EQ(roles_of(human).at("hips"), "hips");
}

TEST(FindRoles, TheThighIsTheJointAboveTheKnee) {
    for (const double out : {0.0, 0.1}) {  // CMU's dummy joint is in the hips, or has a length
        HumanoidGltf human;
        for (const double side : {1.0, -1.0}) {
            const std::string s = side > 0 ? "left" : "right";
            human.add(s + "Dummy", "hips", {side * out, 0.97, 0});
            human[s + "UpperLeg"].parent = s + "Dummy";
            human.names[s + "Dummy"] = side > 0 ? "LHipJoint" : "RHipJoint";
            human.names[s + "UpperLeg"] = side > 0 ? "LeftHip" : "RightHip";
            human.names[s + "LowerLeg"] = side > 0 ? "LeftKnee" : "RightKnee";
        }
        const Roles roles = roles_of(human);
        EXPECT_EQ(roles.at("left_upper_leg"), "LeftHip");
        EXPECT_EQ(roles.at("right_upper_leg"), "RightHip");
        EXPECT_EQ(roles.at("hips"), "hips");
    }
}

TEST(FindRoles, PartsOfTheBodyMayHangOnControlsBesideTheSpine) {
    HumanoidGltf human;
    human.bones.insert(human.bones.begin(), {"upper_ctrl", "", {0, 1.3, 0}});
    for (const char* side : {"left", "right"}) {
        human[std::string(side) + "UpperArm"].parent = "upper_ctrl";
        std::erase_if(human.bones,
                      [&](const HumanoidGltf::Bone& bone) { return bone.name == std::string(side) + "Shoulder"; });
    }
    Roles roles = roles_of(human);
    EXPECT_EQ(roles.at("left_upper_arm"), "leftUpperArm");
    EXPECT_EQ(roles.at("chest"), "chest");
    human["spine"].parent = "upper_ctrl";  // and so does the spine
    roles = roles_of(human);
    EXPECT_EQ(roles.at("hips"), "hips");
    EXPECT_EQ(roles.at("spine"), "spine");
    EXPECT_EQ(roles.at("right_hand"), "rightHand");
    human["upper_ctrl"].position.x = 3.0;
    for (const char* side : {"left", "right"}) {
        for (const char* bone : {"UpperArm", "LowerArm", "Hand"})
            human[std::string(side) + bone].position.x += 3.0;  // arms of something else
    }
    EXPECT_EQ(roles_of(human), Roles());
}

TEST(FindRoles, ARobotMayHaveNoArms) {
    HumanoidGltf robot;
    std::erase_if(robot.bones, [](const HumanoidGltf::Bone& bone) {
        return bone.name.find("Arm") != std::string::npos || bone.name.find("Hand") != std::string::npos ||
               bone.name.find("Shoulder") != std::string::npos;
    });
    Roles roles = roles_of(robot);
    EXPECT_EQ(roles.at("hips"), "hips");
    EXPECT_EQ(roles.at("spine"), "spine");
    EXPECT_EQ(roles.at("chest"), "chest");
    EXPECT_EQ(roles.at("neck"), "neck");
    EXPECT_EQ(roles.at("left_toes"), "leftToes");
    // A head on two legs is anything.
    std::erase_if(robot.bones, [](const HumanoidGltf::Bone& bone) {
        return bone.name == "spine" || bone.name == "chest" || bone.name == "neck";
    });
    robot["head"].parent = "hips";
    EXPECT_EQ(roles_of(robot), Roles());
}

/// A toy whose limbs have one joint each, and a mesh whose legs go this way.
/// \param unknown  a bone whose name says nothing
Scene make_toy(const glm::vec3& leg, const std::string& unknown = "") {
    HumanoidGltf toy;
    std::erase_if(toy.bones, [](const HumanoidGltf::Bone& bone) {
        const auto has = [&](const char* word) { return bone.name.find(word) != std::string::npos; };
        return has("Lower") || has("Hand") || has("Foot") || has("Toes") || has("Shoulder") || has("chest") ||
               has("neck");
    });
    for (const std::string side : {"left", "right"}) {
        toy.names[side + "UpperArm"] = side + "Arm";
        toy.names[side + "UpperLeg"] = side + "Leg";
        toy[side + "UpperArm"].parent = "spine";
    }
    toy["head"].parent = "spine";
    if (!unknown.empty()) toy.names[unknown] = "thing";
    Scene scene = *toy.build().import();
    bind_at_rest(scene);
    Mesh& mesh = scene.meshes[0];
    const RestFrames rest(scene);
    for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
        if (!scene.joints[joint].name.ends_with("Leg") || leg == glm::vec3(0.0f)) continue;
        mesh.positions.emplace_back(glm::vec3(rest.position(joint)) + leg);
        mesh.bones.push_back(static_cast<std::uint16_t>(joint));
        mesh.weights.push_back(1.0f);
    }
    return scene;
}

/// Where its arms point, joints do not say: they have no roles.
TEST(FindRoles, LimbsOfAToyHaveOneJoint) {
    const glm::vec3 down(0.0f, -0.9f, 0.05f);
    EXPECT_EQ(roles_of(make_toy(down)), (Roles{{"hips", "hips"},
                                               {"spine", "spine"},
                                               {"head", "head"},
                                               {"left_upper_leg", "leftLeg"},
                                               {"right_upper_leg", "rightLeg"}}));
    EXPECT_EQ(roles_of(make_toy({0.0f, 0.0f, -0.9f})), Roles()) << "its legs go backward";
    EXPECT_EQ(roles_of(make_toy({0.0f, 0.0f, 0.0f})), Roles()) << "nothing shows where its legs go";
    for (const char* unknown : {"rightUpperArm", "leftUpperLeg"}) EXPECT_EQ(roles_of(make_toy(down, unknown)), Roles());
}

TEST(FindRoles, TailsAndWingsOfAHuman) {
    HumanoidGltf demon;
    demon.add("tail1", "hips", {0, 0.95, -0.1});
    demon.add("tail2", "tail1", {0, 0.85, -0.2});
    demon.add("ponyTail", "head", {0, 1.7, -0.1});
    demon.add("wing_L", "chest", {0.1, 1.4, -0.1});
    demon.add("wing_R", "chest", {-0.1, 1.4, -0.1});
    const Roles roles = roles_of(demon);
    EXPECT_EQ(roles.at("tail0"), "tail1");
    EXPECT_EQ(roles.at("tail1"), "tail2");
    EXPECT_EQ(roles.at("left_wing0"), "wing_L");
    EXPECT_EQ(roles.at("right_wing0"), "wing_R");
    EXPECT_EQ(roles.count("tail2"), 0u);
}

TEST(FindRoles, AnAnimalHasChains) {
    const Roles roles = roles_of(make_quadruped());
    EXPECT_EQ(roles.at("hips"), "hips");
    EXPECT_EQ(roles.at("head"), "head");
    EXPECT_EQ(roles.at("spine_chain0"), "spine");
    EXPECT_EQ(roles.at("neck_chain0"), "neck");
    EXPECT_EQ(roles.at("left_front_leg0"), "leftUpperArm");
    EXPECT_EQ(roles.at("right_hind_leg1"), "rightLowerLeg");
    EXPECT_EQ(roles.at("right_hind_leg3"), "rightToes") << "down to the hoof, paw or claw";
    EXPECT_EQ(roles.count("left_upper_arm"), 0u);
}

TEST(FindRoles, APawMayHangOnJointsOfAnIkRig) {
    HumanoidGltf animal = make_quadruped();
    for (const double side : {1.0, -1.0}) {
        const std::string s = side > 0 ? "left" : "right";
        animal.add(s + "Pole", "", {side * 0.1, 0.3, 1.0});
        animal.add(s + "Ik", "", animal[s + "Hand"].position);
        animal.add(s + "Paw", s + "Ik", {side * 0.1, 0.0, 0.4});
    }
    Scene scene = *animal.build().import();
    Mesh mesh;
    mesh.influences = 1;
    for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
        if (!scene.joints[joint].name.ends_with("Hand") && !scene.joints[joint].name.ends_with("Pole"))
            mesh.palette.joints.push_back(joint);
    }
    const std::size_t count = mesh.palette.joints.size();
    mesh.palette.inverse_bind.assign(count, glm::mat4(1.0f));
    mesh.positions.assign(count, glm::vec3(0.0f));
    mesh.weights.assign(count, 1.0f);
    for (std::uint32_t bone = 0; bone < count; ++bone) mesh.bones.push_back(bone);
    scene.meshes.push_back(mesh);
    Roles roles = roles_of(scene);
    EXPECT_EQ(roles.at("left_front_leg1"), "leftLowerArm");
    EXPECT_EQ(roles.at("left_front_leg2"), "leftIk");
    EXPECT_EQ(roles.at("right_front_leg3"), "rightPaw");
    EXPECT_EQ(roles.at("left_hind_leg2"), "leftFoot");
    // If the leg's own end moves vertices, it is the foot.
    scene.meshes[0].palette.joints[0] = joint_named(scene, "leftHand");
    roles = roles_of(scene);
    EXPECT_EQ(roles.at("left_front_leg2"), "leftHand");
    EXPECT_EQ(roles.at("right_front_leg2"), "rightIk");
}

TEST(FindRoles, ABirdHasWings) {
    HumanoidGltf bird;
    for (const char* side : {"left", "right"}) {
        const std::string s = side;
        const std::string mark = s == "left" ? "_L" : "_R";
        bird.names[s + "UpperArm"] = "wing" + mark;
        bird.names[s + "LowerArm"] = "wing.001" + mark;
        bird.names[s + "Hand"] = "wing.002" + mark;
        bird.add(s + "Arch", s + "Foot", 0.5 * (bird[s + "Foot"].position + bird[s + "Toes"].position));
        bird[s + "Toes"].parent = s + "Arch";
        bird.add("wing_feather" + mark, s + "UpperArm", bird[s + "LowerArm"].position - glm::dvec3(0, 0, 0.2));
    }
    const Roles roles = roles_of(bird);
    EXPECT_EQ(roles.at("left_wing0"), "wing_L");
    EXPECT_EQ(roles.at("right_wing2"), "wing.002_R");
    EXPECT_EQ(roles.at("left_hind_leg1"), "leftLowerLeg");
    EXPECT_EQ(roles.at("left_hind_leg3"), "leftArch");
    EXPECT_EQ(roles.at("left_hind_leg4"), "leftToes");
    EXPECT_EQ(roles.count("left_wing3"), 0u);
    EXPECT_EQ(roles.at("head"), "head");
    EXPECT_EQ(roles.count("left_upper_leg"), 0u);
}

TEST(FindRoles, AWrongRoleIsWorseThanNone) {
    const auto without = [](std::initializer_list<const char*> names) {
        HumanoidGltf human;
        std::erase_if(human.bones, [&](const HumanoidGltf::Bone& bone) {
            return std::find(names.begin(), names.end(), bone.name) != names.end();
        });
        for (HumanoidGltf::Bone& bone : human.bones) {
            if (std::find(names.begin(), names.end(), bone.parent) != names.end()) bone.parent = "hips";
        }
        return human;
    };
    EXPECT_EQ(roles_of(without({"leftUpperLeg", "leftLowerLeg", "leftFoot", "leftToes"})), Roles());
    EXPECT_EQ(roles_of(without({"rightUpperArm", "rightLowerArm", "rightHand"})), Roles());
    EXPECT_EQ(roles_of(without({"head", "neck"})), Roles());
    HumanoidGltf swapped;  // the toes say that left is right
    for (const char* toes : {"leftToes", "rightToes"}) swapped[toes].position.z = -0.15;
    EXPECT_EQ(roles_of(swapped), Roles());
    HumanoidGltf headless;
    headless["head"].parent = "";
    EXPECT_EQ(roles_of(headless), Roles());
    HumanoidGltf prop;
    prop.bones.resize(1);
    EXPECT_EQ(roles_of(prop), Roles());
}

/// A human, and one two metres beside it whose joints have names of the same meaning; each below a root of its own.
HumanoidGltf two_humans() {
    HumanoidGltf both;
    both["hips"].parent = "first";
    for (const HumanoidGltf::Bone& bone : std::vector(both.bones))
        both.add("b:" + bone.name, bone.name == "hips" ? "second" : "b:" + bone.parent,
                 bone.position + glm::dvec3(2, 0, 0));
    both.add("first", "", {});
    both.add("second", "", {2, 0, 0});
    return both;
}

TEST(FindRoles, OfTwoCharactersOneGetsThemAndAWarningNamesBoth) {
    Scene scene = *two_humans().build().import();
    Report report;
    find_roles(scene, kNone, report);
    const auto is_of_second = [&](const RoleRecord& record) {
        return scene.joints[record.joint].name.starts_with("b:");
    };
    EXPECT_GT(scene.roles.size(), 15u);
    EXPECT_TRUE(std::none_of(scene.roles.begin(), scene.roles.end(), is_of_second));
    const std::uint32_t hips = joint_named(scene, "b:hips");
    ASSERT_EQ(report.warnings().size(), 1u);
    const std::string text = report.warnings()[0].message;
    EXPECT_TRUE(text.starts_with("there are 2 characters, below the joints 'first' (#")) << text;
    EXPECT_NE(text.find(" and 'second' (#"), std::string::npos) << text;
    EXPECT_NE(text.find(": the roles are those of 'first' (#"), std::string::npos) << text;
    EXPECT_NE(text.find("{\"hips\": \"#" + std::to_string(hips) + "\"}"), std::string::npos) << text;

    // As a rig file says, whether the roles were stored before or not.
    for (int round = 0; round < 2; ++round) {
        Report silent;
        find_roles(scene, hips, silent);
        EXPECT_TRUE(std::all_of(scene.roles.begin(), scene.roles.end(), is_of_second));
        EXPECT_GT(scene.roles.size(), 15u);
        EXPECT_TRUE(silent.warnings().empty());
        scene.roles.clear();
    }
}

TEST(FindRoles, AHumanBesideAPropIsAlone) {
    HumanoidGltf human;
    human.add("chain0", "", {3, 0, 0});
    for (int k = 1; k < 20; ++k)
        human.add("chain" + std::to_string(k), "chain" + std::to_string(k - 1), {3, 0.1 * k, 0});
    Scene scene = *human.build().import();
    Report report;
    find_roles(scene, kNone, report);
    EXPECT_GT(scene.roles.size(), 15u);
    EXPECT_TRUE(report.warnings().empty());
}

TEST(FindRoles, WhatTheSceneHasStays) {
    Scene scene = *HumanoidGltf().build().import();
    scene.roles = {{3, static_cast<std::uint16_t>(Role::jaw), 0}};
    Report unheard;
    find_roles(scene, kNone, unheard);
    EXPECT_EQ(scene.roles.size(), 1u);
}

}  // namespace
}  // namespace bendy::converter::find_roles_test
