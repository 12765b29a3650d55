#include "build_gltf.h"

#include <gtest/gtest.h>

namespace bendy::converter::extensions_test {
namespace {

using namespace test;

TEST(GltfExtensions, WhatIsNotReadIsSaidByNameAndCounted) {
    Gltf gltf = make_triangle();
    gltf.json["extensionsUsed"] = {"KHR_lights_punctual", "ACME_listed_only", "KHR_mesh_quantization"};
    gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    gltf.add_node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    gltf.add_node({{"extensions", {{"ACME_unlisted", Json::object()}}}});
    const Import import = gltf.import();
    EXPECT_EQ(import->joints.size(), 3u);
    EXPECT_EQ(import.warned("'KHR_lights_punctual'"), 2u);
    EXPECT_EQ(import.warned("'ACME_listed_only'"), 1u);
    EXPECT_EQ(import.warned("'ACME_unlisted'"), 1u);
    EXPECT_EQ(import.warned("KHR_mesh_quantization"), 0u);
}

TEST(GltfExtensions, ExtensionsInExtrasAreTheAuthorsOwn) {
    Gltf gltf = make_triangle();
    gltf.json["nodes"][0]["extras"]["extensions"]["ACME"] = 1;
    EXPECT_TRUE(gltf.import().report.warnings().size() == 0);
}

TEST(GltfExtensions, CamerasAreCounted) {
    Gltf gltf = make_triangle();
    gltf.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
    gltf.add_node({{"camera", 0}});
    gltf.add_node({{"camera", 0}});
    EXPECT_EQ(gltf.import().warned("camera"), 2u);
}

TEST(GltfExtensions, ExtrasAreKeptOrCounted) {
    Gltf gltf = make_triangle();
    gltf.json["extras"] = {{"root", 1}};
    gltf.json["asset"]["copyright"] = "me";
    gltf.json["scenes"] = {{{"nodes", {0}}, {"extras", {{"scene", 1}}}}};
    gltf.json["nodes"][0]["extras"] = {{"b", 1}, {"a", {1, 2}}};
    gltf.json["meshes"][0]["extras"] = "text";
    gltf.primitive()["extras"] = 3;
    gltf.json["accessors"][0]["extras"] = 4;
    const Import import = gltf.import();
    EXPECT_EQ(import->source_extras, R"({"root":1})");
    EXPECT_EQ(import->extras, R"({"scene":1})");
    EXPECT_EQ(import->joints[0].extras, R"({"a":[1,2],"b":1})");
    EXPECT_EQ(import->meshes[0].extras, R"("text")");
    EXPECT_EQ(import->asset, R"({"copyright":"me","version":"2.0"})");
    EXPECT_EQ(import.warned("extras of primitives left out: meshes[0].primitives[0].extras"), 1u);
    EXPECT_EQ(import.warned("extras of accessors"), 1u);
}

}  // namespace
}  // namespace bendy::converter::extensions_test
