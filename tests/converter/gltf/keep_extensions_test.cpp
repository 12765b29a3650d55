#include "build_gltf.h"

#include <gtest/gtest.h>

namespace bendy::converter::keep_extensions_test {
namespace {

using namespace test;

TEST(GltfKeptExtensions, RootAndNodesKeepTheirs) {
    Gltf gltf;
    gltf.add_node({{"extensions", {{"ACME_light", {{"light", 0}}}}}});
    gltf.json["extensions"]["ACME_light"]["lights"] = {1, 2};
    const Import import = gltf.import();
    EXPECT_EQ(import->extensions, R"({"ACME_light":{"lights":[1,2]}})");
    EXPECT_EQ(import->joints[0].extensions, R"({"ACME_light":{"light":0}})");
    EXPECT_EQ(import.warned("kept as JSON, not interpreted, numbers in it are the source's: 'ACME_light'"), 2u);
}

TEST(GltfKeptExtensions, ElsewhereTheyAreSaidToBeLost) {
    Gltf gltf = make_triangle();
    gltf.json["meshes"][0]["extensions"]["ACME"] = 1;
    gltf.json["nodes"][0]["extensions"]["ACME"] = 1;
    const Import import = gltf.import();
    EXPECT_EQ(import.warned("extension not read: 'ACME'"), 1u);
    EXPECT_EQ(import.warned("kept as JSON"), 1u);
}

TEST(GltfKeptExtensions, KnownNodeNumbersBecomeJointNumbers) {
    Gltf gltf;
    gltf.add_node({{"name", "elsewhere"}});
    gltf.add_node({{"name", "here"}});
    gltf.json["scenes"] = {{{"nodes", {1}}}};
    gltf.json["extensions"]["VRMC_springBone"] = {
        {"colliders", {{{"node", 1}}, {{"node", 0}}, {{"node", 7}}, {{"node", "x"}}}},
        {"springs", {{{"center", 1}, {"joints", {{{"node", 1.0}}}}}}}};
    gltf.json["extensions"]["VRM"] = {{"firstPerson", {{"firstPersonBone", -1}}}};
    const Import import = gltf.import();
    const Json kept = Json::parse(import->extensions);
    EXPECT_EQ(kept["VRMC_springBone"]["colliders"].dump(), R"([{"node":0},{"node":null},{"node":null},{"node":null}])");
    EXPECT_EQ(kept["VRMC_springBone"]["springs"].dump(), R"([{"center":0,"joints":[{"node":0}]}])");
    EXPECT_EQ(kept["VRM"]["firstPerson"]["firstPersonBone"], -1);
    EXPECT_EQ(import.warned("outside the chosen scene, null in its place"), 1u);
    EXPECT_EQ(import.warned("does not exist, null in its place"), 2u);
}

TEST(GltfKeptExtensions, WhatIsNoObjectIsLeftOut) {
    Gltf gltf;
    gltf.add_node({{"extensions", {1, 2}}});
    gltf.json["extensions"] = "none";
    const Import import = gltf.import();
    EXPECT_EQ(import->extensions, "");
    EXPECT_EQ(import->joints[0].extensions, "");
    EXPECT_EQ(import.warned("extensions are no object"), 2u);
}

TEST(GltfKeptExtensions, AFileMayDemandThem) {
    for (const char* name : {"VRM", "VRMC_vrm", "VRMC_node_constraint", "AGI_articulations"}) {
        Gltf gltf;
        gltf.add_node(Json::object());
        gltf.json["extensionsRequired"] = {name};
        EXPECT_TRUE(gltf.import().result.has_value()) << name;
    }
}

}  // namespace
}  // namespace bendy::converter::keep_extensions_test
