#include "humanoid/auto_rig.h"

#include "humanoid_gltf.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/format/constraint.h>
#include <bendy/format/validate.h>

#include <gtest/gtest.h>

#include <array>

namespace bendy::converter {
namespace {

using namespace test;

struct Rigged {
    Scene scene;
    Report report;

    [[nodiscard]] std::uint32_t joint(const std::string& name) const { return joint_named(scene, name); }
    [[nodiscard]] const LimitRecord& limit(const std::string& name) const {
        static const LimitRecord kNothing;
        const Joint& joint = scene.joints[joint_named(scene, name)];
        if (joint.limits.size() == 1) return joint.limits[0];
        ADD_FAILURE() << name << " has " << joint.limits.size() << " limits";
        return kNothing;
    }
    [[nodiscard]] std::size_t limited() const {
        std::size_t count = 0;
        for (const Joint& joint : scene.joints) count += joint.limits.size();
        return count;
    }
    [[nodiscard]] bool proposes(std::string_view line) const {
        for (const std::string& proposal : report.proposals()) {
            if (proposal == line) return true;
        }
        return false;
    }
};

Rigged rig(Scene scene, const std::vector<bool>& claimed = {}) {
    Rigged result{std::move(scene), {}};
    auto_rig(result.scene, claimed, result.report);
    EXPECT_TRUE(validate(build_chunks(result.scene, "test", result.report)).empty());
    for (const Joint& joint : result.scene.joints) {
        for (const LimitRecord& limit : joint.limits) {
            EXPECT_EQ(limit.flags, kProposed) << joint.name;
            EXPECT_TRUE(holds_rest(limit)) << joint.name;
        }
    }
    return result;
}
Rigged rig(const Gltf& gltf) {
    return rig(*gltf.import());
}
Rigged rig(const HumanoidGltf& character) {
    return rig(character.build());
}

double low(const LimitRecord& limit, std::size_t axis) {
    return static_cast<double>(limit.rotation_min[axis]) / kTestDegree;
}
double high(const LimitRecord& limit, std::size_t axis) {
    return static_cast<double>(limit.rotation_max[axis]) / kTestDegree;
}
bool is_hinge(const LimitRecord& limit) {
    return limit.model == static_cast<std::uint8_t>(LimitModel::hinge);
}

TEST(AutoRig, ProposesChainsAndLimits) {
    const Rigged rigged = rig(HumanoidGltf());
    EXPECT_EQ(rigged.scene.chains.size(), 6u);
    for (const Chain& chain : rigged.scene.chains) EXPECT_EQ(chain.record.flags, kProposed);
    EXPECT_EQ(rigged.limited(), 20u);  // all but the hips
    EXPECT_EQ(rigged.report.proposals().size(), 26u);
    EXPECT_TRUE(rigged.proposes("chain LeftArm: leftUpperArm > leftLowerArm > leftHand, two_bone"));
    EXPECT_TRUE(rigged.proposes("leftLowerArm: hinge 0 to 150 degrees"));
    EXPECT_TRUE(rigged.report.warnings().empty());
}

// The test's joints have axes of no meaning: these look at where limbs go.
TEST(AutoRig, LimbsBendAsAHumansDo) {
    for (const double turn : {0.0, 1.0, 2.5}) {
        HumanoidGltf character;
        const glm::dquat about_y = glm::angleAxis(turn, glm::dvec3(0, 1, 0));
        character.move([&](glm::dvec3 p) { return about_y * p; });
        const Rigged rigged = rig(character);
        for (const std::string side : {"left", "right"}) {
            const double out = side == "left" ? 1.0 : -1.0;
            const auto goes = [&](const std::string& end, const std::string& joint, int axis, double degrees) {
                const auto at = [&](double angle) {
                    return moved(rigged.scene, rigged.joint(side + end), rigged.joint(side + joint), axis,
                                 angle * kTestDegree);
                };
                return glm::conjugate(about_y) * (at(degrees) - at(0));
            };
            const auto& elbow = rigged.limit(side + "LowerArm");
            const auto& knee = rigged.limit(side + "LowerLeg");
            ASSERT_TRUE(is_hinge(elbow) && is_hinge(knee));
            EXPECT_LT(glm::distance(goes("Hand", "LowerArm", 0, 90), {-0.25 * out, 0, 0.25}), 1e-5);  // forward
            EXPECT_LT(glm::distance(goes("Foot", "LowerLeg", 0, 90), {0, 0.4, -0.4}), 1e-5);          // backward
            EXPECT_LT(glm::distance(goes("Toes", "Foot", 1, high(rigged.limit(side + "Foot"), 1)), {0, 0, 0}), 0.2);
            EXPECT_LT(goes("Toes", "Foot", 1, high(rigged.limit(side + "Foot"), 1)).y, -0.05);  // to the ground
            EXPECT_NEAR(high(rigged.limit(side + "Foot"), 1), 50, 1e-3);

            const auto& hip = rigged.limit(side + "UpperLeg");
            EXPECT_GT(goes("LowerLeg", "UpperLeg", 1, low(hip, 1)).y, 0.45);  // 120 degrees: the knee above the hip
            EXPECT_GT(goes("LowerLeg", "UpperLeg", 1, low(hip, 1)).z, 0.3);
            EXPECT_NEAR(low(hip, 1), -120, 1e-3);
            const double apart = side == "left" ? high(hip, 2) : low(hip, 2);
            EXPECT_NEAR(std::abs(apart), 45, 1e-3);
            EXPECT_GT(out * goes("LowerLeg", "UpperLeg", 2, apart).x, 0.3);

            const auto& shoulder = rigged.limit(side + "UpperArm");
            const double raised = side == "left" ? high(shoulder, 2) : low(shoulder, 2);
            EXPECT_NEAR(std::abs(raised), 90, 1e-3);
            EXPECT_NEAR(goes("LowerArm", "UpperArm", 2, raised).y, 0.3, 1e-5);
            EXPECT_GT(goes("LowerArm", "UpperArm", 1, low(shoulder, 1)).z, 0.2);  // 135 degrees forward
            EXPECT_NEAR(low(shoulder, 1), -135, 1e-3);
            // The palm faces down: the hand bends further to it than away.
            const auto& wrist = rigged.limit(side + "Hand");
            const double to_palm = side == "left" ? low(wrist, 2) : high(wrist, 2);
            EXPECT_NEAR(std::abs(to_palm), 80, 1e-3);
            EXPECT_NEAR(low(wrist, 1), -20, 1e-3);
        }
    }
}

TEST(AutoRig, TheTrunkBendsForwardFurtherThanBack) {
    const Rigged rigged = rig(HumanoidGltf());
    const LimitRecord& spine = rigged.limit("spine");
    EXPECT_NEAR(low(spine, 1), -40, 1e-3);  // two joints share 80
    const glm::dvec3 bent =
        moved(rigged.scene, rigged.joint("neck"), rigged.joint("spine"), 1, low(spine, 1) * kTestDegree);
    EXPECT_GT(bent.z, 0.2);
    EXPECT_NEAR(high(rigged.limit("neck"), 0), 30, 1e-3);  // and two share 60
}

TEST(AutoRig, ABentElbowIsBentAlready) {
    HumanoidGltf character;
    character["leftHand"].position =
        character["leftLowerArm"].position + 0.25 * glm::dvec3(std::cos(1.0), 0, std::sin(1.0));
    character["rightHand"].position += glm::dvec3(0, 0, -0.02);  // 5 degrees the wrong way
    const Rigged rigged = rig(character);
    EXPECT_NEAR(low(rigged.limit("leftLowerArm"), 0), -1.0 / kTestDegree, 1e-3);
    EXPECT_NEAR(high(rigged.limit("leftLowerArm"), 0), 150 - 1.0 / kTestDegree, 1e-3);
    EXPECT_EQ(low(rigged.limit("rightLowerArm"), 0), 0);
    EXPECT_GT(high(rigged.limit("rightLowerArm"), 0), 150);
}

TEST(AutoRig, TheZeroOfAnAPoseIsMoved) {
    HumanoidGltf character;
    for (const double side : {1.0, -1.0}) {
        const std::string s = side > 0 ? "left" : "right";
        const glm::dvec3 down(side * std::sqrt(0.5), -std::sqrt(0.5), 0);
        character[s + "LowerArm"].position = character[s + "UpperArm"].position + 0.3 * down;
        character[s + "Hand"].position = character[s + "LowerArm"].position + 0.25 * down;
    }
    const Rigged rigged = rig(character);
    EXPECT_NEAR(low(rigged.limit("leftUpperArm"), 2), -95, 1e-3);
    EXPECT_NEAR(high(rigged.limit("leftUpperArm"), 2), 135, 1e-3);
    EXPECT_NEAR(high(rigged.limit("rightUpperArm"), 2), 95, 1e-3);
    const glm::dvec3 hand =
        moved(rigged.scene, rigged.joint("leftHand"), rigged.joint("leftLowerArm"), 0, 90 * kTestDegree);
    EXPECT_NEAR(hand.z, 0.25, 1e-5);
}

TEST(AutoRig, AKneeThatIsNoHumansGetsNoLimit) {
    HumanoidGltf bird;
    bird["leftLowerLeg"].position += glm::dvec3(0, 0, -0.2);
    const Rigged rigged = rig(bird);
    EXPECT_TRUE(rigged.scene.joints[rigged.joint("leftLowerLeg")].limits.empty());
    EXPECT_EQ(warned(rigged.report, "outside what a human can do"), 1u);
    EXPECT_TRUE(is_hinge(rigged.limit("rightLowerLeg")));
}

TEST(AutoRig, AFourLeggedAnimalGetsChainsOnly) {
    const Rigged rigged = rig(make_quadruped());
    EXPECT_NE(find_chain(rigged.scene, "LeftLeg"), nullptr);
    EXPECT_EQ(rigged.limited(), 0u);
    EXPECT_EQ(warned(rigged.report, "no limits proposed"), 1u);
}

TEST(AutoRig, LeftAndRightInterchangedGetNothing) {
    HumanoidGltf character;
    for (const char* foot : {"leftToes", "rightToes"}) character[foot].position.z *= -1;
    const Rigged rigged = rig(character);
    EXPECT_TRUE(rigged.scene.chains.empty());
    EXPECT_EQ(rigged.limited(), 0u);
    EXPECT_EQ(warned(rigged.report, "backward"), 1u);
}

TEST(AutoRig, WithoutNamesNothing) {
    HumanoidGltf character;
    for (std::size_t i = 0; i < character.bones.size(); ++i)
        character.names[character.bones[i].name] = "bone_" + std::to_string(i);
    const Rigged rigged = rig(character);
    EXPECT_TRUE(rigged.report.proposals().empty());
    EXPECT_EQ(warned(rigged.report, "nothing proposed"), 1u);
}

TEST(AutoRig, AVrmHumanoidNeedsNoNames) {
    HumanoidGltf character;
    Gltf gltf = character.build_vrm();
    for (std::size_t i = 0; i < gltf.json["nodes"].size(); ++i) gltf.json["nodes"][i]["name"] = "n" + std::to_string(i);
    const Rigged rigged = rig(gltf);
    EXPECT_EQ(rigged.scene.chains.size(), 6u);
    EXPECT_EQ(rigged.limited(), 20u);
}

TEST(AutoRig, LeavesWhatIsThere) {
    Scene scene = *HumanoidGltf().build().import();
    LimitRecord locked;
    locked.model = static_cast<std::uint8_t>(LimitModel::locked);
    locked.flags = kProposed;
    scene.joints[joint_named(scene, "leftLowerArm")].limits = {locked};
    Chain mine;
    mine.name = "LeftArm";
    scene.chains.push_back(mine);
    const Rigged rigged = rig(scene);
    EXPECT_EQ(rigged.limit("leftLowerArm").model, locked.model);
    EXPECT_EQ(rigged.scene.chains[0].record.effector, 0u);
    EXPECT_EQ(rigged.scene.chains.size(), 6u);
    EXPECT_EQ(rigged.report.proposals().size(), 24u);
}

TEST(AutoRig, ClaimedJointsStayFree) {
    const Scene scene = *HumanoidGltf().build().import();
    std::vector<bool> claimed(scene.joints.size());
    claimed[joint_named(scene, "leftLowerArm")] = true;
    const Rigged rigged = rig(scene, claimed);
    EXPECT_EQ(rigged.limited(), 19u);
    EXPECT_TRUE(rigged.scene.joints[rigged.joint("leftLowerArm")].limits.empty());
}

TEST(AutoRig, AFootThatAnIkRigMovesIsTheTarget) {
    HumanoidGltf character;
    character["leftFoot"].parent = "";
    const Rigged rigged = rig(character);
    const Chain* leg = find_chain(rigged.scene, "LeftLeg");
    ASSERT_NE(leg, nullptr);
    EXPECT_EQ(leg->record.effector, rigged.joint("leftLowerLeg"));
    EXPECT_EQ(leg->record.target, rigged.joint("leftFoot"));
    EXPECT_NEAR(std::hypot(leg->record.tip_offset[0], leg->record.tip_offset[1], leg->record.tip_offset[2]), 0.4, 1e-5);
    EXPECT_TRUE(is_hinge(rigged.limit("leftLowerLeg")));
}

/// One key that turns a joint about an axis of its limit's frame.
Scene with_clip(const std::string& name, int axis, double degrees) {
    const Rigged rigged = rig(HumanoidGltf());
    Scene scene = *HumanoidGltf().build().import();
    const std::uint32_t joint = joint_named(scene, name);
    const auto quaternion = [](const auto& q) { return glm::dquat(q[3], q[0], q[1], q[2]); };
    const glm::dquat frame = quaternion(rigged.limit(name).frame);
    glm::dvec3 about(0);
    about[axis] = 1;
    const glm::dquat q = quaternion(scene.joints[joint].rest.rotation) * frame *
                         glm::angleAxis(degrees * kTestDegree, about) * glm::conjugate(frame);
    Track track;
    track.path = TrackPath::rotation;
    track.target = joint;
    track.components = 4;
    track.times = {0.0f};
    track.values = {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z), static_cast<float>(q.w)};
    scene.cycles.push_back({"clip", false, {track}, {}});
    return scene;
}

TEST(AutoRig, LimitsHoldTheCharactersOwnClips) {
    const Rigged inside = rig(with_clip("leftLowerArm", 0, 140));
    EXPECT_TRUE(inside.proposes("leftLowerArm: hinge 0 to 150 degrees"));
    const Rigged near = rig(with_clip("leftLowerArm", 0, -20.5));
    EXPECT_TRUE(near.proposes("leftLowerArm: hinge -21 to 150 degrees, widened to its clips"));
    const Rigged far = rig(with_clip("leftLowerArm", 0, -50));
    EXPECT_TRUE(far.scene.joints[far.joint("leftLowerArm")].limits.empty());
    EXPECT_EQ(warned(far.report, "far beyond a human's"), 1u);
    const Rigged swung = rig(with_clip("leftUpperLeg", 1, 45));
    EXPECT_NEAR(high(swung.limit("leftUpperLeg"), 1), 45, 1.01);
}

TEST(AutoRig, AnElbowThatTwistsIsNoHinge) {
    const Rigged rigged = rig(with_clip("leftLowerArm", 2, 60));  // about the bone
    const LimitRecord& limit = rigged.limit("leftLowerArm");
    EXPECT_EQ(limit.model, static_cast<std::uint8_t>(LimitModel::swing_twist_ellipse));
    EXPECT_NEAR(high(limit, 0), 80, 1e-3);
    EXPECT_NEAR(high(limit, 2), 150, 1e-3);
    const glm::dvec3 bent =
        moved(rigged.scene, rigged.joint("leftHand"), rigged.joint("leftLowerArm"), 2, 90 * kTestDegree);
    EXPECT_NEAR(bent.z, 0.25, 1e-5);
}

TEST(AutoRig, StrangeScalesCrashNothing) {
    for (const double scale : {0.0, -1.0, 1e30, 1e-30}) {
        Gltf gltf = HumanoidGltf().build();
        for (Json& node : gltf.json["nodes"]) node["scale"] = {scale, 1, scale};
        (void)rig(gltf);
    }
}

struct Style {
    const char* name;
    std::map<std::string, std::string> names;
};

std::map<std::string, std::string> both_sides(std::map<std::string, std::string> names,
                                              const std::map<std::string, std::string>& limbs, const char* left,
                                              const char* right) {
    for (const auto& [bone, name] : limbs) {
        for (const bool is_left : {true, false}) {
            std::string text = name;
            const std::size_t mark = text.find('@');
            text.replace(mark, 1, is_left ? left : right);
            names[(is_left ? "left" : "right") + bone] = text;
        }
    }
    return names;
}

TEST(AutoRig, KnowsTheNamesOfManyTools) {
    const std::array styles{
        Style{"Mixamo", both_sides({{"hips", "mixamorig:Hips"},
                                    {"spine", "mixamorig:Spine"},
                                    {"chest", "mixamorig:Spine1"},
                                    {"neck", "mixamorig:Neck"},
                                    {"head", "mixamorig:Head"}},
                                   {{"Shoulder", "mixamorig:@Shoulder"},
                                    {"UpperArm", "mixamorig:@Arm"},
                                    {"LowerArm", "mixamorig:@ForeArm"},
                                    {"Hand", "mixamorig:@Hand"},
                                    {"UpperLeg", "mixamorig:@UpLeg"},
                                    {"LowerLeg", "mixamorig:@Leg"},
                                    {"Foot", "mixamorig:@Foot"},
                                    {"Toes", "mixamorig:@ToeBase"}},
                                   "Left", "Right")},
        Style{"Unreal", both_sides({{"hips", "pelvis"},
                                    {"spine", "spine_01"},
                                    {"chest", "spine_02"},
                                    {"neck", "neck_01"},
                                    {"head", "head"}},
                                   {{"Shoulder", "clavicle_@"},
                                    {"UpperArm", "upperarm_@"},
                                    {"LowerArm", "lowerarm_@"},
                                    {"Hand", "hand_@"},
                                    {"UpperLeg", "thigh_@"},
                                    {"LowerLeg", "calf_@"},
                                    {"Foot", "foot_@"},
                                    {"Toes", "ball_@"}},
                                   "l", "r")},
        Style{"Rigify", both_sides({{"hips", "DEF-spine"},
                                    {"spine", "DEF-spine.001"},
                                    {"chest", "DEF-spine.003"},
                                    {"neck", "DEF-spine.004"},
                                    {"head", "DEF-spine.006"}},
                                   {{"Shoulder", "DEF-shoulder.@"},
                                    {"UpperArm", "DEF-upper_arm.@"},
                                    {"LowerArm", "DEF-forearm.@"},
                                    {"Hand", "DEF-hand.@"},
                                    {"UpperLeg", "DEF-thigh.@"},
                                    {"LowerLeg", "DEF-shin.@"},
                                    {"Foot", "DEF-foot.@"},
                                    {"Toes", "DEF-toe.@"}},
                                   "L", "R")},
        Style{"Biped", both_sides({{"hips", "Bip01 Pelvis"},
                                   {"spine", "Bip01 Spine"},
                                   {"chest", "Bip01 Spine1"},
                                   {"neck", "Bip01 Neck"},
                                   {"head", "Bip01 Head"}},
                                  {{"Shoulder", "Bip01 @ Clavicle"},
                                   {"UpperArm", "Bip01 @ UpperArm"},
                                   {"LowerArm", "Bip01 @ Forearm"},
                                   {"Hand", "Bip01 @ Hand"},
                                   {"UpperLeg", "Bip01 @ Thigh"},
                                   {"LowerLeg", "Bip01 @ Calf"},
                                   {"Foot", "Bip01 @ Foot"},
                                   {"Toes", "Bip01 @ Toe0"}},
                                  "L", "R")},
        Style{"VRoid", both_sides({{"hips", "J_Bip_C_Hips"},
                                   {"spine", "J_Bip_C_Spine"},
                                   {"chest", "J_Bip_C_Chest"},
                                   {"neck", "J_Bip_C_Neck"},
                                   {"head", "J_Bip_C_Head"}},
                                  {{"Shoulder", "J_Bip_@_Shoulder"},
                                   {"UpperArm", "J_Bip_@_UpperArm"},
                                   {"LowerArm", "J_Bip_@_LowerArm"},
                                   {"Hand", "J_Bip_@_Hand"},
                                   {"UpperLeg", "J_Bip_@_UpperLeg"},
                                   {"LowerLeg", "J_Bip_@_LowerLeg"},
                                   {"Foot", "J_Bip_@_Foot"},
                                   {"Toes", "J_Bip_@_ToeBase"}},
                                  "L", "R")},
        Style{"plain",
              both_sides({{"hips", "Hips"}, {"spine", "Spine"}, {"chest", "Chest"}, {"neck", "Neck"}, {"head", "Head"}},
                         {{"Shoulder", "@ shoulder"},
                          {"UpperArm", "@ arm"},
                          {"LowerArm", "@ elbow"},
                          {"Hand", "@ wrist"},
                          {"UpperLeg", "@ leg"},
                          {"LowerLeg", "@ knee"},
                          {"Foot", "@ ankle"},
                          {"Toes", "@ toe"}},
                         "Left", "Right")},
    };
    for (const Style& style : styles) {
        SCOPED_TRACE(style.name);
        HumanoidGltf character;
        character.names = style.names;
        const Rigged rigged = rig(character);
        EXPECT_EQ(rigged.scene.chains.size(), 6u);
        EXPECT_EQ(rigged.limited(), 20u);
        const Chain* arm = find_chain(rigged.scene, "LeftArm");
        ASSERT_NE(arm, nullptr);
        EXPECT_EQ(rigged.scene.joints[arm->record.start].name, style.names.at("leftUpperArm"));
        EXPECT_EQ(rigged.scene.joints[arm->record.effector].name, style.names.at("leftHand"));
    }
}

TEST(AutoRig, TheExampleWalksInsideItsLimits) {
    Report report;
    auto scene = import_gltf(std::filesystem::path(BENDY_SOURCE_DIR) / "examples" / "mannequin.glb", {}, report);
    ASSERT_TRUE(scene.has_value());
    const Rigged rigged = rig(*std::move(scene));
    EXPECT_EQ(rigged.scene.chains.size(), 6u);
    EXPECT_EQ(rigged.limited(), 21u);
    std::size_t widened = 0;
    for (const std::string& line : rigged.report.proposals()) widened += line.find("widened") != std::string::npos;
    EXPECT_LE(widened, 2u);  // the toes
}

}  // namespace
}  // namespace bendy::converter
