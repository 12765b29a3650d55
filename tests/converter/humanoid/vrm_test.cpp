#include "rigging/humanoid/auto_rig.h"

#include "humanoid_gltf.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/format/document.h>

#include <gtest/gtest.h>

namespace bendy::converter::vrm_test {
namespace {

using namespace test;

struct Rigged {
    Scene scene;
    Report report;
};

Rigged rig(const Gltf& gltf) {
    const Import import = gltf.import();
    Rigged result{*import, import.report};
    add_vrm_chains(result.scene, result.report);
    EXPECT_TRUE(validate(build_chunks(result.scene, "test", result.report)).empty());
    return result;
}

/// The chain's pole in model space.
glm::dvec3 pole_of(const Scene& scene, const Chain& chain) {
    glm::dvec3 pole(chain.record.pole_vector[0], chain.record.pole_vector[1], chain.record.pole_vector[2]);
    for (std::uint32_t j = scene.joints[chain.record.start].parent; j != kNone; j = scene.joints[j].parent) {
        const glm::vec4 q = scene.joints[j].rest.rotation;
        pole = glm::dquat(q.w, q.x, q.y, q.z) * pole;
    }
    return pole;
}

void expect_chain(const Scene& scene, const char* name, const char* start, const char* effector, Solver solver) {
    const Chain* chain = find_chain(scene, name);
    ASSERT_NE(chain, nullptr) << name;
    EXPECT_EQ(scene.joints[chain->record.start].name, start);
    EXPECT_EQ(scene.joints[chain->record.effector].name, effector);
    EXPECT_EQ(chain->record.solver, static_cast<std::uint8_t>(solver));
    EXPECT_EQ(chain->record.flags, 0);
}

TEST(Vrm, LimbsBecomeChains) {
    for (const bool is_old : {false, true}) {
        HumanoidGltf character;
        if (is_old) character.move([](glm::dvec3 p) { return glm::dvec3(-p.x, p.y, -p.z); });
        const Rigged rigged = rig(character.build_vrm(is_old));
        EXPECT_EQ(rigged.scene.chains.size(), 6u);
        expect_chain(rigged.scene, "LeftArm", "leftUpperArm", "leftHand", Solver::two_bone);
        expect_chain(rigged.scene, "RightArm", "rightUpperArm", "rightHand", Solver::two_bone);
        expect_chain(rigged.scene, "LeftLeg", "leftUpperLeg", "leftFoot", Solver::two_bone);
        expect_chain(rigged.scene, "RightLeg", "rightUpperLeg", "rightFoot", Solver::two_bone);
        expect_chain(rigged.scene, "Spine", "spine", "neck", Solver::ccd);
        expect_chain(rigged.scene, "Head", "neck", "head", Solver::aim);
        const double forward = is_old ? -1.0 : 1.0;
        for (const char* leg : {"LeftLeg", "RightLeg"})
            EXPECT_LT(glm::distance(pole_of(rigged.scene, *find_chain(rigged.scene, leg)), {0, 0, forward}), 1e-5);
        for (const char* arm : {"LeftArm", "RightArm"})
            EXPECT_LT(glm::distance(pole_of(rigged.scene, *find_chain(rigged.scene, arm)), {0, 0, -forward}), 1e-5);
        for (const Joint& joint : rigged.scene.joints) EXPECT_TRUE(joint.constraints.empty()) << joint.name;
    }
}

TEST(Vrm, ABentLimbShowsItsPole) {
    HumanoidGltf character;
    character["leftLowerArm"].position += glm::dvec3(0, -0.05, 0);
    character["rightLowerArm"].position += glm::dvec3(0, -0.001, 0);  // less than a degree
    const Rigged rigged = rig(character.build_vrm());
    EXPECT_LT(glm::distance(pole_of(rigged.scene, *find_chain(rigged.scene, "LeftArm")), {0, -1, 0}), 1e-5);
    EXPECT_NEAR(pole_of(rigged.scene, *find_chain(rigged.scene, "RightArm")).z, -1, 1e-4);
}

TEST(Vrm, TheHeadLooksAhead) {
    const Rigged rigged = rig(HumanoidGltf().build_vrm());
    const Chain& head = *find_chain(rigged.scene, "Head");
    const std::uint32_t neck = head.record.start;
    glm::dvec3 tip(head.record.tip_offset[0], head.record.tip_offset[1], head.record.tip_offset[2]);
    glm::dvec3 ahead(0, 0, 1);
    const auto& q = head.record.tip_rotation;
    ahead = glm::dquat(q[3], q[0], q[1], q[2]) * ahead;
    for (std::uint32_t j = head.record.effector; j != kNone; j = rigged.scene.joints[j].parent) {
        const Transform& rest = rigged.scene.joints[j].rest;
        const glm::dquat rotation(rest.rotation.w, rest.rotation.x, rest.rotation.y, rest.rotation.z);
        tip = glm::dvec3(rest.translation) + rotation * tip;
        ahead = rotation * ahead;
    }
    EXPECT_EQ(rigged.scene.joints[neck].name, "neck");
    EXPECT_LT(glm::distance(tip, {0, 1.5, 0.1}), 1e-5);
    EXPECT_LT(glm::distance(ahead, {0, 0, 1}), 1e-5);
}

TEST(Vrm, NodesAreJointNumbersInWhatIsKept) {
    Gltf gltf = HumanoidGltf().build_vrm();
    gltf.json["extensions"]["VRMC_vrm"]["meta"] = {{"name", "Alice"}};
    gltf.json["nodes"][3]["extensions"]["VRMC_node_constraint"] = {
        {"specVersion", "1.0"}, {"constraint", {{"roll", {{"source", 2}, {"rollAxis", "X"}, {"weight", 0.5}}}}}};
    const Import import = gltf.import();
    const Json kept = Json::parse(import->extensions);
    EXPECT_EQ(kept["VRMC_vrm"]["meta"]["name"], "Alice");
    for (const auto& [name, bone] : kept["VRMC_vrm"]["humanoid"]["humanBones"].items())
        EXPECT_EQ(import->joints.at(bone["node"].get<std::size_t>()).name, name);
    const Joint& joint = import->joints[joint_named(*import, "chest")];
    const Json constraint = Json::parse(joint.extensions)["VRMC_node_constraint"]["constraint"]["roll"];
    EXPECT_EQ(import->joints.at(constraint["source"].get<std::size_t>()).name, "spine");
    EXPECT_EQ(constraint["rollAxis"], "X");
    EXPECT_EQ(import.warned("only its humanoid is interpreted: 'VRMC_vrm'"), 1u);
    EXPECT_EQ(import.warned("kept as JSON, not interpreted: 'VRMC_node_constraint'"), 1u);
    EXPECT_EQ(import.warned("not read"), 0u);
}

TEST(Vrm, WhatIsWrongIsNamedByItsPlace) {
    const auto broken = [](const auto& breaks) {
        Gltf gltf = HumanoidGltf().build_vrm();
        breaks(gltf.json["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"]);
        return rig(gltf);
    };
    for (const Json& node : {Json(99), Json(-5), Json(0.5), Json("12"), Json(), Json::array(), Json(1e300), Json(0)}) {
        const Rigged rigged = broken([&](Json& bones) { bones["leftHand"]["node"] = node; });
        EXPECT_GE(warned(rigged.report, "humanBones.leftHand.node"), node.is_null() ? 0u : 1u) << node;
        EXPECT_EQ(warned(rigged.report, "chain LeftArm left out: there is no leftHand"), 1u) << node;
        EXPECT_EQ(rigged.scene.chains.size(), 5u);
    }
    EXPECT_EQ(warned(broken([](Json& bones) { bones["leftHand"] = 3; }).report, "humanBones.leftHand"), 1u);
    EXPECT_EQ(warned(broken([](Json& bones) { bones["leftHand"].erase("node"); }).report, "humanBones.leftHand"), 1u);
    EXPECT_EQ(warned(broken([](Json& bones) { bones = 3; }).report, "VRMC_vrm.humanoid.humanBones"), 1u);
    EXPECT_EQ(warned(broken([](Json& bones) { bones = Json::array(); }).report, "VRMC_vrm.humanoid.humanBones"), 1u);
    for (const Json& vrm : {Json(), Json(1), Json::array(), Json::object(), Json({{"humanoid", 7}})}) {
        for (const char* name : {"VRM", "VRMC_vrm"}) {
            Gltf gltf = HumanoidGltf().build();
            gltf.json["extensions"][name] = vrm;
            const Rigged rigged = rig(gltf);
            EXPECT_TRUE(rigged.scene.chains.empty());
            EXPECT_GE(warned(rigged.report, name), 2u) << vrm;  // one says that it is kept
        }
    }
}

TEST(Vrm, MalformedBonesOfTheOldVersion) {
    Gltf gltf = HumanoidGltf().build_vrm(true);
    Json& bones = gltf.json["extensions"]["VRM"]["humanoid"]["humanBones"];
    bones.push_back(4);
    bones.push_back({{"bone", 4}, {"node", 1}});
    bones.push_back({{"bone", "leftHand"}, {"node", 1}});
    bones[0]["useDefaultValues"] = false;
    bones[1]["useDefaultValues"] = "no";
    const Rigged rigged = rig(gltf);
    EXPECT_EQ(rigged.scene.chains.size(), 6u);
    EXPECT_EQ(warned(rigged.report, "bone without a name"), 2u);
    EXPECT_EQ(warned(rigged.report, "named twice"), 1u);
    EXPECT_EQ(warned(rigged.report, "muscle"), 1u);
}

TEST(Vrm, AnEndThatIsNotBelowItsStartMakesNoChain) {
    HumanoidGltf character;
    character["leftFoot"].parent = "hips";
    const Rigged rigged = rig(character.build_vrm());
    EXPECT_EQ(find_chain(rigged.scene, "LeftLeg"), nullptr);
    EXPECT_NE(find_chain(rigged.scene, "RightLeg"), nullptr);
    EXPECT_EQ(warned(rigged.report, "chain LeftLeg left out: leftFoot is not below leftUpperLeg"), 1u);
}

TEST(Vrm, SegmentsBetweenTheBonesDoNotBend) {
    HumanoidGltf character;
    character.add("twist", "leftUpperArm", {0.35, 1.45, 0});
    character["leftLowerArm"].parent = "twist";
    const Rigged rigged = rig(character.build_vrm());
    const Chain& arm = *find_chain(rigged.scene, "LeftArm");
    ASSERT_EQ(arm.weights.size(), 1u);
    EXPECT_EQ(rigged.scene.joints[arm.weights[0].joint].name, "twist");
    EXPECT_EQ(arm.weights[0].weight, 0.0f);
    EXPECT_EQ(arm.record.solver, static_cast<std::uint8_t>(Solver::two_bone));
}

TEST(Vrm, TakenNamesStay) {
    Scene scene = *HumanoidGltf().build_vrm().import();
    Chain mine;
    mine.name = "LeftArm";
    scene.chains.push_back(mine);
    Report report;
    add_vrm_chains(scene, report);
    EXPECT_EQ(scene.chains.size(), 6u);
    EXPECT_EQ(scene.chains[0].record.effector, 0u);
}

}  // namespace
}  // namespace bendy::converter::vrm_test
