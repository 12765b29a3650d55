#include "rigging/humanoid/auto_rig.h"
#include "rigging/humanoid/find_roles.h"

#include "humanoid_gltf.h"

#include <bendy/format/constraint.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace bendy::converter::animal_test {
namespace {

using namespace test;

/// A dog, metres, looking along +Z: legs of two bones in front and three behind, a tail.
HumanoidGltf make_dog() {
    HumanoidGltf dog;
    dog.bones.clear();
    dog.add("hips", "", {0, 0.6, -0.4});
    dog.add("back", "hips", {0, 0.62, -0.15});
    dog.add("chest", "back", {0, 0.62, 0.1});
    dog.add("neck", "chest", {0, 0.7, 0.35});
    dog.add("skull", "neck", {0, 0.85, 0.45});
    dog.add("jaw", "skull", {0, 0.8, 0.55});
    dog.add("tail1", "hips", {0, 0.58, -0.5});
    dog.add("tail2", "tail1", {0, 0.5, -0.6});
    dog.add("tail3", "tail2", {0, 0.4, -0.7});
    for (const double side : {1.0, -1.0}) {
        const std::string s = side > 0 ? "left" : "right";
        dog.add(s + "Ear", "skull", {side * 0.05, 0.95, 0.42});
        dog.add(s + "Front1", "chest", {side * 0.1, 0.55, 0.3});
        dog.add(s + "Front2", s + "Front1", {side * 0.1, 0.3, 0.22});
        dog.add(s + "Front3", s + "Front2", {side * 0.1, 0.05, 0.26});
        dog.add(s + "Front4", s + "Front3", {side * 0.1, 0.02, 0.31});
        dog.add(s + "Hind1", "hips", {side * 0.1, 0.55, -0.4});
        dog.add(s + "Hind2", s + "Hind1", {side * 0.1, 0.32, -0.3});
        dog.add(s + "Hind3", s + "Hind2", {side * 0.1, 0.2, -0.47});
        dog.add(s + "Hind4", s + "Hind3", {side * 0.1, 0.03, -0.43});
        dog.add(s + "Hind5", s + "Hind4", {side * 0.1, 0.01, -0.38});
    }
    return dog;
}

struct Rigged {
    Scene scene;
    Report report;

    /// Names of the joints at the ends of a chain; empty without such a chain.
    [[nodiscard]] std::pair<std::string, std::string> ends(const std::string& name) const {
        const Chain* chain = find_chain(scene, name);
        if (chain == nullptr) return {};
        return {scene.joints[chain->record.start].name, scene.joints[chain->record.effector].name};
    }
    [[nodiscard]] const ConstraintRecord& constraint(const std::string& name) const {
        static const ConstraintRecord kNothing;
        const Joint& joint = scene.joints[joint_named(scene, name)];
        EXPECT_EQ(joint.constraints.size(), 1u) << name;
        return joint.constraints.empty() ? kNothing : joint.constraints[0];
    }
};

Rigged rig(const HumanoidGltf& animal) {
    Rigged rigged{*animal.build().import(), {}};
    auto_rig(rigged.scene, {}, rigged.report);
    return rigged;
}

using Ends = std::pair<std::string, std::string>;

void expect_chains(const Rigged& rigged) {
    EXPECT_EQ(rigged.ends("LeftFrontLeg"), Ends("leftFront1", "leftFront3"));
    EXPECT_EQ(rigged.ends("RightFrontLeg"), Ends("rightFront1", "rightFront3"));
    EXPECT_EQ(rigged.ends("LeftHindLeg"), Ends("leftHind1", "leftHind4"));
    EXPECT_EQ(rigged.ends("RightHindLeg"), Ends("rightHind1", "rightHind4"));
    EXPECT_EQ(rigged.ends("Spine"), Ends("back", "neck"));
    EXPECT_EQ(rigged.ends("Neck"), Ends("neck", "skull"));
    EXPECT_EQ(rigged.ends("Tail"), Ends("tail1", "tail3"));
    EXPECT_EQ(rigged.scene.chains.size(), 7u);
}

TEST(Animal, GetsFourLegsSpineNeckAndTailWhereverItLooks) {
    for (const double turn : {0.0, 1.0, 2.5, 4.0}) {
        HumanoidGltf dog = make_dog();
        const glm::dquat about_y = glm::angleAxis(turn, glm::dvec3(0, 1, 0));
        dog.move([&](glm::dvec3 p) { return about_y * p; });
        expect_chains(rig(dog));
    }
}

TEST(Animal, ANameSaysWhichEndIsTheHead) {
    HumanoidGltf dog = make_dog();  // its tail stands up, its head hangs, and its toes are where its feet are
    dog["tail3"].position = {0, 1.1, -0.5};
    dog["neck"].position.y = 0.5;
    dog["skull"].position.y = 0.3;
    for (const char* side : {"left", "right"}) {
        dog[side + std::string("Front4")].position = dog[side + std::string("Front3")].position;
        dog[side + std::string("Hind5")].position = dog[side + std::string("Hind4")].position;
    }
    dog.names["skull"] = "Head";
    const Rigged rigged = rig(dog);
    EXPECT_EQ(rigged.ends("Neck"), Ends("neck", "Head"));
    EXPECT_EQ(rigged.ends("LeftFrontLeg"), Ends("leftFront1", "leftFront4"));
}

TEST(Animal, LegsMayEndInLeavesThatMoveNothingAndBeMovedByJointsElsewhere) {
    HumanoidGltf dog = make_dog();
    std::erase_if(dog.bones, [](const auto& bone) { return bone.name.find("Front4") != std::string::npos; });
    dog.add("foot", "", dog["leftFront3"].position);  // of an IK rig
    dog.add("toes", "foot", {0.1, 0.0, 0.3});
    for (const char* ear : {"leftEar", "rightEar"}) dog[ear].position.y = 1.5;  // above all of the head
    Scene scene = *dog.build().import();
    Mesh mesh;
    mesh.influences = 1;
    for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
        if (scene.joints[joint].name.find("Front3") == std::string::npos) mesh.palette.joints.push_back(joint);
    }
    mesh.palette.inverse_bind.assign(mesh.palette.joints.size(), glm::mat4(1.0f));
    scene.meshes.push_back(mesh);
    Rigged rigged{std::move(scene), {}};
    auto_rig(rigged.scene, {}, rigged.report);
    EXPECT_EQ(rigged.ends("LeftFrontLeg"), Ends("leftFront1", "leftFront3"));
    EXPECT_EQ(find_chain(rigged.scene, "LeftFrontLeg")->record.target, joint_named(rigged.scene, "foot"));
    EXPECT_EQ(find_chain(rigged.scene, "RightFrontLeg")->record.target, kNone);
    EXPECT_EQ(rigged.ends("Neck"), Ends("neck", "skull"));
}

TEST(Animal, HumanNamesOnFourLegsMakeNoHuman) {
    const Rigged rigged = rig(make_quadruped());
    EXPECT_EQ(rigged.ends("LeftHindLeg"), Ends("leftUpperLeg", "leftToes"));
    EXPECT_EQ(rigged.ends("LeftFrontLeg").second, "leftHand");
    EXPECT_EQ(find_chain(rigged.scene, "LeftArm"), nullptr);
    EXPECT_EQ(find_chain(rigged.scene, "LeftLeg"), nullptr);
}

TEST(Animal, LegsOfTwoBonesAreSolvedAsSuchAndBendAsTheyRest) {
    const Rigged rigged = rig(make_dog());
    const Chain& front = *find_chain(rigged.scene, "LeftFrontLeg");
    EXPECT_EQ(front.record.solver, static_cast<std::uint8_t>(Solver::two_bone));
    EXPECT_NE(front.record.pole_vector, (std::array<float, 3>{}));
    EXPECT_EQ(find_chain(rigged.scene, "LeftHindLeg")->record.solver, static_cast<std::uint8_t>(Solver::any));
}

TEST(Animal, LegsBendInTheirPlaneToTheSideToWhichTheyAreBent) {
    const Rigged rigged = rig(make_dog());
    for (const std::string side : {"left", "right"}) {
        for (const auto& [joint, next] : {std::pair("Hind2", "Hind3"), std::pair("Hind3", "Hind4")}) {
            const ConstraintRecord& hinge = rigged.constraint(side + joint);
            EXPECT_EQ(static_cast<ConstraintModel>(hinge.model), ConstraintModel::hinge);
            const std::uint32_t turned = joint_named(rigged.scene, side + joint);
            const std::uint32_t end = joint_named(rigged.scene, side + next);
            const glm::dvec3 rest = moved(rigged.scene, end, turned, 0, 0.0);
            const glm::dvec3 bent = moved(rigged.scene, end, turned, 0, hinge.rotation_max[0]);
            EXPECT_NEAR(rest.x, bent.x, 1e-6);
            const glm::dvec3 root = moved(rigged.scene, joint_named(rigged.scene, side + "Hind1"), turned, 0, 0.0);
            EXPECT_LT(glm::distance(root, bent), glm::distance(root, rest)) << joint;  // folded
            const double whole = (hinge.rotation_max[0] - hinge.rotation_min[0]) / kTestDegree;
            EXPECT_NEAR(whole, 165.0, 1e-3) << joint;
        }
    }
}

TEST(Animal, AHumanInASkirtIsAHuman) {
    HumanoidGltf character;
    for (const double front : {0.12, -0.12}) {
        for (const double side : {1.0, -1.0}) {
            const std::string s = std::string("skirt") + (front > 0 ? "F" : "B") + (side > 0 ? "L" : "R");
            character.add(s + "0", "hips", {side * 0.1, 0.95, front});
            character.add(s + "1", s + "0", {side * 0.12, 0.75, 1.3 * front});
            character.add(s + "2", s + "1", {side * 0.14, 0.55, 1.6 * front});
        }
    }
    EXPECT_EQ(rig(character).ends("LeftLeg"), Ends("leftUpperLeg", "leftFoot"));
    for (std::size_t i = 0; i < character.bones.size(); ++i)
        character.names[character.bones[i].name] = "bone_" + std::to_string(i);
    EXPECT_EQ(find_chain(rig(character).scene, "LeftFrontLeg"), nullptr);
}

TEST(Animal, AllMayHangOnOneJoint) {
    HumanoidGltf dog;
    dog.bones.clear();
    dog.add("body", "", {0, 0.6, 0});
    dog.add("neck", "body", {0, 0.7, 0.5});
    dog.add("skull", "neck", {0, 0.8, 0.6});
    dog.add("tail1", "body", {0, 0.6, -0.5});
    dog.add("tail2", "tail1", {0, 0.5, -0.9});  // longer than the neck
    for (const double side : {1.0, -1.0}) {
        for (const double front : {0.4, -0.4}) {  // legs that are mirrored in two planes
            const std::string s = std::string(front > 0 ? "front" : "hind") + (side > 0 ? "L" : "R");
            dog.add(s + "1", "body", {side * 0.15, 0.55, front});
            dog.add(s + "2", s + "1", {side * 0.15, 0.3, front});
            dog.add(s + "3", s + "2", {side * 0.15, 0.03, front});
        }
    }
    const Rigged rigged = rig(dog);
    EXPECT_EQ(rigged.ends("LeftFrontLeg"), Ends("frontL1", "frontL3"));
    EXPECT_EQ(rigged.ends("RightHindLeg"), Ends("hindR1", "hindR3"));
    EXPECT_EQ(rigged.ends("Neck"), Ends("neck", "skull"));
    EXPECT_EQ(rigged.ends("Tail"), Ends("tail1", "tail2"));
}

TEST(Animal, BonesThatStandAndJointsThatAreHardlyBentHaveLimits) {
    HumanoidGltf dog = make_dog();
    dog["neck"].position = {0, 0.8, 0.1};
    dog["skull"].position = {0, 1.0, 0.1};
    for (const char* side : {"left", "right"}) dog[side + std::string("Front2")].position.z = 0.32;  // bent backward
    const Rigged rigged = rig(dog);
    for (const char* name : {"chest", "neck", "leftFront2", "rightFront2"})
        EXPECT_EQ(rigged.scene.joints[joint_named(rigged.scene, name)].constraints.size(), 1u) << name;
}

/// A beetle or a spider: pairs of legs of two bones each, spread by `turn` radians from sideways at both ends.
HumanoidGltf make_insect(std::size_t pairs, double turn) {
    HumanoidGltf insect;
    insect.bones.clear();
    insect.add("body", "", {0, 0.4, 0});
    insect.add("skull", "body", {0, 0.5, 0.4});
    for (std::size_t pair = 0; pair < pairs; ++pair) {
        const double along = 1.0 - 2.0 * static_cast<double>(pair) / static_cast<double>(pairs - 1);
        const glm::dvec3 way = glm::dvec3(std::cos(along * turn), 0, std::sin(along * turn));
        const std::string number = std::to_string(pair + 1);
        for (const double side : {1.0, -1.0}) {
            const std::string s = (side > 0 ? "left" : "right") + number;
            const auto add = [&](const std::string& name, const std::string& parent, double out, double height) {
                insect.add(name, parent, {side * (0.1 + out * way.x), height, 0.3 * along + out * way.z});
            };
            add(s + "Leg1", "body", 0.0, 0.4);
            add(s + "Leg2", s + "Leg1", 0.3, 0.6);
            add(s + "Leg3", s + "Leg2", 0.5, 0.0);
        }
    }
    return insect;
}

TEST(Animal, OfMoreLegsGetsAChainForEachAndNoLimits) {
    for (const std::size_t pairs : {3u, 4u, 5u}) {
        for (const double turn : {0.0, 1.1}) {
            const Rigged rigged = rig(make_insect(pairs, turn));
            EXPECT_EQ(rigged.scene.chains.size(), 2 * pairs);
            for (std::size_t pair = 1; pair <= pairs; ++pair) {
                const std::string number = std::to_string(pair);
                EXPECT_EQ(rigged.ends("LeftLeg" + number), Ends("left" + number + "Leg1", "left" + number + "Leg3"));
                EXPECT_EQ(rigged.ends("RightLeg" + number), Ends("right" + number + "Leg1", "right" + number + "Leg3"));
            }
            for (const Joint& joint : rigged.scene.joints) EXPECT_TRUE(joint.constraints.empty()) << joint.name;
            Scene scene = rigged.scene;
            Report unheard;
            find_roles(scene, kNone, unheard);
            EXPECT_TRUE(scene.roles.empty());
        }
    }
}

TEST(Animal, NamesOfHumanLegsMakeNoHumanOfSix) {
    HumanoidGltf beetle = make_insect(3, 0.0);
    for (const char* side : {"left", "right"}) {
        const std::string mark = std::string(side) == "left" ? ".L" : ".R";
        for (const auto& [number, which] :
             {std::pair("1", "front"), std::pair("2", "middle"), std::pair("3", "rear")}) {
            beetle.names[std::string(side) + number + "Leg1"] = std::string(which) + "_upper_leg" + mark;
            beetle.names[std::string(side) + number + "Leg2"] = std::string(which) + "_lower_leg" + mark;
            beetle.names[std::string(side) + number + "Leg3"] = std::string(which) + "_foot" + mark;
        }
    }
    beetle["skull"].position.z = -0.4;  // the names know better
    beetle.names["skull"] = "abdomen";
    const Rigged rigged = rig(beetle);
    EXPECT_EQ(rigged.ends("LeftLeg1"), Ends("front_upper_leg.L", "front_foot.L"));
    EXPECT_EQ(rigged.ends("RightLeg3"), Ends("rear_upper_leg.R", "rear_foot.R"));
    EXPECT_EQ(rigged.scene.chains.size(), 6u);
}

TEST(Animal, AllLegsOfASideMayHangOnAJointInTheMiddle) {
    HumanoidGltf spider = make_insect(4, 1.1);
    for (const char* side : {"left", "right"}) {
        spider.bones.insert(spider.bones.begin() + 1, {std::string(side) + "Legs", "body", {0, 0.4, 0}});
        for (const char* number : {"1", "2", "3", "4"})
            spider[std::string(side) + number + "Leg1"].parent = std::string(side) + "Legs";
    }
    const Rigged rigged = rig(spider);
    EXPECT_EQ(rigged.ends("LeftLeg1"), Ends("left1Leg1", "left1Leg3"));
    EXPECT_EQ(rigged.ends("RightLeg4"), Ends("right4Leg1", "right4Leg3"));
}

TEST(Animal, FrontLegsThatDoNotStandAreArms) {
    HumanoidGltf rex = make_dog();
    for (const char* side : {"left", "right"}) {
        const std::string s = side;
        const std::string mark = s == "left" ? ".L" : ".R";
        for (const char* number : {"1", "2", "3", "4"}) rex[s + "Front" + number].position.y += 0.4;
        rex.names[s + "Front1"] = "FrontUpLeg" + mark;
        rex.names[s + "Front2"] = "FrontLowLeg" + mark;
        rex.names[s + "Front3"] = "FrontFoot" + mark;
        rex.names[s + "Hind1"] = "BackUpLeg" + mark;
        rex.names[s + "Hind2"] = "BackLowLeg" + mark;
        rex.names[s + "Hind4"] = "BackFoot" + mark;
    }
    const Rigged rigged = rig(rex);
    EXPECT_EQ(rigged.ends("LeftLeg"), Ends("BackUpLeg.L", "BackFoot.L"));
    EXPECT_EQ(rigged.ends("RightArm"), Ends("FrontUpLeg.R", "FrontFoot.R"));
    for (const Joint& joint : rigged.scene.joints) EXPECT_TRUE(joint.constraints.empty()) << joint.name;
}

TEST(Animal, IsFoundAsItsSkinIsBoundIfItRestsInAFrameOfAWalk) {
    Scene scene = *make_dog().build().import();
    bind_at_rest(scene);
    const auto turn = [&](const char* name, double degrees) {
        Transform& rest = scene.joints[joint_named(scene, name)].rest;
        const glm::vec4& q = rest.rotation;
        const glm::dquat turned =
            glm::dquat(q.w, q.x, q.y, q.z) * glm::angleAxis(degrees * kTestDegree, glm::dvec3(1, 0, 0));
        rest.rotation = {turned.x, turned.y, turned.z, turned.w};
    };
    turn("leftFront1", 50.0);
    turn("rightHind1", -45.0);
    turn("leftHind2", 40.0);
    Report report;
    auto_rig(scene, {}, report);
    const Rigged rigged{std::move(scene), std::move(report)};
    expect_chains(rigged);
    EXPECT_EQ(rigged.scene.joints[joint_named(rigged.scene, "rightHind1")].constraints.size(), 1u);
}

TEST(Animal, WingsAndManesAreNoLegs) {
    HumanoidGltf dragon = make_dog();
    for (const double side : {1.0, -1.0}) {
        const std::string s = side > 0 ? "left" : "right";
        dragon.add(s + "Wing1", "back", {side * 0.1, 0.7, 0.0});
        dragon.add(s + "Wing2", s + "Wing1", {side * 0.5, 0.9, 0.0});
        dragon.add(s + "Wing3", s + "Wing2", {side * 0.9, 0.8, -0.1});
    }
    dragon.add("mane", "neck", {0, 0.8, 0.3});
    expect_chains(rig(dragon));
}

}  // namespace
}  // namespace bendy::converter::animal_test
