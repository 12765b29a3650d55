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
    EXPECT_EQ(import.warned("extension left out: 'ACME'"), 1u);
    EXPECT_EQ(import.warned("kept as JSON"), 1u);
}

TEST(GltfKeptExtensions, OneThatIsKeptIsNotSaidToBeLost) {
    Gltf gltf = make_triangle();
    gltf.json["extensionsUsed"] = {"ACME_paint", "ACME_layer", "ACME_lens", "ACME_nowhere"};
    gltf.json["materials"] = {{{"extensions", {{"ACME_paint", {{"extensions", {{"ACME_layer", {{"x", 1}}}}}}}}}}};
    gltf.json["cameras"] = {{{"type", "perspective"},
                             {"perspective", {{"yfov", 1.0}, {"znear", 0.1}, {"extensions", {{"ACME_lens", 1}}}}}}};
    const Import import = gltf.import();
    EXPECT_EQ(import.warned("kept as JSON, not interpreted: ACME_paint"), 1u);
    EXPECT_EQ(import.warned("extension not read: 'ACME_nowhere'"), 1u);
    EXPECT_EQ(import.warned("extension not read"), 1u);
    EXPECT_EQ(import.warned("extension left out"), 0u);
}

TEST(GltfKeptExtensions, KnownNodeNumbersBecomeJointNumbers) {
    Gltf gltf;
    gltf.add_node({{"name", "elsewhere"}});
    gltf.add_node({{"name", "here"}});
    gltf.json["scenes"] = {{{"nodes", {1}}}};
    gltf.json["extensions"]["VRMC_springBone"] = {
        {"colliders", {{{"node", 0}}, {{"node", 1}}, {{"node", 7}}, {{"node", "x"}}}},
        {"colliderGroups", {{{"colliders", {0, 2}}}, {{"colliders", {1, 3}}}}},
        {"springs",
         {{{"center", 1}, {"joints", {{{"node", 1.0}}}}, {"colliderGroups", {0, 1}}}, {{"joints", {{{"node", 0}}}}}}}};
    gltf.json["extensions"]["VRM"] = {{"firstPerson", {{"firstPersonBone", -1}}}};
    const Import import = gltf.import();
    const Json kept = Json::parse(import->extensions);
    EXPECT_EQ(kept["VRMC_springBone"].dump(),
              R"({"colliderGroups":[{"colliders":[0]}],"colliders":[{"node":0}],)"
              R"("springs":[{"center":0,"colliderGroups":[0],"joints":[{"node":0}]}]})");
    EXPECT_EQ(kept["VRM"]["firstPerson"]["firstPersonBone"], -1);
    // Three colliders, what names them in the groups, the first group in the spring, and the joint of the second
    // spring.
    EXPECT_EQ(import.warned("names what is not there: its entry is left out"), 8u);
}

TEST(GltfKeptExtensions, NumbersOfMeshesImagesAndMaterialsAreTheScenes) {
    Gltf gltf = make_triangle();
    gltf.json["meshes"].push_back(gltf.json["meshes"][0]);  // nothing draws it
    gltf.json["nodes"][0]["mesh"] = 1;
    gltf.json["images"] = {{{"uri", "a.png"}}, {{"uri", "b.png"}, {"name", "Thumbnail"}}};
    gltf.json["textures"] = {{{"source", 0}}};
    gltf.json["materials"] = Json::array({Json::object()});
    gltf.json["extensions"]["VRM"] = {
        {"firstPerson", {{"meshAnnotations", {{{"mesh", 0}, {"firstPersonFlag", "Auto"}}, {{"mesh", 1}}}}}},
        {"materialProperties",
         {{{"name", "a"}, {"textureProperties", {{"_MainTex", 0}, {"_BumpMap", 9}}}}, {{"name", "b"}}}},
        {"meta", {{"texture", 3}}}};
    gltf.json["extensions"]["VRMC_vrm"] = {{"meta", {{"thumbnailImage", 1}}}};
    const Import import = gltf.import();
    const Json kept = Json::parse(import->extensions);
    EXPECT_EQ(kept["VRM"].dump(),
              R"({"firstPerson":{"meshAnnotations":[{"mesh":0}]},)"
              R"("materialProperties":[{"name":"a","textureProperties":{"_MainTex":0}}],"meta":{"texture":-1}})");
    EXPECT_EQ(kept["VRMC_vrm"].dump(), R"({"meta":{"thumbnailImage":1}})");
    ASSERT_EQ(import->textures.size(), 2u);
    EXPECT_EQ(import->textures[1].name, "Thumbnail");
    EXPECT_EQ(import->textures[1].images, std::vector<std::uint32_t>{1});
}

TEST(GltfKeptExtensions, VariantsWithoutTheirMappingsAreLeftOut) {
    Gltf gltf = make_triangle();
    gltf.json["extensions"]["KHR_materials_variants"] = {{"variants", {{{"name", "red"}}}}};
    const Import import = gltf.import();
    EXPECT_EQ(import->extensions, "");
    EXPECT_EQ(import.warned("primitives do not keep the mappings to its variants: 'KHR_materials_variants'"), 1u);
}

TEST(GltfKeptExtensions, AnExtensionWithoutWhatItIsAboutIsLeftOut) {
    Gltf gltf;
    gltf.add_node({{"name", "elsewhere"}});
    gltf.add_node(
        {{"extensions",
          {{"MSFT_lod", {{"ids", {0}}}}, {"VRMC_node_constraint", {{"constraint", {{"roll", {{"source", 0}}}}}}}}}});
    gltf.json["scenes"] = {{{"nodes", {1}}}};
    const Import import = gltf.import();
    EXPECT_EQ(import->joints[0].extensions, "");
    EXPECT_EQ(import.warned("names what is not there"), 2u);
}

TEST(GltfKeptExtensions, WhatIsNoObjectIsLeftOut) {
    Gltf gltf;
    gltf.add_node({{"extensions", {1, 2}}});
    gltf.json["extensions"] = "none";
    const Import import = gltf.import();
    EXPECT_EQ(import->extensions, "");
    EXPECT_EQ(import->joints[0].extensions, "");
    EXPECT_EQ(import.warned("extensions are not an object"), 2u);
}

TEST(GltfKeptExtensions, AFileMayDemandThem) {
    for (const char* name :
         {"VRM", "VRMC_vrm", "VRMC_node_constraint", "VRMC_springBone_extended_collider", "AGI_articulations"}) {
        Gltf gltf;
        gltf.add_node(Json::object());
        gltf.json["extensionsRequired"] = {name};
        EXPECT_TRUE(gltf.import().result.has_value()) << name;
    }
    for (const char* name : {"VRMC_materials_mtoon", "VRMC_materials_hdr_emissiveMultiplier"}) {
        Gltf gltf;
        gltf.add_node(Json::object());
        gltf.json["materials"] = {{{"extensions", {{name, {{"specVersion", "1.0"}}}}}}};
        gltf.json["extensionsUsed"] = gltf.json["extensionsRequired"] = {name};
        const Import import = gltf.import();
        ASSERT_TRUE(import.result.has_value()) << name;
        EXPECT_NE(import->materials.at(0).extensions.find("specVersion"), std::string::npos) << name;
        EXPECT_EQ(import.warned(name), 1u) << "as where it is only used";
    }
}

}  // namespace
}  // namespace bendy::converter::keep_extensions_test
