#include "optimise/passes/drop_unused.h"

#include <gtest/gtest.h>
#include <glm/ext/matrix_transform.hpp>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace bendy::converter::drop_unused_test {
namespace {

Stream stream_of(std::uint32_t set, std::uint32_t components, std::vector<float> values) {
    return {{}, set, components, std::move(values)};
}

/// Two triangles that share an edge, whose corners differ in texture coordinates only: 6 vertices, 4 places.
Mesh square() {
    Mesh mesh;
    mesh.name = "square";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}};
    mesh.normals.assign(6, {0, 0, 1});
    mesh.tangents.assign(6, {1, 0, 0, 1});
    for (const std::uint32_t set : {0u, 1u, 2u}) {
        std::vector<float> coords(12);
        for (std::size_t k = 0; k < coords.size(); ++k) coords[k] = static_cast<float>(k * (set + 1));
        mesh.texture_coords.push_back(stream_of(set, 2, coords));
    }
    mesh.colours = {stream_of(0, 3, std::vector<float>(18, 0.5f)), stream_of(1, 3, std::vector<float>(18, 0.25f))};
    mesh.submeshes = {{Topology::triangles, 0, {0, 1, 2, 3, 4, 5}}};
    MorphTarget target;
    target.positions.assign(6, glm::vec3(0.0f));
    target.tangents.assign(6, glm::vec3(0.1f));
    mesh.targets = {target};
    return mesh;
}

Scene scene_of(const Material& material) {
    Scene scene;
    scene.joints.resize(1);
    scene.meshes = {square()};
    scene.meshes[0].joint = 0;
    scene.materials = {material};
    scene.textures.resize(3);
    return scene;
}

std::vector<std::uint32_t> sets_after(Scene& scene) {
    Report report;
    drop_unused(scene, report);
    std::vector<std::uint32_t> sets;
    for (const Stream& stream : scene.meshes[0].texture_coords) sets.push_back(stream.set);
    return sets;
}

std::vector<std::uint32_t> sets_with(const Material& material) {
    Scene scene = scene_of(material);
    return sets_after(scene);
}

using Sets = std::vector<std::uint32_t>;

TEST(DropUnused, WithoutTexturesEqualVerticesAreMerged) {
    Scene scene = scene_of({});
    Report report;
    drop_unused(scene, report);
    const Mesh& mesh = scene.meshes[0];
    EXPECT_TRUE(mesh.texture_coords.empty());
    EXPECT_TRUE(mesh.tangents.empty());
    EXPECT_TRUE(mesh.targets[0].tangents.empty());
    EXPECT_EQ(mesh.normals.size(), 4u);
    ASSERT_EQ(mesh.colours.size(), 1u) << "COLOR_0 is a factor of the base colour";
    EXPECT_EQ(mesh.colours[0].set, 0u);
    EXPECT_EQ(mesh.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
    EXPECT_EQ(mesh.submeshes[0].indices, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3}));
    std::vector<std::string> told;
    for (const Warning& warning : report.warnings())
        told.push_back(std::to_string(warning.count) + ": " + warning.first_place + ": " + warning.message);
    EXPECT_EQ(told, (std::vector<std::string>{
                        "3: mesh 'square', TEXCOORD_0: texture coordinates that no material uses are left out",
                        "1: mesh 'square', COLOR_1: colours that change nothing are left out",
                        "1: mesh 'square', TANGENT: tangents that no material uses are left out",
                        "2: mesh 'square': vertices that differed in nothing else are merged"}));
}

TEST(DropUnused, WhatTexturesUseStays) {
    Material material;
    material.occlusion_texture.texture = 1;
    material.occlusion_texture.coords = 2;
    EXPECT_EQ(sets_with(material), (Sets{2}));
    material.base_colour_texture.texture = 0;
    EXPECT_EQ(sets_with(material), (Sets{0, 2}));
    material.emissive_texture.coords = 1;  // a use without a texture
    EXPECT_EQ(sets_with(material), (Sets{0, 2}));
}

TEST(DropUnused, WhatExtensionsSpeakOfStays) {
    const auto sets = [](const char* extensions) {
        Material material;
        material.extensions = extensions;
        return sets_with(material);
    };
    EXPECT_EQ(sets(R"({"KHR_materials_ior":{"ior":1.4,"extras":{}}})"), (Sets{}));
    EXPECT_EQ(sets(R"({"KHR_materials_specular":{"specularTexture":{"index":1}}})"), (Sets{0}));
    EXPECT_EQ(sets(R"({"KHR_materials_specular":{"specularTexture":{"index":1,"texCoord":2}}})"), (Sets{2}));
    EXPECT_EQ(sets(R"({"A":{"b":[{"index":1,"texCoord":1,"extensions":{"KHR_texture_transform":{"texCoord":2}}}]}})"),
              (Sets{1, 2}));
    EXPECT_EQ(sets(R"({"ANY_toon":{"shadeTexture":2}})"), (Sets{0}));
    EXPECT_EQ(sets("not JSON"), (Sets{0, 1, 2})) << "it may use anything";
    Scene scene = scene_of({});
    scene.extensions = R"({"VRM":{"materialProperties":[{"textureProperties":{"_ShadeTexture":2}}]}})";
    EXPECT_EQ(sets_after(scene), (Sets{0})) << "VRM 0 describes materials at the root";
}

TEST(DropUnused, NormalMapsAndAnisotropyNeedTangents) {
    const auto has_tangents = [](const Material& material) {
        Scene scene = scene_of(material);
        sets_after(scene);
        EXPECT_EQ(scene.meshes[0].targets[0].tangents.empty(), scene.meshes[0].tangents.empty());
        return !scene.meshes[0].tangents.empty();
    };
    Material material;
    EXPECT_FALSE(has_tangents(material));
    material.normal_texture.texture = 0;
    EXPECT_TRUE(has_tangents(material));
    material = {};
    material.extensions = R"({"KHR_materials_clearcoat":{"clearcoatNormalTexture":{"index":0}}})";
    EXPECT_TRUE(has_tangents(material));
    material.extensions = R"({"KHR_materials_anisotropy":{"anisotropyStrength":0.5}})";
    EXPECT_TRUE(has_tangents(material));
}

TEST(DropUnused, NormalsGoIfNothingIsLit) {
    Material unlit;
    unlit.unlit = true;
    Scene scene = scene_of(unlit);
    sets_after(scene);
    EXPECT_TRUE(scene.meshes[0].normals.empty());
    scene = scene_of(unlit);
    scene.meshes[0].submeshes.push_back({Topology::triangles, kNone, {0, 1, 2}});  // the default material is lit
    sets_after(scene);
    EXPECT_FALSE(scene.meshes[0].normals.empty());
}

TEST(DropUnused, WhiteChangesNothing) {
    Scene scene = scene_of({});
    scene.meshes[0].colours[0].values.assign(18, 1.0f);
    sets_after(scene);
    EXPECT_TRUE(scene.meshes[0].colours.empty());
}

TEST(DropUnused, AMeshOfWhichAllIsUsedDoesNotChange) {
    Scene scene = scene_of({});
    Mesh& mesh = scene.meshes[0];
    mesh.texture_coords.clear();
    mesh.tangents.clear();
    mesh.targets.clear();
    mesh.colours.pop_back();
    Report report;
    drop_unused(scene, report);
    EXPECT_EQ(mesh.positions.size(), 6u) << "equal vertices are the author's choice";
    EXPECT_TRUE(report.warnings().empty());
}

TEST(DropUnused, JointsThatMoveNoVertexLeaveThePalette) {
    Scene scene = scene_of({});
    scene.joints.resize(5);
    Mesh& mesh = scene.meshes[0];
    mesh.influences = 2;
    mesh.palette.joints = {4, 3, 1, 0};
    for (const float x : {4.0f, 3.0f, 1.0f, 0.0f})
        mesh.palette.inverse_bind.push_back(glm::translate(glm::mat4(1.0f), {x, 0.0f, 0.0f}));
    mesh.bones = {1, 3, 1, 3, 3, 1, 3, 1, 3, 0, 3, 0};
    mesh.weights = {0.5f, 0.5f, 1.0f, 0.0f, 1.0f, 0.0f, 0.5f, 0.5f, 1.0f, 0.0f, 1.0f, 0.0f};
    Report report;
    drop_unused(scene, report);
    EXPECT_EQ(mesh.palette.joints, (std::vector<std::uint32_t>{3, 0}));
    ASSERT_EQ(mesh.palette.inverse_bind.size(), 2u);
    EXPECT_EQ(mesh.palette.inverse_bind[0][3].x, 3.0f);
    EXPECT_EQ(mesh.palette.inverse_bind[1][3].x, 0.0f);
    EXPECT_EQ(mesh.positions.size(), 6u) << "no two vertices with the same position have the same bones";
    EXPECT_EQ(mesh.bones, (std::vector<std::uint32_t>{0, 1, 0, 1, 1, 0, 1, 0, 1, 0, 1, 0}));
    const std::vector<Warning>& told = report.warnings();
    const auto found = std::find_if(told.begin(), told.end(), [](const Warning& warning) {
        return warning.message == "joints of the skin that move no vertex of the mesh are left out of its palette";
    });
    ASSERT_NE(found, told.end());
    EXPECT_EQ(found->count, 2u);
    EXPECT_EQ(found->first_place, "mesh 'square'");
}

TEST(DropUnused, APaletteKeepsOneEntryForBonesWithoutWeight) {
    Scene scene = scene_of({});
    Mesh& mesh = scene.meshes[0];
    mesh.influences = 1;
    mesh.palette.joints = {0, 0};
    mesh.palette.inverse_bind.resize(2, glm::mat4(1.0f));
    mesh.bones.assign(6, 1);
    mesh.weights.assign(6, 0.0f);
    sets_after(scene);
    EXPECT_EQ(mesh.palette.joints.size(), 1u);
    EXPECT_EQ(mesh.bones, std::vector<std::uint32_t>(mesh.bones.size(), 0u));
}

TEST(DropUnused, AMeshWithoutPolygonsKeepsAll) {
    Scene scene = scene_of({});
    scene.meshes[0].submeshes.clear();
    EXPECT_EQ(sets_after(scene), (Sets{0, 1, 2}));
}

TEST(DropUnused, VerticesThatDifferInAnyStreamStayApart) {
    const auto vertices = [](auto&& change) {
        Scene scene = scene_of({});
        change(scene.meshes[0]);
        sets_after(scene);
        return scene.meshes[0].positions.size();
    };
    EXPECT_EQ(vertices([](Mesh&) {}), 4u);
    EXPECT_EQ(vertices([](Mesh& mesh) { mesh.normals[3] = {0, 1, 0}; }), 5u);
    EXPECT_EQ(vertices([](Mesh& mesh) { mesh.colours[0].values[4 * 3 + 2] = 0.75f; }), 5u);
    EXPECT_EQ(vertices([](Mesh& mesh) { mesh.targets[0].positions[4].z = 1.0f; }), 5u);
    EXPECT_EQ(vertices([](Mesh& mesh) { mesh.attributes.push_back({"_HEAT", 0, 1, {0, 1, 2, 3, 1, 5}}); }), 5u);
    EXPECT_EQ(vertices([](Mesh& mesh) { mesh.positions[3].x = -0.0f; }), 5u) << "other bits";
    EXPECT_EQ(vertices([](Mesh& mesh) { mesh.collapse = {0, 1, 2, 0, 0, 0}; }), 6u) << "their order has a meaning";
    EXPECT_EQ(vertices([](Mesh& mesh) {
                  mesh.influences = 2;
                  mesh.palette.joints = {0, 0};
                  mesh.palette.inverse_bind.resize(2, glm::mat4(1.0f));
                  mesh.bones.assign(12, 0);
                  mesh.weights.assign(12, 0.5f);
                  mesh.bones[7] = 1;
              }),
              5u);
}

}  // namespace
}  // namespace bendy::converter::drop_unused_test
