#include "build_gltf.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/export.h>

#include <gtest/gtest.h>

namespace bendy::converter::instancing_test {
namespace {

using namespace test;

/// A triangle on a node "tree" with these attributes; the node has a child.
Gltf make_forest(Gltf gltf, Json attributes) {
    gltf.json["nodes"][0]["name"] = "tree";
    gltf.json["nodes"][0]["children"] = {1};
    gltf.add_node({{"name", "root"}});
    gltf.json["scenes"] = {{{"nodes", {0}}}};
    gltf.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    gltf.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = std::move(attributes);
    return gltf;
}

Gltf make_three() {
    Gltf gltf = make_triangle();
    const auto places = gltf.add_accessor(std::vector<float>{1, 0, 0, 2, 0, 0, 3, 0, 0.25f}, "VEC3");
    const auto turns =
        gltf.add_accessor(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 32767, 0, 0, 23170, 0, 0, 23170}, "VEC4", true);
    const auto sizes = gltf.add_accessor(std::vector<std::uint8_t>{1, 1, 1, 2, 2, 2, 3, 1, 1}, "VEC3");
    const auto ids = gltf.add_accessor(std::vector<std::uint32_t>{7, 70000, 4000000000u}, "SCALAR");
    return make_forest(std::move(gltf), {{"TRANSLATION", places}, {"ROTATION", turns}, {"SCALE", sizes}, {"_ID", ids}});
}

constexpr const char* kNumbers =
    R"({"EXT_mesh_gpu_instancing":{"attributes":{"ROTATION":{"type":"VEC4","values":[0.0,0.0,0.0,1.0,0.0,1.0,0.0,0.0,)"
    R"(0.70711386,0.0,0.0,0.70711386]},"SCALE":{"integers":true,"type":"VEC3","values":[1,1,1,2,2,2,3,1,1]},)"
    R"("TRANSLATION":{"type":"VEC3","values":[1.0,0.0,0.0,2.0,0.0,0.0,3.0,0.0,0.25]},)"
    R"("_ID":{"integers":true,"type":"SCALAR","values":[7,70000,4000000000]}}}})";

TEST(GltfInstancing, NumbersAreKeptAndTheMeshIsDrawnOnce) {
    const Import import = make_three().import();
    ASSERT_EQ(import->joints.size(), 2u);
    EXPECT_EQ(import->meshes.size(), 1u);
    EXPECT_EQ(import->joints[0].extensions, kNumbers);
    EXPECT_EQ(import.warned("instances are kept as numbers, the mesh is drawn once"), 1u);
}

TEST(GltfInstancing, NumbersComeBackAsAccessors) {
    const Import import = make_three().import();
    Report report;
    const Bytes bytes = build_chunks(*import, "test", report);
    const auto asset = export_gltf(bytes, {}, report);
    ASSERT_TRUE(asset);
    const Json exported = Json::parse(asset->json);
    const Json& attributes = exported["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    ASSERT_EQ(attributes.size(), 4u);
    EXPECT_EQ(exported["accessors"][attributes["_ID"].get<std::size_t>()]["componentType"], 5125);
    EXPECT_EQ(exported["accessors"][attributes["ROTATION"].get<std::size_t>()]["componentType"], 5126);
    EXPECT_EQ(exported["extensionsUsed"], Json({"EXT_mesh_gpu_instancing"}));
    const auto glb = converter::make_glb(*asset);
    const Import again = import_bytes(*glb);
    EXPECT_EQ(again->joints[0].extensions, kNumbers);
}

TEST(GltfInstancing, AskedForTheyAreJoints) {
    GltfOptions options;
    options.instances = true;
    const Import import = make_three().import(options);
    ASSERT_EQ(import->joints.size(), 5u);
    ASSERT_EQ(import->meshes.size(), 3u);
    EXPECT_EQ(import->joints[0].name, "tree");
    EXPECT_EQ(import->joints[4].name, "root");
    EXPECT_EQ(import->joints[4].parent, 0u);
    for (std::uint32_t i = 0; i < 3; ++i) {
        const Joint& joint = import->joints[1 + i];
        EXPECT_EQ(joint.name, "tree[" + std::to_string(i) + "]");
        EXPECT_EQ(joint.parent, 0u);
        EXPECT_EQ(import->meshes[i].joint, 1 + i);
    }
    EXPECT_EQ(import->joints[3].rest.translation, glm::vec3(3.0f, 0.0f, 0.25f));
    EXPECT_EQ(import->joints[3].rest.scale, glm::vec3(3.0f, 1.0f, 1.0f));
    EXPECT_EQ(import->joints[2].rest.rotation, glm::vec4(0.0f, 1.0f, 0.0f, 0.0f));
    EXPECT_NEAR(import->joints[3].rest.rotation.x, 0.70710678f, 1e-6f);
    EXPECT_EQ(import->joints[0].extensions, "");
    EXPECT_EQ(import.warned("attributes of instances left out: '_ID'"), 1u);
    EXPECT_EQ(import.warned("drawn once"), 0u);
}

TEST(GltfInstancing, ClipsOfWeightsMoveAllInstances) {
    Gltf gltf;
    gltf.add_mesh({{"POSITION", gltf.add_positions(3)}}, {{"targets", {{{"POSITION", gltf.add_positions(3)}}}}});
    gltf.add_node({{"mesh", 0}});
    const auto places = gltf.add_accessor(std::vector<float>{1, 0, 0, 2, 0, 0}, "VEC3");
    const auto times = gltf.add_accessor(std::vector<float>{0, 1}, "SCALAR");
    gltf = make_forest(std::move(gltf), {{"TRANSLATION", places}});
    gltf.add_animation(0, "weights", times, times);
    GltfOptions options;
    options.instances = true;
    const Import import = gltf.import(options);
    ASSERT_EQ(import->clips[0].tracks.size(), 2u);
    EXPECT_EQ(import->clips[0].tracks[1].target, 1u);
}

TEST(GltfInstancing, FaultyOnesAreNamedOrRefused) {
    struct Fault {
        const char* what;
        Json attributes;
        const char* message;
    };
    Gltf gltf = make_triangle();
    const auto three = gltf.add_accessor(std::vector<float>(9), "VEC3");
    const auto two = gltf.add_accessor(std::vector<float>(6), "VEC3");
    const auto turns = gltf.add_accessor(std::vector<float>(12), "VEC4");
    const std::vector<Fault> faults{
        {"no accessor", {{"TRANSLATION", 99}}, "the number of an accessor is expected"},
        {"no number", {{"TRANSLATION", "x"}}, "the number of an accessor is expected"},
        {"none", Json::object(), "one attribute or more"},
        {"counts", {{"SCALE", two}, {"TRANSLATION", three}}, "has 3 elements, that of SCALE has 2"},
    };
    for (const Fault& fault : faults) {
        const Gltf forest = make_forest(gltf, fault.attributes);
        const Import import = forest.import();
        EXPECT_EQ(import->joints[0].extensions, "") << fault.what;
        EXPECT_EQ(import.warned(fault.message), 1u) << fault.what;
        GltfOptions options;
        options.instances = true;
        EXPECT_NE(forest.import(options).message().find(fault.message), std::string::npos) << fault.what;
    }
    GltfOptions options;
    options.instances = true;
    EXPECT_NE(make_forest(gltf, {{"TRANSLATION", turns}}).import(options).message().find("must hold VEC3"),
              std::string::npos);
    const Import zero = make_forest(gltf, {{"ROTATION", turns}}).import(options);
    EXPECT_EQ(zero.warned("rotation of an instance is (0, 0, 0, 0), taken as none"), 3u);
    EXPECT_EQ(zero->joints.back().rest.rotation, glm::vec4(0, 0, 0, 1));
}

TEST(GltfInstancing, ASkinnedMeshIsDrawnOnce) {
    Gltf gltf = make_skinned(2, {{{0, 0, 0, 0}, {1, 0, 0, 0}}});
    const auto places = gltf.add_accessor(std::vector<float>{1, 0, 0, 2, 0, 0}, "VEC3");
    gltf.json["nodes"][2]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = places;
    GltfOptions options;
    options.instances = true;
    const Import import = gltf.import(options);
    EXPECT_EQ(import->meshes.size(), 1u);
    EXPECT_EQ(import.warned("instances of a mesh with a skin are not made"), 1u);
    EXPECT_NE(import->joints[2].extensions, "");
}

TEST(GltfInstancing, AFileThatDemandsThemNeedsTheOption) {
    Gltf gltf = make_three();
    gltf.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    EXPECT_NE(gltf.import().message().find("--instances"), std::string::npos);
    GltfOptions options;
    options.instances = true;
    EXPECT_EQ(gltf.import(options)->meshes.size(), 3u);
}

/// A small file cannot ask for any number of them.
TEST(GltfInstancing, TheirNumberIsHeldAgainstTheBytes) {
    Gltf gltf = make_triangle();
    gltf.json["accessors"].push_back({{"componentType", 5126}, {"count", 16000000}, {"type", "VEC3"}});
    const std::size_t zeros = gltf.json["accessors"].size() - 1;
    gltf = make_forest(std::move(gltf), {{"TRANSLATION", zeros}});
    const Import kept = gltf.import();
    EXPECT_EQ(kept->joints[0].extensions, "");
    EXPECT_EQ(kept.warned("the decoded data would be implausibly large"), 1u);
    GltfOptions options;
    options.instances = true;
    EXPECT_EQ(gltf.import(options).message(), "the decoded data would be implausibly large");
}

}  // namespace
}  // namespace bendy::converter::instancing_test
