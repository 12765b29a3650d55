#include "build_gltf.h"

#include <gtest/gtest.h>

namespace bendy::converter::left_out_test {
namespace {

using namespace test;

TEST(GltfLeftOut, WhatNothingUsesIsNamed) {
    Gltf gltf = make_triangle();
    gltf.json["meshes"].push_back(gltf.json["meshes"][0]);
    gltf.json["meshes"][1]["name"] = "spare";
    gltf.json["meshes"].push_back(gltf.json["meshes"][0]);
    gltf.json["skins"] = {{{"name", "unworn"}, {"joints", {0}}}};
    gltf.json["cameras"] = {{{"name", "unseen"}, {"type", "perspective"}}};
    gltf.json["samplers"] = {{{"name", "unread"}}};
    const Import import = gltf.import();
    EXPECT_EQ(import.warned("meshes that no node of the scene draws left out: 'spare', meshes[2]"), 2u);
    EXPECT_EQ(import.warned("skins that no mesh of the scene uses left out: 'unworn'"), 1u);
    EXPECT_EQ(import.warned("cameras that no node of the scene has left out: 'unseen'"), 1u);
    EXPECT_EQ(import.warned("samplers that no texture uses left out: 'unread'"), 1u);
}

TEST(GltfLeftOut, NodesAndScenesOutsideAreNamed) {
    Gltf gltf = make_triangle();
    gltf.add_node({{"name", "behind"}});
    gltf.add_node(Json::object());
    gltf.json["scenes"] = {{{"nodes", {0}}}, {{"name", "set"}, {"nodes", {1, 2}}}};
    const Import import = gltf.import();
    EXPECT_EQ(import.warned("nodes outside the chosen scene left out: 'behind', nodes[2]"), 2u);
    EXPECT_EQ(import.warned("scenes that were not chosen left out: 'set'"), 1u);
}

TEST(GltfLeftOut, LongListsAreCutAndCounted) {
    Gltf gltf = make_triangle();
    for (int i = 0; i < 30; ++i) gltf.add_node({{"name", "n" + std::to_string(i)}});
    gltf.json["scenes"] = {{{"nodes", {0}}}};
    const Import import = gltf.import();
    EXPECT_EQ(import.warned("'n0', 'n1'"), 30u);
    EXPECT_EQ(import.warned("'n11', ..."), 30u);
    EXPECT_EQ(import.warned("'n12'"), 0u);
}

TEST(GltfLeftOut, NamesThatAreNoStringsDoNoHarm) {
    Gltf gltf = make_triangle();
    gltf.json["cameras"] = {{{"name", 5}, {"type", "perspective"}}};
    gltf.json["accessors"][0]["extras"] = nullptr;
    gltf.json["bufferViews"][0]["name"] = "";
    const Import import = gltf.import();
    EXPECT_EQ(import.warned("has left out: cameras[0]"), 1u);
    EXPECT_EQ(import.warned("extras of accessors left out: accessors[0].extras"), 1u);
    EXPECT_EQ(import.warned("names of bufferViews left out: ''"), 1u);
}

}  // namespace
}  // namespace bendy::converter::left_out_test
