#include "build_gltf.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/export.h>
#include <bendy/converter/import.h>
#include <bendy/format/document.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <tuple>

namespace bendy::converter::curves_test {
namespace {

using namespace test;

/// Two named nodes, of which the first draws a triangle with two morph targets; a material, a texture, a camera, a
/// light.
Gltf make_stage() {
    Gltf gltf = make_triangle();
    gltf.primitive()["targets"] = {{{"POSITION", gltf.add_positions(3)}}, {{"POSITION", gltf.add_positions(3)}}};
    gltf.primitive()["material"] = 0;
    gltf.add_node(
        {{"name", "lamp"},
         {"camera", 1},
         {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}, {"KHR_node_visibility", {{"visible", true}}}}}});
    gltf.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 2.0}, {"znear", 0.1}}}},
                            {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}}};
    gltf.json["images"] = {{{"uri", "there.png"}}};
    gltf.json["textures"] = {{{"source", 0}}};
    gltf.json["materials"] = {{{"name", "paint"}, {"emissiveTexture", {{"index", 0}}}}};
    gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    gltf.json["extensionsUsed"] = {"KHR_animation_pointer", "KHR_lights_punctual", "KHR_node_visibility"};
    gltf.json["animations"] = {{{"name", "show"}, {"samplers", Json::array()}, {"channels", Json::array()}}};
    return gltf;
}

/// Adds a channel to the animation; its number.
std::size_t add_pointer(Gltf& gltf, const std::string& pointer, std::size_t input, std::size_t output,
                        const char* interpolation = "LINEAR") {
    Json& animation = gltf.json["animations"][0];
    animation["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size() - 1},
         {"target", {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}});
    return animation["channels"].size() - 1;
}

/// One channel from 0 to 1 s of so many zeros for each key.
std::size_t add_pointer(Gltf& gltf, const std::string& pointer, const char* type = "SCALAR") {
    const std::size_t input = gltf.add_accessor<float>({0, 1}, "SCALAR");
    const std::size_t output = gltf.add_accessor(std::vector<float>(2 * components_of(type)), type);
    return add_pointer(gltf, pointer, input, output);
}

const std::vector<Curve>& curves_of(const Import& import) {
    return import->clips.at(0).curves;
}

TEST(GltfCurves, PointersBecomeCurvesOfTheirTargets) {
    Gltf gltf = make_stage();
    const std::size_t input = gltf.add_accessor<float>({0.5f, 2}, "SCALAR");
    const std::size_t channel = add_pointer(gltf, "/materials/0/pbrMetallicRoughness/baseColorFactor", input,
                                            gltf.add_accessor<float>({1, 2, 3, 4, 5, 6, 7, 8}, "VEC4"), "STEP");
    gltf.json["animations"][0]["channels"][channel]["extras"] = {{"name", "Fade"}};
    add_pointer(gltf, "/nodes/1/extensions/KHR_node_visibility/visible", input,
                gltf.add_accessor<std::uint8_t>({1, 0}, "SCALAR"), "STEP");
    add_pointer(gltf, "/textures/0/extras/glow", "VEC2");
    add_pointer(gltf, "/extensions/KHR_lights_punctual/lights/0/color", "VEC3");
    add_pointer(gltf, "/cameras/1/perspective/yfov");
    add_pointer(gltf, "/meshes/0/extras/heat");
    add_pointer(gltf, "/materials/0/emissiveFactor", input,
                gltf.add_accessor<float>({0, 0, 0, 1, 2, 3, 0, 0, 0, 0, 0, 0, 4, 5, 6, 0, 0, 0}, "VEC3"),
                "CUBICSPLINE");
    const Import import = gltf.import();
    const auto& curves = curves_of(import);
    ASSERT_EQ(curves.size(), 7u);
    EXPECT_EQ(curves[0].name, "Fade");
    EXPECT_EQ(curves[0].path, "pbrMetallicRoughness/baseColorFactor");
    EXPECT_EQ(curves[0].kind, CurveTarget::material);
    EXPECT_EQ(curves[0].target, 0u);
    EXPECT_EQ(curves[0].components, 4u);
    EXPECT_EQ(curves[0].interpolation, Interpolation::step);
    EXPECT_EQ(curves[0].times, (std::vector<float>{0.5f, 2}));
    EXPECT_EQ(curves[0].values, (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8}));
    EXPECT_EQ(curves[1].kind, CurveTarget::joint);
    EXPECT_EQ(curves[1].target, 1u);
    EXPECT_EQ(curves[1].path, "extensions/KHR_node_visibility/visible");
    EXPECT_EQ(curves[1].values, (std::vector<float>{1, 0}));
    EXPECT_EQ(curves[2].kind, CurveTarget::texture);
    EXPECT_EQ(curves[2].components, 2u);
    EXPECT_EQ(curves[3].kind, CurveTarget::nothing);
    EXPECT_EQ(curves[3].target, kNone);
    EXPECT_EQ(curves[3].path, "/extensions/KHR_lights_punctual/lights/0/color");
    EXPECT_EQ(curves[4].kind, CurveTarget::joint);
    EXPECT_EQ(curves[4].target, 1u);
    EXPECT_EQ(curves[4].path, "camera/perspective/yfov");
    EXPECT_EQ(curves[5].kind, CurveTarget::mesh);
    EXPECT_EQ(curves[6].interpolation, Interpolation::cubic);
    EXPECT_EQ(curves[6].components, 3u);
    EXPECT_EQ(import.warned("KHR_animation_pointer"), 0u);
    EXPECT_EQ(import.warned("animation channels"), 0u);
}

TEST(GltfCurves, AFileThatRequiresTheExtensionConverts) {
    Gltf gltf = make_stage();
    gltf.json["extensionsRequired"] = {"KHR_animation_pointer"};
    add_pointer(gltf, "/materials/0/alphaCutoff");
    EXPECT_EQ(curves_of(gltf.import()).size(), 1u);
}

TEST(GltfCurves, TransformsAndWeightsBecomeTracks) {
    Gltf gltf = make_stage();
    add_pointer(gltf, "/nodes/1/translation", "VEC3");
    const std::size_t input = gltf.add_accessor<float>({0, 1}, "SCALAR");
    add_pointer(gltf, "/nodes/1/rotation", input, gltf.add_accessor<float>({0, 0, 0, 2, 0, 0, 1, 0}, "VEC4"));
    add_pointer(gltf, "/meshes/0/weights", input, gltf.add_accessor<float>({1, 2, 3, 4}, "SCALAR"));
    const Import import = gltf.import();
    const auto& tracks = import->clips.at(0).tracks;
    ASSERT_EQ(tracks.size(), 3u);
    EXPECT_EQ(tracks[0].path, TrackPath::translation);
    EXPECT_EQ(tracks[0].target, 1u);
    EXPECT_EQ(tracks[1].values, (std::vector<float>{0, 0, 0, 1, 0, 0, 1, 0}));
    EXPECT_EQ(import.warned("not a unit quaternion, normalised"), 1u);
    EXPECT_EQ(tracks[2].path, TrackPath::weights);
    EXPECT_EQ(tracks[2].values, (std::vector<float>{1, 2, 3, 4}));
    EXPECT_TRUE(curves_of(import).empty());
}

TEST(GltfCurves, WhatNoCurveCanHoldIsNamedAndCounted) {
    Gltf gltf = make_stage();
    gltf.add_node({{"name", "behind"}});
    gltf.json["scenes"] = {{{"nodes", {0, 1}}}};
    const std::size_t input = gltf.add_accessor<float>({0, 1}, "SCALAR");
    add_pointer(gltf, "/materials/0/extras/matrix", "MAT4");
    add_pointer(gltf, "/materials/0/extras/square", "MAT2");
    add_pointer(gltf, "/materials/0/extras/five", input, gltf.add_accessor(std::vector<float>(10), "SCALAR"));
    add_pointer(gltf, "/materials/0/extras/id", input, gltf.add_accessor<std::uint32_t>({1, 2}, "SCALAR"));
    add_pointer(gltf, "/nodes/0/weights/1");
    add_pointer(gltf, "/nodes/2/extras/x");
    add_pointer(gltf, "/cameras/0/perspective/yfov");
    add_pointer(gltf, "/meshes/0/primitives/0/material");
    add_pointer(gltf, "/materials/0");
    const Import import = gltf.import();
    EXPECT_TRUE(curves_of(import).empty());
    EXPECT_EQ(import.warned("more than 4 numbers, or with 32-bit integers left out: '/materials/0/extras/matrix'"), 4u);
    EXPECT_EQ(import.warned("channels of one morph target's weight left out: '/nodes/0/weights/1'"), 1u);
    EXPECT_EQ(import.warned("channels of nodes outside the chosen scene left out"), 1u);
    EXPECT_EQ(import.warned("channels of cameras that no node of the scene has left out"), 1u);
    EXPECT_EQ(import.warned("channels of a mesh that animate its vertices or extensions left out"), 1u);
    EXPECT_EQ(import.warned("channels whose pointer names a whole object left out: '/materials/0'"), 1u);
}

TEST(GltfCurves, IntegersCountAsTheySay) {
    Gltf gltf = make_stage();
    const std::size_t input = gltf.add_accessor<float>({0, 1}, "SCALAR");
    add_pointer(gltf, "/materials/0/alphaCutoff", input, gltf.add_accessor<std::uint8_t>({0, 255}, "SCALAR", true));
    add_pointer(gltf, "/extras/count", input, gltf.add_accessor<std::int16_t>({-3, 700}, "SCALAR"));
    add_pointer(gltf, "/extras/pair", input, gltf.add_accessor<float>({1, 2, 3, 4}, "SCALAR"));
    const Import import = gltf.import();
    EXPECT_EQ(curves_of(import).at(0).values, (std::vector<float>{0, 1}));
    EXPECT_EQ(curves_of(import).at(1).values, (std::vector<float>{-3, 700}));
    EXPECT_EQ(curves_of(import).at(2).components, 2u);
}

TEST(GltfCurves, TheLastChannelOfAPropertyIsTaken) {
    Gltf gltf = make_stage();
    const std::size_t input = gltf.add_accessor<float>({0, 1}, "SCALAR");
    add_pointer(gltf, "/extras/a");
    add_pointer(gltf, "/extras/a", input, gltf.add_accessor<float>({7, 8}, "SCALAR"));
    const Import import = gltf.import();
    EXPECT_EQ(import.warned("second channel for the same target, the last one is taken"), 1u);
    ASSERT_EQ(curves_of(import).size(), 1u);
    EXPECT_EQ(curves_of(import)[0].values, (std::vector<float>{7, 8}));
}

TEST(GltfCurves, WhatIsWrongIsSaidWithItsPlace) {
    const auto import_pointer = [](const Json& pointer) {
        Gltf gltf = make_stage();
        const std::size_t channel = add_pointer(gltf, "/");
        gltf.json["animations"][0]["channels"][channel]["target"]["extensions"]["KHR_animation_pointer"]["pointer"] =
            pointer;
        return gltf.import();
    };
    const std::string place = "animations[0].channels[0].target.extensions.KHR_animation_pointer.pointer";
    for (const auto& [pointer, message] : {std::pair("/nodes/9/translation", "nodes[9] does not exist (there are 2)"),
                                           {"/materials/1/alphaCutoff", "materials[1] does not exist (there are 1)"},
                                           {"/textures/18446744073709551616/x", "expected an index after /textures/"},
                                           {"/nodes/01/translation", "expected an index after /nodes/, found '01'"},
                                           {"/nodes/-1/translation", "expected an index after /nodes/, found '-1'"},
                                           {"/meshes//weights", "expected an index after /meshes/, found ''"},
                                           {"/cameras", "expected an index after /cameras/, found ''"},
                                           {"nodes/0/translation", "expected a JSON pointer"},
                                           {"", "expected a JSON pointer"}}) {
        const Import import = import_pointer(pointer);
        EXPECT_EQ(import.place(), place) << pointer;
        EXPECT_NE(import.message().find(message), std::string::npos) << import.message();
    }
    EXPECT_EQ(import_pointer(7).message(), "it must be a string, not 7");
    EXPECT_EQ(import_pointer(nullptr).place(), place);
}

TEST(GltfCurves, KeysAreCheckedAsThoseOfOtherChannels) {
    const auto error_of = [](const std::vector<float>& times, const std::vector<float>& values, const char* type) {
        Gltf gltf = make_stage();
        const std::size_t input = gltf.add_accessor(times, "SCALAR");
        add_pointer(gltf, "/extras/x", input, gltf.add_accessor(values, type));
        return gltf.import().place();
    };
    EXPECT_EQ(error_of({0, 1}, {1, 2, 3}, "SCALAR"), "animations[0].samplers[0].output");
    EXPECT_EQ(error_of({0, 1}, {1, 2}, "VEC2"), "animations[0].samplers[0].output");
    EXPECT_EQ(error_of({1, 0}, {1, 2}, "SCALAR"), "animations[0].samplers[0].input");
    EXPECT_EQ(error_of({0, 1}, {1, std::numeric_limits<float>::quiet_NaN()}, "SCALAR"),
              "animations[0].samplers[0].output");
    EXPECT_EQ(error_of({0, 1, 2}, {1}, "SCALAR"), "animations[0].samplers[0].output");
}

TEST(GltfCurves, OtherMembersOfTheChannelAreNamed) {
    Gltf gltf = make_stage();
    const std::size_t channel = add_pointer(gltf, "/extras/x");
    Json& json = gltf.json["animations"][0]["channels"][channel];
    json["extras"] = {{"name", "x"}, {"mine", 1}};
    json["target"]["node"] = 1;
    json["target"]["extensions"]["KHR_animation_pointer"]["extras"] = 2;
    json["target"]["extensions"]["EXT_other"] = Json::object();
    const Import import = gltf.import();
    EXPECT_EQ(curves_of(import).at(0).name, "x");
    EXPECT_EQ(import.warned("extras of animation channels left out"), 2u);
    EXPECT_EQ(import.warned("node of a channel that animates a pointer left out"), 1u);
    EXPECT_EQ(import.warned("extension left out: 'EXT_other'"), 1u);
}

// --- there and back

using Buffer = std::vector<std::byte>;

Buffer build(const Scene& scene) {
    Report report;
    Buffer bytes = build_chunks(scene, "test", report);
    const Faults faults = validate(bytes);
    EXPECT_TRUE(faults.empty()) << static_cast<int>(faults.list().front().code);
    return bytes;
}

struct Exported {
    GltfAsset asset;
    Json json;
    Report report;
};

Exported export_file(const Buffer& bytes) {
    Exported exported;
    auto asset = export_gltf(bytes, {}, exported.report);
    EXPECT_TRUE(asset) << (asset ? "" : asset.error().message);
    if (!asset) return exported;
    exported.asset = *std::move(asset);
    exported.json = Json::parse(exported.asset.json);
    return exported;
}

Scene import_again(const GltfAsset& asset) {
    const auto glb = make_glb(asset);
    EXPECT_TRUE(glb);
    return *import_bytes(*glb);
}

Gltf every_curve() {
    Gltf gltf = make_stage();
    add_pointer(gltf, "/materials/0/pbrMetallicRoughness/baseColorFactor", "VEC4");
    add_pointer(gltf, "/materials/0/emissiveTexture/extensions/KHR_texture_transform/offset", "VEC2");
    const std::size_t named = add_pointer(gltf, "/nodes/1/extensions/KHR_node_visibility/visible");
    gltf.json["animations"][0]["channels"][named]["extras"] = {{"name", "Blink"}};
    add_pointer(gltf, "/nodes/0/extras/not~1there/x");
    add_pointer(gltf, "/textures/0/extras/glow");
    add_pointer(gltf, "/meshes/0/extras/heat");
    add_pointer(gltf, "/extensions/KHR_lights_punctual/lights/0/color", "VEC3");
    add_pointer(gltf, "/cameras/1/perspective/yfov");
    add_pointer(gltf, "/nodes/1/translation", "VEC3");
    const std::size_t input = gltf.add_accessor<float>({0.25f, 3}, "SCALAR");
    add_pointer(gltf, "/extras/cubic", input, gltf.add_accessor<float>({0, 1, 2, 3, 4, 5}, "SCALAR"), "CUBICSPLINE");
    return gltf;
}

TEST(GltfCurves, RoundTripGivesTheSameBytes) {
    const Import import = every_curve().import();
    ASSERT_EQ(curves_of(import).size(), 9u);
    const Buffer first = build(*import);
    const Exported exported = export_file(first);
    const auto& used = exported.json["extensionsUsed"];
    EXPECT_NE(std::find(used.begin(), used.end(), "KHR_animation_pointer"), used.end());
    std::vector<std::string> pointers;
    for (const Json& channel : exported.json["animations"][0]["channels"]) {
        if (channel["target"]["path"] == "pointer")
            pointers.push_back(channel["target"]["extensions"]["KHR_animation_pointer"]["pointer"]);
    }
    EXPECT_EQ(pointers.size(), 9u);
    EXPECT_EQ(pointers.at(7), "/cameras/0/perspective/yfov");  // the only camera that a node has
    const Scene again = import_again(exported.asset);
    EXPECT_EQ(again.clips.at(0).curves.at(2).name, "Blink");
    const Buffer second = build(again);
    // Who made a file is not the same; the rest is.
    const Buffer third = build(import_again(export_file(second).asset));
    EXPECT_EQ(second, third);
    ASSERT_EQ(again.clips[0].curves.size(), import->clips[0].curves.size());
    for (std::size_t c = 0; c < again.clips[0].curves.size(); ++c) {
        const Curve& here = import->clips[0].curves[c];
        const Curve& there = again.clips[0].curves[c];
        EXPECT_EQ(std::tie(here.name, here.path, here.kind, here.target, here.interpolation, here.components,
                           here.times, here.values),
                  std::tie(there.name, there.path, there.kind, there.target, there.interpolation, there.components,
                           there.times, there.values))
            << here.path;
    }
}

/// The pointers of an export's first animation.
std::vector<std::string> pointers_of(const Json& exported) {
    std::vector<std::string> pointers;
    for (const Json& channel : exported["animations"][0]["channels"])
        pointers.push_back(channel["target"]["extensions"]["KHR_animation_pointer"]["pointer"]);
    return pointers;
}

TEST(GltfCurves, EqualCamerasStayApartIfACurveMovesOne) {
    Gltf gltf = make_stage();
    gltf.json["cameras"][0] = gltf.json["cameras"][1];
    gltf.add_node({{"camera", 0}});
    gltf.add_node({{"camera", 0}});
    add_pointer(gltf, "/cameras/1/perspective/yfov");
    const Import import = gltf.import();
    ASSERT_EQ(curves_of(import).size(), 1u);
    const Exported exported = export_file(build(*import));
    ASSERT_EQ(exported.json["cameras"].size(), 2u);
    const Json& nodes = exported.json["nodes"];
    EXPECT_NE(nodes[1]["camera"], nodes[2]["camera"]);
    EXPECT_EQ(nodes[2]["camera"], nodes[3]["camera"]) << "nothing moves these two";
    EXPECT_EQ(pointers_of(exported.json), (std::vector<std::string>{"/cameras/0/perspective/yfov"}));
    const Scene again = import_again(exported.asset);
    ASSERT_EQ(again.clips.at(0).curves.size(), 1u);
    EXPECT_EQ(again.clips[0].curves[0].target, 1u);
}

TEST(GltfCurves, ASharedCameraStaysShared) {
    Gltf gltf = make_stage();
    gltf.add_node({{"camera", 1}});
    add_pointer(gltf, "/cameras/1/perspective/yfov");
    const Import import = gltf.import();
    ASSERT_EQ(curves_of(import).size(), 2u) << "one for each joint that has it";
    const Exported exported = export_file(build(*import));
    EXPECT_EQ(exported.json["cameras"].size(), 1u);
    EXPECT_EQ(pointers_of(exported.json), (std::vector<std::string>{"/cameras/0/perspective/yfov"}));
    EXPECT_EQ(import_again(exported.asset).clips.at(0).curves.size(), 2u);
}

TEST(GltfCurves, ACameraOfMillionsIsBounded) {
    Gltf gltf = make_stage();
    for (int node = 0; node < 3000; ++node) gltf.add_node({{"camera", 1}});
    const std::size_t input = gltf.add_accessor<float>({0, 1}, "SCALAR");
    gltf.json["accessors"][input]["count"] = 1;
    for (int curve = 0; curve < 1000; ++curve)
        add_pointer(gltf, "/cameras/1/extras/" + std::to_string(curve), input, input);
    EXPECT_EQ(gltf.import().message(), "the decoded data would be implausibly large");
}

TEST(GltfCurves, OurFilesComeBackByteForByte) {
    const Buffer file = build(*every_curve().import());
    Report report;
    const auto scene = import_bendy(file, report);
    ASSERT_TRUE(scene);
    EXPECT_EQ(build(*scene), file);
    EXPECT_EQ(scene->clips[0].curves.size(), 9u);
    for (const Warning& warning : report.warnings())
        EXPECT_EQ(warning.message.find("chunk that is not read"), std::string::npos) << warning.message;
}

TEST(GltfCurves, ACurveWithoutItsPropertyIsNotExported) {
    Gltf gltf = make_stage();
    add_pointer(gltf, "/materials/0/normalTexture/scale");
    add_pointer(gltf, "/extensions/KHR_lights_punctual/lights/3/color");
    add_pointer(gltf, "/nodes/1/extensions/EXT_none/x");
    const Exported exported = export_file(build(*gltf.import()));
    EXPECT_FALSE(exported.json.contains("animations"));
    EXPECT_FALSE(exported.json["nodes"][1]["extensions"].contains("EXT_none"));
    std::uint64_t named = 0;
    for (const Warning& warning : exported.report.warnings())
        named += warning.message.find("curve left out: the file has no '/") == 0 ? warning.count : 0;
    EXPECT_EQ(named, 3u);
}

TEST(GltfCurves, AClipMayHaveNothingElse) {
    Gltf gltf = make_stage();
    add_pointer(gltf, "/materials/0/alphaCutoff");
    gltf.json["animations"][0]["extras"] = {{"markers", {{{"time", 0.5}, {"name", "half"}}}}};
    const Import import = gltf.import();
    EXPECT_EQ(import->clips[0].markers.size(), 1u);
    const Exported exported = export_file(build(*import));
    EXPECT_EQ(exported.json["animations"].size(), 1u);
    EXPECT_EQ(exported.json["animations"][0]["name"], "show");
}

TEST(GltfCurves, XFilesHaveNoPlaceForThem) {
    Gltf gltf = make_stage();
    add_pointer(gltf, "/materials/0/alphaCutoff");
    add_pointer(gltf, "/nodes/1/translation", "VEC3");
    const Buffer file = build(*gltf.import());
    Report report;
    ASSERT_TRUE(export_x(file, "image", report));
    const auto& warnings = report.warnings();
    EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const Warning& warning) {
        return warning.message.find("named curves left out of a clip") == 0 && warning.count == 1;
    }));
}

}  // namespace
}  // namespace bendy::converter::curves_test
