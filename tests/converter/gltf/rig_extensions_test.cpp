#include "build_gltf.h"

#include <gtest/gtest.h>

namespace bendy::converter::rig_extensions_test {
namespace {

using namespace test;
using test::Json;  // not that of the converter

/// Three nodes in a row, and one beside them that the scene does not have.
Gltf make_arm() {
    Gltf gltf;
    gltf.add_node({{"name", "Elsewhere"}});
    gltf.add_node({{"name", "Upper"}, {"children", {2}}});
    gltf.add_node({{"name", "Lower"}, {"children", {3}}, {"translation", {0, 1, 0}}});
    gltf.add_node({{"name", "Hand"}, {"translation", {0, 1, 0}}});
    gltf.json["scenes"] = {{{"nodes", {1}}}};
    gltf.json["extensionsUsed"] = {"BENDY_ik_chains", "BENDY_joint_limits"};
    return gltf;
}

Import with_limits(const Json& limits) {
    Gltf gltf = make_arm();
    gltf.json["nodes"][2]["extensions"]["BENDY_joint_limits"] = {{"limits", limits}};
    return gltf.import();
}

Import with_chains(const Json& chains) {
    Gltf gltf = make_arm();
    gltf.json["extensions"]["BENDY_ik_chains"] = {{"chains", chains}};
    return gltf.import();
}

/// The warnings about limits and chains, with their places.
std::string warning_of(const Import& import) {
    std::string found;
    for (const Warning& warning : import.report.warnings()) {
        if (warning.first_place.find("BENDY_") == std::string::npos) continue;  // of the node outside the scene
        found += (found.empty() ? "" : "; ") + warning.first_place + ": " + warning.message;
    }
    return found;
}

TEST(GltfRigExtensions, NodesBecomeJoints) {
    Gltf gltf = make_arm();
    gltf.json["nodes"][2]["extensions"]["BENDY_joint_limits"] = {
        {"limits", {{{"model", "hinge"}, {"x", {0, 2.5}}}, {{"model", "swingTwistEllipse"}, {"scope", "ikOnly"}}}}};
    gltf.json["extensions"]["BENDY_ik_chains"] = {{"chains",
                                                   {{{"name", "Arm"},
                                                     {"start", 1},
                                                     {"effector", 3.0},
                                                     {"target", 3},
                                                     {"solver", "twoBone"},
                                                     {"weights", {{{"node", 2}, {"weight", 0.5}}}},
                                                     {"extras", {{"a", 1}}}}}}};
    const Import import = gltf.import();
    EXPECT_EQ(warning_of(import), "");
    ASSERT_EQ(import->joints[1].constraints.size(), 2u);
    EXPECT_EQ(import->joints[1].constraints[0].rotation_max[0], 2.5f);
    EXPECT_EQ(import->joints[1].constraints[1].scope, static_cast<std::uint8_t>(ConstraintScope::ik_only));
    ASSERT_EQ(import->chains.size(), 1u);
    const Chain& chain = import->chains[0];
    EXPECT_EQ(chain.name, "Arm");
    EXPECT_EQ(chain.record.start, 0u);
    EXPECT_EQ(chain.record.effector, 2u);
    EXPECT_EQ(chain.record.target, 2u);
    EXPECT_EQ(chain.record.pole, kNone);
    EXPECT_EQ(chain.record.solver, static_cast<std::uint8_t>(Solver::two_bone));
    ASSERT_EQ(chain.weights.size(), 1u);
    EXPECT_EQ(chain.weights[0].joint, 1u);
    EXPECT_EQ(chain.weights[0].weight, 0.5f);
    EXPECT_EQ(chain.extras, R"({"a":1})");
    EXPECT_EQ(import->joints[1].extensions, "");
    EXPECT_EQ(import->extensions, "");
}

TEST(GltfRigExtensions, NodesHaveRoles) {
    const auto with_roles = [](const Json& first, const Json& second) {
        Gltf gltf = make_arm();
        gltf.json["nodes"][2]["extensions"]["BENDY_joint_role"] = first;
        gltf.json["nodes"][3]["extensions"]["BENDY_joint_role"] = second;
        return gltf.import();
    };
    const Json tail{{"role", "tail"}, {"place", 3}};
    const Import import = with_roles({{"role", "leftLowerArm"}}, tail);
    EXPECT_EQ(warning_of(import), "");
    ASSERT_EQ(import->roles.size(), 2u);
    EXPECT_EQ(import->roles[0].joint, 1u);
    EXPECT_EQ(import->roles[0].role, static_cast<std::uint16_t>(Role::left_lower_arm));
    EXPECT_EQ(import->roles[0].place, 0u);
    EXPECT_EQ(import->roles[1].role, static_cast<std::uint16_t>(Role::tail));
    EXPECT_EQ(import->roles[1].place, 3u);
    EXPECT_EQ(import->joints[1].extensions, "");

    const auto warning = [&](const Json& role) {
        const Import faulty = with_roles(role, tail);
        EXPECT_EQ(faulty->roles.size(), 1u) << role.dump();
        return warning_of(faulty);
    };
    const std::string here = "nodes[2].extensions.BENDY_joint_role";
    EXPECT_EQ(warning(3), here + ": role left out: it must be an object, not 3");
    EXPECT_EQ(warning(Json::object()), here + ".role: role left out: it is required and missing");
    EXPECT_TRUE(
        warning({{"role", "none"}}).starts_with(here + ".role: role left out: 'none' is none of hips, spine, "));
    EXPECT_TRUE(warning({{"role", "left_hand"}}).starts_with(here + ".role: role left out: 'left_hand' is none of "));
    EXPECT_EQ(warning({{"role", "tail"}}), here + ".place: role left out: it is required and missing");
    EXPECT_EQ(warning({{"role", "hips"}, {"place", 1}}), here + ".place: role left out: 1 is not between 0 and 0");
    EXPECT_EQ(warning_of(with_roles(tail, tail)),
              "nodes[3].extensions.BENDY_joint_role: role left out: an earlier node has the same role");
}

TEST(GltfRigExtensions, BadLimitsNameTheirPlace) {
    const std::string here = "nodes[2].extensions.BENDY_joint_limits.limits";
    EXPECT_EQ(warning_of(with_limits(3)), here + ": limits left out: it must be a list, not 3");
    EXPECT_EQ(warning_of(with_limits({3})), here + "[0]: limits left out: it must be an object, not 3");
    EXPECT_EQ(warning_of(with_limits({{{"x", {0, 1}}}})),
              here + "[0].model: limits left out: it is required and missing");
    EXPECT_EQ(warning_of(with_limits({{{"model", "swing_twist_ellipse"}}})),
              here +
                  "[0].model: limits left out: 'swing_twist_ellipse' is none of free, locked, hinge, "
                  "swingTwistEllipse, swingTwistPyramid, eulerBox, largestAngle");
    EXPECT_EQ(warning_of(with_limits({{{"model", "hinge"}, {"x", {2, 1}}}})),
              here + "[0].x: limits left out: the minimum 2.0 is above the maximum 1.0");
    EXPECT_EQ(warning_of(with_limits({{{"model", "hinge"}, {"x", {0, "1"}}}})),
              here + "[0].x[1]: limits left out: expected a number, found '1'");
    EXPECT_EQ(warning_of(with_limits({{{"model", "hinge"}, {"softZone", -1}}})),
              here + "[0].softZone: limits left out: it is less than 0");
    EXPECT_EQ(warning_of(with_limits({{{"model", "swingTwistEllipse"}, {"angle", 1}}})),
              here + "[0].angle: limits left out: it means nothing for model swingTwistEllipse");
    EXPECT_TRUE(warning_of(with_limits({{{"model", "free"}, {"soft_zone", 1}}}))
                    .starts_with(here + "[0].soft_zone: limits left out: there is no such key; there are model, "));
    EXPECT_EQ(warning_of(with_limits({{{"model", "free"}}, {{"model", "locked"}}})),
              here + "[1]: limits left out: there is a second constraint of scope everyPose");
    EXPECT_EQ(warning_of(with_limits({{{"model", "free"}, {"frame", {0, 0, 0, 0}}}})),
              here + "[0].frame: limits left out: 0 0 0 0 is not a rotation");
    EXPECT_TRUE(with_limits({{{"model", "hinge"}, {"x", {2, 1}}}})->joints[1].constraints.empty());
}

TEST(GltfRigExtensions, BadChainsNameTheirPlaceAndTheOthersStay) {
    const auto warning = [](const Json& members) {
        Json chain{{"start", 1}, {"effector", 3}};
        chain.update(members);
        const Import import = with_chains({chain, {{"start", 2}, {"effector", 2}}});
        EXPECT_EQ(import->chains.size(), 1u) << members.dump();
        return warning_of(import);
    };
    const std::string here = "extensions.BENDY_ik_chains.chains[0]";
    EXPECT_EQ(warning({{"start", 4}}), here + ".start: chain left out: 4 is not between 0 and 3");
    EXPECT_EQ(warning({{"start", -1}}), here + ".start: chain left out: -1 is not between 0 and 3");
    EXPECT_EQ(warning({{"effector", "Hand"}}),
              here + ".effector: chain left out: it must be a whole number, not 'Hand'");
    EXPECT_EQ(warning({{"effector", 1.5}}), here + ".effector: chain left out: it must be a whole number, not 1.5");
    EXPECT_EQ(warning({{"target", 0}}), here + ".target: chain left out: node 0 is not in the scene");
    EXPECT_EQ(warning({{"pole", nullptr}}), here + ".pole: chain left out: it must be a whole number, not null");
    EXPECT_EQ(warning({{"start", 3}, {"effector", 1}}),
              here + ".start: chain left out: it is neither the effector nor above it");
    EXPECT_EQ(warning({{"tipOffset", {1, 2}}}), here + ".tipOffset: chain left out: expected 3 elements, found 2");
    EXPECT_EQ(warning({{"influence", 2}}), here + ".influence: chain left out: 2.0 is not between 0.0 and 1.0");
    EXPECT_EQ(warning({{"weights", {{"Lower", 1}}}}), here + ".weights: chain left out: it must be a list, not object");
    EXPECT_EQ(warning({{"weights", {{{"node", 2}}}}}),
              here + ".weights[0].weight: chain left out: it is required and missing");
    EXPECT_EQ(warning({{"effector", 2}, {"weights", {{{"node", 3}, {"weight", 1}}}}}),
              here + ".weights[0].node: chain left out: the node is not of this chain");
    EXPECT_EQ(warning({{"weights", {{{"node", 2}, {"weight", 1}}, {{"node", 2}, {"weight", 0}}}}}),
              here + ".weights[1].node: chain left out: the node has an earlier weight");
    EXPECT_EQ(warning({{"name", 3}}), here + ".name: chain left out: it must be a string, not 3");
    EXPECT_TRUE(warning({{"root", 1}})
                    .starts_with(here + ".root: chain left out: there is no such key; there are name, start, "));
    EXPECT_EQ(warning_of(with_chains({{{"effector", 1}}})),
              here + ".start: chain left out: it is required and missing");
    EXPECT_EQ(warning_of(with_chains(Json::object())),
              "extensions.BENDY_ik_chains.chains: chains left out: it must be a list, not object");
}

TEST(GltfRigExtensions, ChainsOfOneNameStayAndAreNamed) {
    const Json chain{{"name", "Arm"}, {"start", 1}, {"effector", 3}};
    const Import import = with_chains({chain, chain});
    EXPECT_EQ(import->chains.size(), 2u);
    EXPECT_EQ(warning_of(import),
              "extensions.BENDY_ik_chains.chains[1].name: there is an earlier chain 'Arm': only that "
              "one is found by this name");
    const Json unnamed{{"start", 1}, {"effector", 3}};
    EXPECT_EQ(warning_of(with_chains({unnamed, unnamed})), "");
}

TEST(GltfRigExtensions, TheRootSaysHowTheBodyStands) {
    const auto with_pose = [](const Json& pose) {
        Gltf gltf = make_arm();
        gltf.json["extensions"]["BENDY_standing_pose"] = pose;
        return gltf.import();
    };
    const Json axes{0, 0.6, 0, 0.8};
    const Json upper{{"node", 1}, {"rotation", {0, 0.5, 0}}};
    const Json hand{{"node", 3}, {"rotation", {0.6, 0, 0}}};
    const Import import = with_pose(
        {{"axes", axes}, {"ground", -0.5}, {"height", 2}, {"evidence", "restPose"}, {"rotations", {hand, upper}}});
    EXPECT_EQ(warning_of(import), "");
    ASSERT_TRUE(import->standing_pose.has_value());
    EXPECT_EQ(import->standing_pose->pose.axes, (std::array{0.0f, 0.6f, 0.0f, 0.8f}));
    EXPECT_EQ(import->standing_pose->pose.ground, -0.5f);
    EXPECT_EQ(import->standing_pose->pose.height, 2.0f);
    EXPECT_EQ(import->standing_pose->pose.evidence, static_cast<std::uint8_t>(StandingEvidence::rest_pose));
    ASSERT_EQ(import->standing_pose->rotations.size(), 2u);
    EXPECT_EQ(import->standing_pose->rotations[0].joint, 0u);
    EXPECT_EQ(import->standing_pose->rotations[1].joint, 2u);
    EXPECT_EQ(import->standing_pose->rotations[1].rotation, (std::array{0.6f, 0.0f, 0.0f}));
    EXPECT_EQ(import->extensions, "");

    const std::string here = "extensions.BENDY_standing_pose";
    const auto fault = [&](const Json& pose) {
        const Import faulty = with_pose(pose);
        EXPECT_FALSE(faulty->standing_pose.has_value());
        return warning_of(faulty);
    };
    EXPECT_EQ(fault({{"axes", axes}, {"rotations", {hand, hand}}}),
              here + ".rotations: standing pose left out: joint #2 has two rotations");
    EXPECT_EQ(fault({{"axes", axes}, {"rotations", {{{"node", 0}, {"rotation", {0, 0, 0}}}}}}),
              here + ".rotations[0].node: standing pose left out: node 0 is not in the scene");
    EXPECT_EQ(fault({{"axes", axes}, {"height", -1}, {"rotations", Json::array()}}).substr(0, here.size() + 7),
              here + ".height");
    EXPECT_NE(fault({{"rotations", Json::array()}}), "");
    EXPECT_NE(fault({{"axes", axes}}), "");
}

TEST(GltfRigExtensions, WhatEveryObjectMayHaveIsNamed) {
    Gltf gltf = make_arm();
    gltf.json["nodes"][2]["extensions"]["BENDY_joint_limits"] = {{"limits", {{{"model", "locked"}, {"extras", 1}}}},
                                                                 {"extensions", {{"ACME", 1}}}};
    gltf.json["extensions"]["BENDY_ik_chains"] = {
        {"chains", {{{"start", 1}, {"effector", 3}, {"extensions", {{"ACME", 1}}}}}}, {"extras", 1}};
    const Import import = gltf.import();
    EXPECT_EQ(import->joints[1].constraints.size(), 1u);
    EXPECT_EQ(import->chains.size(), 1u);
    EXPECT_EQ(import.warned("further data of limits, roles and chains left out"), 4u);
}

TEST(GltfRigExtensions, InTheWrongPlaceTheyAreKeptAsTheyAre) {
    Gltf gltf = make_arm();
    gltf.json["nodes"][2]["extensions"]["BENDY_ik_chains"] = {{"chains", {1}}};
    const Import import = gltf.import();
    EXPECT_EQ(import->joints[1].extensions, R"({"BENDY_ik_chains":{"chains":[1]}})");
    EXPECT_EQ(import.warned("extension kept as JSON, not interpreted"), 1u);
    EXPECT_TRUE(import->chains.empty());
}

TEST(GltfRigExtensions, AFileMayRequireThem) {
    Gltf gltf = make_arm();
    gltf.json["extensionsRequired"] = gltf.json["extensionsUsed"];
    gltf.json["nodes"][2]["extensions"]["BENDY_joint_limits"] = {{"limits", {{{"model", "locked"}}}}};
    EXPECT_EQ(gltf.import()->joints[1].constraints.size(), 1u);
}

}  // namespace
}  // namespace bendy::converter::rig_extensions_test
