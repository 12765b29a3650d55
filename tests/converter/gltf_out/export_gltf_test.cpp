#include <bendy/converter/build_chunks.h>
#include <bendy/converter/export.h>
#include <bendy/converter/import.h>

#include "converter/posed_scene.h"
#include "format/sample_file.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

namespace bendy::converter::export_gltf_test {
namespace {

using bendy::test::Buffer;
using nlohmann::json;

/// One joint with a triangle.
Scene triangle() {
    Scene scene;
    Joint root;
    root.name = "root";
    scene.joints.push_back(root);
    Mesh mesh;
    mesh.name = "triangle";
    mesh.joint = 0;
    mesh.positions = {{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
    mesh.submeshes.push_back({Topology::triangles, kNone, {0, 1, 2}});
    scene.meshes.push_back(mesh);
    return scene;
}

struct Exported {
    GltfAsset asset;
    json document;
    std::vector<std::string> warnings;

    [[nodiscard]] bool warns(const std::string& words) const {
        return std::any_of(warnings.begin(), warnings.end(),
                           [&](const std::string& line) { return line.find(words) != std::string::npos; });
    }
};

Exported export_scene(const Scene& scene) {
    Report report;
    const Buffer file(build_chunks(scene, "test", report));
    Report heard;
    auto asset = export_gltf(file, {}, heard);
    EXPECT_TRUE(asset) << (asset ? "" : asset.error().message);
    Exported exported;
    if (!asset) return exported;
    exported.asset = *std::move(asset);
    exported.document = json::parse(exported.asset.json);
    for (const Warning& warning : heard.warnings()) exported.warnings.push_back(warning.message);
    return exported;
}

/// What the importer makes of the export.
Scene import_again(const GltfAsset& asset) {
    const auto glb = make_glb(asset);
    EXPECT_TRUE(glb);
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    const auto path = std::filesystem::temp_directory_path() / (std::string("bendy_export_") + test->name() + ".glb");
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(glb->data()), static_cast<std::streamsize>(glb->size()));
    Report unheard;
    auto scene = import_gltf(path, {}, unheard);
    std::filesystem::remove(path);
    EXPECT_TRUE(scene) << (scene ? "" : scene.error().place + ": " + scene.error().message);
    return scene ? *std::move(scene) : Scene{};
}

TEST(ExportGltf, ATriangleIsWhatItIs) {
    const Exported exported = export_scene(triangle());
    EXPECT_TRUE(exported.warnings.empty());
    EXPECT_EQ(exported.document["asset"]["version"], "2.0");
    EXPECT_EQ(exported.document["nodes"], json::parse(R"([{"name":"root","mesh":0}])"));
    EXPECT_EQ(exported.document["accessors"][0]["max"], json::parse("[1.0,1.0,0.0]"));
    EXPECT_EQ(exported.asset.buffer.size(), 36u + 6u);
    const Scene again = import_again(exported.asset);
    EXPECT_EQ(again.meshes[0].positions, triangle().meshes[0].positions);
    EXPECT_EQ(again.meshes[0].submeshes[0].indices, triangle().meshes[0].submeshes[0].indices);
}

TEST(ExportGltf, AnObjectWithoutJointsIsASceneWithoutNodes) {
    const Exported exported = export_scene(Scene());
    EXPECT_EQ(exported.document["scenes"], json::parse("[{}]"));
    EXPECT_FALSE(exported.document.contains("nodes"));
}

TEST(ExportGltf, GlbIsPaddedAndSaysItsLengths) {
    const auto glb = make_glb({"{ }x", std::vector<std::byte>(5)});
    ASSERT_TRUE(glb);
    const auto word = [&](std::size_t at) {
        std::uint32_t value = 0;
        std::memcpy(&value, glb->data() + at, sizeof value);
        return value;
    };
    EXPECT_EQ(glb->size(), 12u + 8u + 4u + 8u + 8u);
    EXPECT_EQ(word(8), glb->size());
    EXPECT_EQ(word(12), 4u);
    EXPECT_EQ(word(24), 8u);
    EXPECT_EQ(word(28), 0x004e4942u);
}

TEST(ExportGltf, NegativeZerosAndOddFloatsKeepTheirBits) {
    Scene scene = triangle();
    scene.joints[0].rest.translation = {-0.0f, 0.1f, 1e-42f};
    scene.joints[0].rest.scale = {3.4e38f, 1.0f, -1.0f};
    const Scene again = import_again(export_scene(scene).asset);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(std::signbit(again.joints[0].rest.translation[i]), std::signbit(scene.joints[0].rest.translation[i]));
        EXPECT_EQ(again.joints[0].rest.translation[i], scene.joints[0].rest.translation[i]);
        EXPECT_EQ(again.joints[0].rest.scale[i], scene.joints[0].rest.scale[i]);
    }
}

TEST(ExportGltf, ShearIsAMatrixUnlessTheJointMoves) {
    Scene scene = triangle();
    scene.joints[0].rest.shear = {0.25f, 0.0f, 0.5f};
    const Exported still = export_scene(scene);
    EXPECT_TRUE(still.document["nodes"][0].contains("matrix"));
    const glm::vec3 shear = import_again(still.asset).joints[0].rest.shear;
    EXPECT_FLOAT_EQ(shear.x, 0.25f);
    EXPECT_FLOAT_EQ(shear.z, 0.5f);

    Clip clip;
    clip.tracks.push_back({TrackPath::translation, Interpolation::linear, 0, 3, {0.0f}, {1.0f, 2.0f, 3.0f}});
    scene.clips.push_back(clip);
    const Exported moved = export_scene(scene);
    EXPECT_FALSE(moved.document["nodes"][0].contains("matrix"));
    EXPECT_TRUE(moved.warns("shear of an animated joint left out"));
}

TEST(ExportGltf, AClipThatBeginsBeforeZeroIsMoved) {
    Scene scene = triangle();
    Clip clip;
    clip.tracks.push_back(
        {TrackPath::scale, Interpolation::step, 0, 3, {-2.0f, 1.0f}, {1.0f, 1.0f, 1.0f, 2.0f, 2.0f, 2.0f}});
    scene.clips.push_back(clip);
    const Exported exported = export_scene(scene);
    EXPECT_TRUE(exported.warns("begins before 0 s"));
    EXPECT_EQ(import_again(exported.asset).clips[0].tracks[0].times, (std::vector<float>{0.0f, 3.0f}));
}

TEST(ExportGltf, TimesThatAreMovedStillAscend) {
    Scene scene = triangle();
    Clip clip;
    const float before_one = std::nextafter(1.0f, 0.0f);  // 2, once it is moved, as 1 is
    clip.tracks.push_back(
        {TrackPath::scale, Interpolation::step, 0, 3, {-1.0f, before_one, 1.0f}, std::vector<float>(9, 1.0f)});
    scene.clips.push_back(clip);
    EXPECT_EQ(import_again(export_scene(scene).asset).clips[0].tracks[0].times,
              (std::vector<float>{0.0f, 2.0f, std::nextafter(2.0f, 3.0f)}));
}

TEST(ExportGltf, AClipLongerThanItsKeysIsHeldForItsWholeLength) {
    Scene scene = triangle();
    Clip moving;
    moving.tracks = {{TrackPath::translation, Interpolation::linear, 0, 3, {0.5f, 1.0f}, {0, 0, 0, 1, 0, 0}}};
    moving.stated_span = ClipSpan{0.25f, 3.0f};
    Clip still;
    still.stated_span = ClipSpan{0.0f, 2.5f};
    Joint child;
    child.name = "child";
    child.parent = 0;
    child.rest.translation = {0.0f, 2.0f, 0.0f};
    scene.joints.push_back(child);
    scene.clips = {moving, still};
    const Exported exported = export_scene(scene);
    EXPECT_TRUE(exported.warns("longer than its keys"));
    const Scene again = import_again(exported.asset);
    ASSERT_EQ(again.clips.size(), 2u);
    for (std::size_t clip = 0; clip < 2; ++clip) {
        float first = 1e9f;
        float last = -1e9f;
        for (const Track& track : again.clips[clip].tracks) {
            first = std::min(first, track.times.front());
            last = std::max(last, track.times.back());
        }
        EXPECT_EQ(first, scene.clips[clip].stated_span->start);
        EXPECT_EQ(last, scene.clips[clip].stated_span->end);
    }
    ASSERT_EQ(again.clips[0].tracks.size(), 2u);
    EXPECT_EQ(again.clips[0].tracks[1].target, 1u);
    EXPECT_EQ(again.clips[0].tracks[1].values, (std::vector<float>{0, 2, 0, 0, 2, 0}));
}

TEST(ExportGltf, ThatAClipRepeatsIsSaidInItsExtras) {
    Scene scene = triangle();
    Clip clip;
    clip.loop = true;
    clip.extras = R"({"mine":1})";
    clip.tracks.push_back({TrackPath::translation, Interpolation::linear, 0, 3, {0.0f}, {1.0f, 2.0f, 3.0f}});
    scene.clips.push_back(clip);
    const Exported exported = export_scene(scene);
    EXPECT_EQ(exported.document["animations"][0]["extras"], json::parse(R"({"loop":true,"mine":1})"));
    EXPECT_TRUE(import_again(exported.asset).clips[0].loop);
}

TEST(ExportGltf, MarkersStandInExtras) {
    Scene scene = triangle();
    Clip clip;
    clip.extras = R"({"mine":1})";
    clip.tracks.push_back(
        {TrackPath::translation, Interpolation::linear, 0, 3, {0.0f, 1.0f}, {1.0f, 2.0f, 3.0f, 0.0f, 0.0f, 0.0f}});
    clip.markers = {{0.1f, "left"}, {1.0f / 3.0f, ""}, {1.0f, "left"}};
    scene.clips.push_back(clip);
    scene.clips.push_back(clip);
    scene.clips[1].extras = "[7]";
    const Exported exported = export_scene(scene);
    const json& extras = exported.document["animations"][0]["extras"];
    EXPECT_EQ(extras["mine"], 1);
    EXPECT_EQ(extras["markers"][0].dump(), R"({"name":"left","time":0.1})");
    EXPECT_EQ(exported.document["animations"][1]["extras"], json::parse("[7]"));
    EXPECT_TRUE(exported.warns("markers are left out"));
    const Scene again = import_again(exported.asset);
    ASSERT_EQ(again.clips[0].markers.size(), 3u);
    EXPECT_EQ(again.clips[0].extras, clip.extras);
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(again.clips[0].markers[k].name, clip.markers[k].name);
        EXPECT_EQ(again.clips[0].markers[k].seconds, clip.markers[k].seconds);
    }
    EXPECT_TRUE(again.clips[1].markers.empty());
}

TEST(ExportGltf, MarkersMoveWithAClipThatBeginsBeforeZero) {
    Scene scene = triangle();
    Clip clip;
    clip.tracks.push_back(
        {TrackPath::scale, Interpolation::step, 0, 3, {-2.1f, 1.0f}, {1.0f, 1.0f, 1.0f, 2.0f, 2.0f, 2.0f}});
    clip.markers = {{-2.1f, "first"}, {0.0f, "middle"}, {1.0f, "last"}};
    scene.clips.push_back(clip);
    const Scene again = import_again(export_scene(scene).asset);
    ASSERT_EQ(again.clips[0].markers.size(), 3u);
    EXPECT_EQ(again.clips[0].markers[0].seconds, 0.0f);
    EXPECT_EQ(again.clips[0].markers[1].seconds, 2.1f);
    EXPECT_EQ(again.clips[0].markers[2].seconds, again.clips[0].tracks[0].times[1]);
}

TEST(ExportGltf, MeshesOfOneJointShareItsNodeOnlyIfTheyCan) {
    Scene scene = triangle();
    scene.meshes.push_back(scene.meshes[0]);  // the same name, extras, no skin
    scene.meshes[1].normals.assign(3, {0.0f, 0.0f, 1.0f});
    const Exported shared = export_scene(scene);
    EXPECT_TRUE(shared.warnings.empty());
    EXPECT_EQ(shared.document["meshes"].size(), 1u);
    EXPECT_EQ(shared.document["meshes"][0]["primitives"].size(), 2u);
    EXPECT_EQ(import_again(shared.asset).meshes.size(), 2u);

    scene.meshes[1].name = "another";
    const Exported apart = export_scene(scene);
    EXPECT_TRUE(apart.warns("gets one of its own"));
    EXPECT_EQ(apart.document["meshes"].size(), 2u);
    EXPECT_EQ(apart.document["nodes"][0]["children"], json::parse("[1]"));
    EXPECT_EQ(apart.document["nodes"][1], json::parse(R"({"name":"another","mesh":1})"));
}

TEST(ExportGltf, InfluencesOfOneJointBecomeOne) {
    Scene scene = triangle();
    scene.joints.push_back(scene.joints[0]);
    scene.joints[1].name = "tip";
    scene.joints[1].parent = 0;
    Mesh& mesh = scene.meshes[0];
    mesh.influences = 3;
    mesh.palette = {{0, 1}, {glm::mat4(1.0f), glm::mat4(1.0f)}};
    mesh.bones = {1, 0, 1, 0, 1, 0, 0, 0, 0};
    mesh.weights = {0.25f, 0.5f, 0.25f, 0.5f, 0.5f, 0.0f, 1.0f, 0.0f, 0.0f};
    const Exported exported = export_scene(scene);
    EXPECT_TRUE(exported.warns("by the same joint merged into one"));
    const Mesh again = import_again(exported.asset).meshes.at(0);
    EXPECT_EQ(again.influences, 2u);
    EXPECT_EQ(again.bones, (std::vector<std::uint32_t>{1, 0, 0, 1, 0, 0}));
    EXPECT_EQ(again.weights, (std::vector<float>{0.5f, 0.5f, 0.5f, 0.5f, 1.0f, 0.0f}));
}

TEST(ExportGltf, MeshesWhoseWeightsMoveDifferentlyStayApart) {
    Scene scene = triangle();
    scene.meshes[0].targets.emplace_back().positions.resize(3, glm::vec3(1.0f));
    scene.meshes.push_back(scene.meshes[0]);
    Clip clip;
    Track smile;
    smile.path = TrackPath::weights;
    smile.target = 0;
    smile.components = 1;
    smile.times = {0.0f, 1.0f};
    smile.values = {0.0f, 1.0f};
    clip.tracks.push_back(smile);
    scene.clips.push_back(clip);
    const Exported apart = export_scene(scene);
    EXPECT_EQ(apart.document["meshes"].size(), 2u);
    EXPECT_EQ(apart.document["animations"][0]["channels"].size(), 1u);
    smile.target = 1;
    scene.clips[0].tracks.push_back(smile);
    const Exported together = export_scene(scene);
    EXPECT_EQ(together.document["meshes"].size(), 1u);
    EXPECT_EQ(together.document["animations"][0]["channels"].size(), 1u);
}

TEST(ExportGltf, WhatGltfForbidsIsMended) {
    Scene scene = triangle();
    scene.meshes[0].normals = {{0.0f, 0.0f, 0.0f}, {0.0f, 3.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    Stream coords;
    coords.set = 2;
    coords.components = 2;
    coords.values = {0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.5f};
    scene.meshes[0].texture_coords.push_back(coords);
    const Exported exported = export_scene(scene);
    EXPECT_TRUE(exported.warns("not a unit vector, normalised"));
    EXPECT_TRUE(exported.warns("TEXCOORD_1 is written as zeros"));
    const Mesh again = import_again(exported.asset).meshes[0];
    EXPECT_EQ(again.normals[0], glm::vec3(0.0f, 0.0f, 1.0f));
    EXPECT_EQ(again.normals[1], glm::vec3(0.0f, 1.0f, 0.0f));
    ASSERT_EQ(again.texture_coords.size(), 3u);
    EXPECT_EQ(again.texture_coords[2].values, coords.values);
}

TEST(ExportGltf, ATargetThatTouchesLittleIsSparse) {
    Scene scene = triangle();
    Mesh& mesh = scene.meshes[0];
    mesh.positions.resize(100, glm::vec3(1.0f));
    MorphTarget target;
    target.name = "smile";
    target.rest_weight = 0.25f;
    target.positions.assign(100, glm::vec3(0.0f));
    target.positions[7] = {0.0f, 0.5f, 0.0f};
    mesh.targets.push_back(target);
    const Exported exported = export_scene(scene);
    const std::size_t number = exported.document["meshes"][0]["primitives"][0]["targets"][0]["POSITION"];
    const json& accessor = exported.document["accessors"][number];
    EXPECT_EQ(accessor["sparse"]["count"], 1);
    EXPECT_FALSE(accessor.contains("bufferView"));
    EXPECT_EQ(accessor["max"], json::parse("[0.0,0.5,0.0]"));
    const Mesh again = import_again(exported.asset).meshes[0];
    EXPECT_EQ(again.targets[0].positions, target.positions);
    EXPECT_EQ(again.targets[0].name, "smile");
    EXPECT_EQ(again.targets[0].rest_weight, 0.25f);
}

TEST(ExportGltf, MoreThanFourInfluencesTakeSeveralSets) {
    Scene scene = triangle();
    Mesh& mesh = scene.meshes[0];
    for (std::uint32_t i = 0; i < 6; ++i) {
        if (i > 0) scene.joints.push_back(scene.joints[0]);
        if (i > 0) scene.joints[i].parent = 0;
        mesh.palette.joints.push_back(i);
        mesh.palette.inverse_bind.emplace_back(1.0f);
    }
    mesh.influences = 6;
    for (std::size_t v = 0; v < 3; ++v) {
        mesh.bones.insert(mesh.bones.end(), {0, 1, 2, 3, 4, 5});
        mesh.weights.insert(mesh.weights.end(), {0.25f, 0.25f, 0.125f, 0.125f, 0.125f, 0.125f});
    }
    const Exported exported = export_scene(scene);
    EXPECT_TRUE(exported.document["meshes"][0]["primitives"][0]["attributes"].contains("WEIGHTS_1"));
    const Mesh again = import_again(exported.asset).meshes[0];
    EXPECT_EQ(again.influences, 6u);
    EXPECT_EQ(again.bones, mesh.bones);
    EXPECT_EQ(again.weights, mesh.weights);
}

/// The Khronos validator's rule, as it adds: floats, component by component, of all sets.
bool is_valid_sum(const std::vector<float>& weights) {
    volatile float sum = 0.0f;
    double tolerance = 0.0;
    for (std::size_t component = 0; component < 4; ++component) {
        for (std::size_t i = component; i < weights.size(); i += 4) {
            sum = sum + weights[i];
            if (weights[i] != 0.0f) tolerance += 2e-7;
        }
    }
    return std::abs(double{sum} - 1.0) <= tolerance;
}

TEST(ExportGltf, WeightsSumToOneInFloats) {
    for (const std::vector<float>& weights :
         {std::vector<float>{0.2f, 0.2f, 0.2f, 0.2f, 0.199999f},
          {0.500005f, 0.5f},
          {0.1f, 0.599991f, 0.3f},
          {0.25f, 0.25f, 0.125f, 0.125f, 0.125f, 0.0625f, 0.03125f, 0.0312406f, 0.0f}}) {
        Scene scene = triangle();
        Mesh& mesh = scene.meshes[0];
        mesh.influences = static_cast<std::uint32_t>(weights.size());
        for (std::uint32_t i = 0; i < mesh.influences; ++i) {
            if (i > 0) scene.joints.push_back(scene.joints[0]);
            if (i > 0) scene.joints[i].parent = 0;
            mesh.palette.joints.push_back(i);
            mesh.palette.inverse_bind.emplace_back(1.0f);
        }
        std::vector<float> even(weights.size(), 0.0f);
        even[0] = 1.0f;
        for (const auto& own : {weights, even, weights}) {
            mesh.weights.insert(mesh.weights.end(), own.begin(), own.end());
            for (std::uint32_t i = 0; i < mesh.influences; ++i) mesh.bones.push_back(own[i] != 0.0f ? i : 0);
        }
        ASSERT_FALSE(is_valid_sum(weights));
        const Exported exported = export_scene(scene);
        EXPECT_TRUE(exported.warns("added as 32-bit floats, are not 1 as glTF demands"));
        const Mesh again = import_again(exported.asset).meshes[0];
        const auto n = static_cast<std::ptrdiff_t>(again.influences);
        for (std::ptrdiff_t v = 0; v < 3; ++v) {
            const std::vector<float> own(again.weights.begin() + v * n, again.weights.begin() + (v + 1) * n);
            EXPECT_TRUE(is_valid_sum(own));
            int changed = 0;
            for (std::size_t i = 0; i < own.size(); ++i) changed += own[i] != (v == 1 ? even : weights)[i] ? 1 : 0;
            EXPECT_EQ(changed, v == 1 ? 0 : 1) << "one weight takes the difference";
        }
    }
}

TEST(ExportGltf, ATargetBesideNamedOnesGetsAName) {
    const auto written = [](const std::vector<std::string>& names, const std::string& extras, std::uint64_t unnamed) {
        Scene scene = triangle();
        scene.meshes[0].extras = extras;
        for (const std::string& name : names) {
            MorphTarget target;
            target.name = name;
            target.positions.assign(3, glm::vec3(0.0f, 0.0f, 1.0f));
            scene.meshes[0].targets.push_back(target);
        }
        const Exported exported = export_scene(scene);
        EXPECT_EQ(exported.warns("a morph target without a name"), unnamed != 0);
        const json& mesh = exported.document["meshes"][0];
        return mesh.contains("extras") ? mesh["extras"] : json();
    };
    EXPECT_EQ(written({"Smile", "", "Frown"}, "", 1), json::parse(R"({"targetNames":["Smile","target_1","Frown"]})"));
    EXPECT_EQ(written({"Smile", ""}, R"({"targetNames":["Smile"]})", 1),
              json::parse(R"({"targetNames":["Smile","target_1"]})"));
    EXPECT_EQ(written({"target_1", "", ""}, R"({"targetNames":["target_1","",""]})", 2),
              json::parse(R"({"targetNames":["target_1","target_1_","target_2"]})"));
    EXPECT_EQ(written({"Smile", ""}, R"({"targetNames":["Smile",null]})", 0),
              json::parse(R"({"targetNames":["Smile",null]})"));
    EXPECT_EQ(written({"", ""}, "", 0), json());
    EXPECT_EQ(written({"", ""}, R"({"targetNames":["",""]})", 0), json());
    EXPECT_EQ(written({"", ""}, R"({"targetNames":["",""],"x":1})", 0), json::parse(R"({"x":1})"));
}

TEST(ExportGltf, EveryExtensionThatIsUsedIsListed) {
    Scene scene = triangle();
    scene.extensions = R"({"KHR_a":{"deep":[{"extensions":{"KHR_b":{}}}],"extras":{"extensions":{"KHR_no":{}}}}})";
    scene.joints[0].extensions = R"({"KHR_c":{},"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":7}}})";
    Material material;
    material.unlit = true;
    scene.materials.push_back(material);
    const Exported exported = export_scene(scene);
    EXPECT_EQ(exported.document["extensionsUsed"], json::parse(R"(["KHR_a","KHR_b","KHR_c","KHR_materials_unlit"])"));
    EXPECT_TRUE(exported.warns("EXT_mesh_gpu_instancing"));
}

TEST(ExportGltf, SurfacesKeepWhatTheirModeDoesNotUse) {
    Scene scene = triangle();
    scene.materials.resize(2);
    scene.materials[0].alpha_cutoff = 0.25f;
    scene.materials[1].alpha_mode = AlphaMode::blend;
    const Exported exported = export_scene(scene);
    EXPECT_EQ(exported.document["materials"],
              json::parse(R"([{"alphaCutoff":0.25,"alphaMode":"OPAQUE"},{"alphaMode":"BLEND"}])"));
    EXPECT_EQ(import_again(exported.asset).materials[0].alpha_cutoff, 0.25f);
}

TEST(ExportGltf, AnAttributeThatGltfWouldNotKnowGetsAnUnderscore) {
    Scene scene = triangle();
    Stream heat;
    heat.name = "HEAT";
    heat.components = 1;
    heat.values = {1.0f, 2.0f, 3.0f};
    scene.meshes[0].attributes.push_back(heat);
    const Exported exported = export_scene(scene);
    EXPECT_TRUE(exported.warns("underscore"));
    EXPECT_EQ(import_again(exported.asset).meshes[0].attributes[0].name, "_HEAT");
}

TEST(ExportGltf, WhatIsNoJsonIsNamed) {
    Scene scene = triangle();
    scene.joints[0].extras = "{half";
    const Exported exported = export_scene(scene);
    EXPECT_TRUE(exported.warns("extras left out"));
    EXPECT_FALSE(exported.document["nodes"][0].contains("extras"));
}

TEST(ExportGltf, ExtrasTooDeepForTheDocumentAreNamed) {
    Scene scene = triangle();
    const auto nested = [](std::size_t levels) { return std::string(levels, '[') + std::string(levels, ']'); };
    scene.joints[0].extras = nested(120);
    EXPECT_EQ(import_again(export_scene(scene).asset).joints[0].extras, nested(120));
    scene.joints[0].extras = nested(121);
    const Exported exported = export_scene(scene);
    EXPECT_TRUE(exported.warns("nested deeper than 120 levels"));
    EXPECT_EQ(import_again(exported.asset).joints[0].extras, "");
}

TEST(ExportGltf, ABrokenFileIsRefused) {
    Buffer file = bendy::test::sample_file();
    file[40] = static_cast<std::byte>(std::to_integer<int>(file[40]) ^ 1);
    Report report;
    const auto asset = export_gltf(file, {}, report);
    ASSERT_FALSE(asset);
    EXPECT_NE(asset.error().message.find("HEAD/VERS"), std::string::npos) << asset.error().message;
}

TEST(ExportGltf, ASplineThroughNoRotationLosesThatKey) {
    Scene scene = triangle();
    Track still{TrackPath::translation, Interpolation::linear, 0, 3, {0.0f}, {1.0f, 0.0f, 0.0f}};
    Track spline{TrackPath::rotation, Interpolation::cubic, 0, 4, {0.0f, 1.0f}, std::vector<float>(24, 0.0f)};
    spline.values[7] = 1.0f;  // the first key's w; the second's stays 0
    scene.clips.emplace_back().tracks = {still, spline};
    const Exported exported = export_scene(scene);
    EXPECT_TRUE(exported.warns("rotation key is (0, 0, 0, 0), which glTF cannot hold, left out"));
    const Scene again = import_again(exported.asset);
    ASSERT_EQ(again.clips.at(0).tracks.size(), 2u);
    EXPECT_EQ(again.clips[0].tracks[1].times, (std::vector<float>{0.0f}));
    EXPECT_EQ(again.clips[0].tracks[1].values[7], 1.0f);

    scene.clips[0].tracks[1].values[7] = 0.0f;
    EXPECT_EQ(import_again(export_scene(scene).asset).clips.at(0).tracks.size(), 1u);
}

TEST(ExportGltf, ASetOfCoordinatesPastReadersIntegersTakesItsTextureAlong) {
    Scene scene = triangle();
    scene.images.emplace_back().uri = "wood.png";
    scene.textures.emplace_back().images = {0};
    Material& material = scene.materials.emplace_back();
    material.base_colour_texture.texture = material.normal_texture.texture = 0;
    material.base_colour_texture.coords = 0x7fffffff;
    material.normal_texture.coords = 0x80000000;
    material.normal_scale = 0.5f;
    const Exported exported = export_scene(scene);
    EXPECT_TRUE(exported.warns("texture left out: glTF has no set 2147483648"));
    const json& written = exported.document["materials"][0];
    EXPECT_EQ(written["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"], 0x7fffffff);
    EXPECT_FALSE(written.contains("normalTexture"));
}

TEST(ExportGltf, RandomCharactersComeBack) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        const Scene scene = test::random_scene(seed);
        const Scene again = import_again(export_scene(scene).asset);
        ASSERT_EQ(again.joints.size(), scene.joints.size());
        ASSERT_EQ(again.meshes.size(), scene.meshes.size());
        for (std::size_t i = 0; i < scene.meshes.size(); ++i)
            EXPECT_EQ(again.meshes[i].positions, scene.meshes[i].positions);
        ASSERT_EQ(again.clips.size(), scene.clips.size());
        for (std::size_t i = 0; i < scene.clips.size(); ++i) {
            ASSERT_EQ(again.clips[i].tracks.size(), scene.clips[i].tracks.size());
            for (std::size_t t = 0; t < scene.clips[i].tracks.size(); ++t)
                EXPECT_EQ(again.clips[i].tracks[t].times, scene.clips[i].tracks[t].times);
        }
    }
}

}  // namespace
}  // namespace bendy::converter::export_gltf_test
