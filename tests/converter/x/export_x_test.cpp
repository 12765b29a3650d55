#include <bendy/converter/build_chunks.h>
#include <bendy/converter/convert.h>
#include <bendy/converter/export.h>
#include <bendy/converter/import.h>
#include <bendy/format/document.h>
#include <bendy/format/file.h>

#include "converter/posed_scene.h"
#include "source_folder.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace bendy::converter::export_x_test {
namespace {

const std::filesystem::path kSource = source_folder();

struct Trip {
    Scene before;
    Scene after;
    XAsset asset;
    Report losses;  ///< what the export has named
};

/// bendy, X-file, Scene.
Trip travel(const std::vector<std::byte>& bytes) {
    Trip trip;
    Report unheard;
    const auto before = import_bendy(bytes, unheard);
    EXPECT_TRUE(before);
    const auto asset = export_x(bytes, "image", trip.losses);
    EXPECT_TRUE(asset) << (asset ? "" : asset.error().message);
    if (!before || !asset) return trip;
    const auto after = import_x(asset->text, "image.x", {.embed_images = false}, unheard);
    EXPECT_TRUE(after) << (after ? "" : after.error().place + ": " + after.error().message);
    if (!after) return trip;
    EXPECT_TRUE(validate(build_chunks(*after, "test", unheard)).empty());
    trip.before = *before;
    trip.after = *after;
    trip.asset = *asset;
    return trip;
}

Trip travel(const Scene& scene) {
    Report unheard;
    return travel(build_chunks(scene, "test", unheard));
}

std::map<std::string, std::uint64_t> losses_of(const Trip& trip) {
    std::map<std::string, std::uint64_t> losses;
    for (const Warning& warning : trip.losses.warnings()) losses[warning.message] += warning.count;
    return losses;
}

void expect_same_skeleton(const Trip& trip) {
    constexpr float kRounding = 1e-6f;  // a matrix stands between, in doubles
    ASSERT_EQ(trip.after.joints.size(), trip.before.joints.size());
    for (std::size_t i = 0; i < trip.before.joints.size(); ++i) {
        const Joint& before = trip.before.joints[i];
        const Joint& after = trip.after.joints[i];
        EXPECT_EQ(after.name, before.name);
        EXPECT_EQ(after.parent, before.parent);
        EXPECT_EQ(after.rest.translation, before.rest.translation);
        EXPECT_NEAR(std::abs(glm::dot(after.rest.rotation, before.rest.rotation)), 1.0f, kRounding);
        EXPECT_LE(glm::length(after.rest.scale - before.rest.scale), kRounding * glm::length(before.rest.scale));
        ASSERT_EQ(after.constraints.size(), before.constraints.size()) << before.name;
        for (std::size_t k = 0; k < before.constraints.size(); ++k)
            EXPECT_EQ(std::memcmp(&after.constraints[k], &before.constraints[k], sizeof(ConstraintRecord)), 0)
                << before.name;
    }
    ASSERT_EQ(trip.after.chains.size(), trip.before.chains.size());
    for (std::size_t i = 0; i < trip.before.chains.size(); ++i) {
        const Chain& before = trip.before.chains[i];
        const Chain& after = trip.after.chains[i];
        EXPECT_EQ(after.name, before.name);
        EXPECT_EQ(after.extras, before.extras);
        EXPECT_EQ(std::memcmp(&after.record, &before.record, sizeof(ChainRecord)), 0) << before.name;
        std::map<std::uint32_t, float> weights;
        for (const Chain::Weight& weight : before.weights) weights[weight.joint] = weight.weight;
        ASSERT_EQ(after.weights.size(), weights.size());
        for (const Chain::Weight& weight : after.weights) EXPECT_EQ(weights.at(weight.joint), weight.weight);
    }
}

/// By joint, of one vertex.
std::map<std::uint32_t, float> weights_of(const Mesh& mesh, std::size_t vertex) {
    std::map<std::uint32_t, float> weights;
    for (std::size_t i = vertex * mesh.influences; i < (vertex + 1) * mesh.influences; ++i) {
        if (mesh.weights[i] > 0.0f) weights[mesh.palette.joints[mesh.bones[i]]] += mesh.weights[i];
    }
    return weights;
}

void expect_same_mesh(const Mesh& before, const Mesh& after) {
    EXPECT_EQ(after.name, before.name);
    EXPECT_EQ(after.joint, before.joint);
    EXPECT_EQ(after.positions, before.positions);
    EXPECT_EQ(after.normals, before.normals);
    ASSERT_EQ(after.submeshes.size(), before.submeshes.size());
    for (std::size_t i = 0; i < before.submeshes.size(); ++i)
        EXPECT_EQ(after.submeshes[i].indices, before.submeshes[i].indices);
    ASSERT_EQ(after.texture_coords.size(), std::min<std::size_t>(1, before.texture_coords.size()));
    if (!after.texture_coords.empty()) {
        EXPECT_EQ(after.texture_coords[0].values, before.texture_coords[0].values);
    }
    ASSERT_EQ(after.influences, before.influences);
    for (std::size_t vertex = 0; vertex < before.positions.size(); ++vertex)
        ASSERT_EQ(weights_of(after, vertex), weights_of(before, vertex)) << vertex;
    std::map<std::uint32_t, glm::mat4> offsets;
    for (std::size_t i = 0; i < before.palette.joints.size(); ++i)
        offsets[before.palette.joints[i]] = before.palette.inverse_bind[i];
    for (std::size_t i = 0; i < after.palette.joints.size(); ++i)
        EXPECT_EQ(after.palette.inverse_bind[i], offsets.at(after.palette.joints[i]));
}

void expect_same_clip(const Clip& before, const Clip& after) {
    EXPECT_EQ(after.name, before.name);
    EXPECT_EQ(after.loop, before.loop);
    std::map<std::pair<std::uint32_t, TrackPath>, const Track*> tracks;
    for (const Track& track : after.tracks) tracks[{track.target, track.path}] = &track;
    for (const Track& track : before.tracks) {
        if (track.path == TrackPath::weights) continue;
        const auto found = tracks.find({track.target, track.path});
        if (found == tracks.end()) {
            EXPECT_EQ(track.times.size(), 1u) << "only what rests may be missing";
            continue;
        }
        EXPECT_EQ(found->second->times, track.times);
        EXPECT_EQ(found->second->values, track.values);
        tracks.erase(found);
    }
    EXPECT_TRUE(tracks.empty());
}

TEST(ExportX, ExamplesComeBack) {
    for (const char* name : {"mannequin.glb", "tentacle.glb"}) {
        SCOPED_TRACE(name);
        Report report;
        const auto bytes = convert(kSource / "examples" / name, {}, report);
        ASSERT_TRUE(bytes);
        const Trip trip = travel(*bytes);
        EXPECT_FALSE(trip.before.chains.empty());
        expect_same_skeleton(trip);
        ASSERT_EQ(trip.after.meshes.size(), trip.before.meshes.size());
        for (std::size_t i = 0; i < trip.before.meshes.size(); ++i)
            expect_same_mesh(trip.before.meshes[i], trip.after.meshes[i]);
        ASSERT_EQ(trip.after.clips.size(), trip.before.clips.size());
        for (std::size_t i = 0; i < trip.before.clips.size(); ++i)
            expect_same_clip(trip.before.clips[i], trip.after.clips[i]);
        EXPECT_EQ(losses_of(trip).count("key time rounded to a tick of the file"), 0u);
    }
}

/// A joint with a mesh of one triangle: what tests add to.
Scene small_scene() {
    Scene scene;
    scene.joints.emplace_back().name = "Root";
    Joint& tip = scene.joints.emplace_back();
    tip.name = "Tip";
    tip.parent = 0;
    tip.rest.translation = {0.0f, 1.0f, 0.25f};
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.joint = 0;
    mesh.positions = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    mesh.submeshes.push_back({Topology::triangles, kNone, {0, 1, 2}});
    return scene;
}

TEST(ExportX, EveryFieldOfARigComesBack) {
    Scene scene = small_scene();
    ConstraintRecord constraint;
    constraint.model = static_cast<std::uint8_t>(ConstraintModel::euler_box);
    constraint.euler_order = 4;
    constraint.scope = 1;
    constraint.flags = kApproximated;
    constraint.soft_zone = 0.125f;
    constraint.frame = {0.5f, 0.5f, -0.5f, 0.5f};
    constraint.rotation_min = {-0.1f, -ConstraintRecord::kFree, -0.3f};
    constraint.rotation_max = {0.1f, 0.2f, ConstraintRecord::kFree};
    constraint.translation_min = {-1.0f, -2.0f, -ConstraintRecord::kFree};
    constraint.translation_max = {0.0f, 0.1f, 3e-12f};
    constraint.stiffness = {0.0f, 0.5f, 1.0f};
    constraint.preferred = {0.01f, 0.02f, 0.03f};
    scene.joints[1].constraints.push_back(constraint);
    constraint.scope = 2;
    constraint.model = static_cast<std::uint8_t>(ConstraintModel::locked);
    constraint.euler_order = 0;
    scene.joints[1].constraints.push_back(constraint);
    Chain chain;
    chain.name = "reach \"{far}; // 100%\" \xc3\xa4";
    chain.record.start = 0;
    chain.record.effector = 1;
    chain.record.target = 0;
    chain.record.pole = 1;
    chain.record.solver = static_cast<std::uint8_t>(Solver::fabrik);
    chain.record.flags = kProposed;
    chain.record.iterations = 65535;
    chain.record.priority = 255;
    chain.record.tolerance = 1e-7f;
    chain.record.pole_vector = {1.0f, 2.0f, -3.0f};
    chain.record.pole_angle = -0.7f;
    chain.record.tip_offset = {0.1f, 0.2f, 0.3f};
    chain.record.tip_rotation = {0.0f, 0.6f, 0.0f, 0.8f};
    chain.record.position_weight = 0.5f;
    chain.record.rotation_weight = 0.25f;
    chain.record.influence = 0.75f;
    chain.record.stretch = 1.5f;
    chain.record.compress = 0.1f;
    chain.weights = {{1, 0.5f}, {0, 0.0f}};
    chain.extras = R"({"a": "b"})";
    scene.chains.push_back(chain);
    const Trip trip = travel(scene);
    expect_same_skeleton(trip);
    EXPECT_EQ(losses_of(trip), (std::map<std::string, std::uint64_t>{}));
}

TEST(ExportX, NamesThatAreNoIdentifiersAndNamesThatAreDoubledComeBack) {
    Scene scene = small_scene();
    const std::vector<std::string> names{"mixamorig:Hips", "",    "",           "Frame",        "Same",  "Same",
                                         "same",           "1st", "a\"b\\%41{", "\xe8\x85\xb0", "Same_2"};
    for (const std::string& name : names) {
        Joint& joint = scene.joints.emplace_back();
        joint.name = name;
        joint.parent = 1;
    }
    Material material;
    material.name = "Same";
    scene.materials.push_back(material);
    scene.meshes[0].submeshes[0].material = 0;
    const Trip trip = travel(scene);
    expect_same_skeleton(trip);
    EXPECT_EQ(trip.after.materials.at(0).name, "Same");
    EXPECT_EQ(trip.after.meshes.at(0).submeshes[0].material, 0u);
}

Track moving(Interpolation interpolation, std::vector<float> times, std::vector<float> values) {
    return {TrackPath::translation, interpolation, 1, 3, std::move(times), std::move(values)};
}

TEST(ExportX, FramesOf24And30AndOddTimesComeBackToTheBit) {
    for (const float rate : {24.0f, 30.0f, 60.0f}) {
        Scene scene = small_scene();
        Clip& clip = scene.clips.emplace_back();
        clip.name = "Walk";
        clip.loop = true;
        std::vector<float> times;
        std::vector<float> values;
        for (int frame = 0; frame < 200; ++frame) {
            times.push_back(static_cast<float>(frame) / rate);
            values.insert(values.end(), {static_cast<float>(frame), 0.1f, -0.2f});
        }
        clip.tracks.push_back(moving(Interpolation::linear, times, values));
        const Trip trip = travel(scene);
        expect_same_clip(trip.before.clips.at(0), trip.after.clips.at(0));
    }
    Scene scene = small_scene();
    Clip& clip = scene.clips.emplace_back();
    clip.tracks.push_back(moving(Interpolation::linear, {0.0f, 0.1234567f, 1.7654321f}, {0, 0, 0, 1, 1, 1, 2, 2, 2}));
    const Trip trip = travel(scene);
    expect_same_clip(trip.before.clips.at(0), trip.after.clips.at(0));
    EXPECT_EQ(losses_of(trip), (std::map<std::string, std::uint64_t>{}));
}

TEST(ExportX, WhatIsNotLinearIsSampledAndSaid) {
    Scene scene = small_scene();
    Clip& clip = scene.clips.emplace_back();
    clip.name = "Jump";
    clip.tracks.push_back(moving(Interpolation::step, {0.0f, 1.0f}, {0, 0, 0, 1, 2, 3}));
    Clip& bow = scene.clips.emplace_back();
    bow.name = "Bow";
    // From 0 to 1 without speed at either end: 3 t^2 - 2 t^3.
    bow.tracks.push_back(
        moving(Interpolation::cubic, {0.0f, 1.0f}, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 0, 0, 0}));
    const Trip trip = travel(scene);
    EXPECT_EQ(losses_of(trip), (std::map<std::string, std::uint64_t>{
                                   {"track that jumps gets two keys for each jump, a tick apart", 1},
                                   {"cubic track is sampled, 60 times a second: X-files have linear keys only", 1}}));
    ASSERT_EQ(trip.after.clips.size(), 2u);
    const Track& jump = trip.after.clips[0].tracks.at(0);
    ASSERT_EQ(jump.times.size(), 3u);
    EXPECT_EQ(jump.times[2], 1.0f);
    EXPECT_GT(jump.times[1], 0.95f);
    EXPECT_EQ(jump.values, (std::vector<float>{0, 0, 0, 0, 0, 0, 1, 2, 3}));
    const Track& curve = trip.after.clips[1].tracks.at(0);
    EXPECT_GE(curve.times.size(), 20u);
    for (std::size_t key = 0; key < curve.times.size(); ++key) {
        const double t = curve.times[key];
        EXPECT_NEAR(curve.values[3 * key], t * t * (3.0 - 2.0 * t), 1e-6);
    }
}

TEST(ExportX, ASplineThroughNoRotationTurnsNothingThere) {
    Scene scene = small_scene();
    Track spline{TrackPath::rotation, Interpolation::cubic, 0, 4, {0.0f, 1.0f}, std::vector<float>(24, 0.0f)};
    spline.values[4] = 1.0f;  // half a turn about X, then nothing
    scene.clips.emplace_back().tracks = {spline};
    const Track back = travel(scene).after.clips.at(0).tracks.at(0);
    ASSERT_GE(back.values.size(), 8u);
    EXPECT_EQ(std::abs(back.values[0]), 1.0f);
    EXPECT_EQ((std::vector<float>(back.values.end() - 4, back.values.end())), (std::vector<float>{0, 0, 0, 1}));
}

TEST(ExportX, WhatXFilesCannotHoldIsNamedAndCounted) {
    Scene scene = small_scene();
    Mesh& mesh = scene.meshes[0];
    mesh.tangents.assign(3, {1, 0, 0, 1});
    for (std::uint32_t set = 0; set < 3; ++set)
        mesh.texture_coords.push_back({"", set, 2, std::vector<float>(6, 0.5f)});
    for (std::uint32_t set = 0; set < 2; ++set) mesh.colours.push_back({"", set, 4, std::vector<float>(12, 0.5f)});
    mesh.attributes.push_back({"_HEAT", 0, 1, {1, 2, 3}});
    mesh.submeshes.push_back({Topology::lines, kNone, {0, 1}});
    mesh.targets.push_back({"smile", 0.5f, {{2, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {}, {}});
    mesh.targets.push_back({"frown", 0.0f, {{9, 9, 9}, {0, 0, 0}, {0, 0, 0}}, {}, {}});
    Clip& clip = scene.clips.emplace_back();
    clip.tracks.push_back({TrackPath::weights, Interpolation::linear, 0, 2, {0, 1}, {0, 0, 1, 1}});
    Material material;
    material.metallic = 0.5f;
    material.double_sided = true;
    material.base_colour_texture.texture = 0;
    scene.materials.push_back(material);
    mesh.submeshes[0].material = 0;
    Texture& texture = scene.textures.emplace_back();
    texture.min_filter = Filter::linear;
    texture.images = {0};
    scene.images.emplace_back().uri = "skin.png";
    scene.asset = R"({"copyright": "hers"})";
    const Trip trip = travel(scene);
    const std::string no_place = " left out: X-files have no place for it";
    EXPECT_EQ(losses_of(trip), (std::map<std::string, std::uint64_t>{
                                   {"morph target" + no_place, 2},
                                   {"tangents of a mesh" + no_place, 1},
                                   {"further set of texture coordinates" + no_place, 2},
                                   {"further set of vertex colours" + no_place, 1},
                                   {"an author's attribute" + no_place, 1},
                                   {"that a material has two sides" + no_place, 1},
                                   {"how a texture is sampled is left out", 1},
                                   {"the source's asset data left out: author, copyright, generator", 1},
                                   {"lines and points left out: X-files have triangles only", 1},
                                   {"weights of morph targets left out of a clip", 1},
                                   {"a clip that moves no joint is left out", 1},
                                   {"metallic and roughness are written as specular colour and power, which only "
                                    "resemble them",
                                    1}}));
    EXPECT_EQ(trip.after.meshes.at(0).positions[0], glm::vec3(1, 0, 1)) << "as it rests, half a smile";
    for (std::size_t k = 0; k < 12; ++k)
        EXPECT_FLOAT_EQ(trip.after.meshes.at(0).colours.at(0).values.at(k), 0.5f) << "but for the last bits";
}

TEST(ExportX, EmbeddedImagesBecomeFiles) {
    Scene scene = small_scene();
    scene.images.push_back({"", "image/png", std::vector<std::byte>(5, std::byte{7}), ""});
    scene.images.push_back({"", "image/jpeg", {}, "some%20skin.jpg"});
    for (std::uint32_t i = 0; i < 2; ++i) {
        Texture texture;
        texture.images.push_back(i);
        scene.textures.push_back(texture);
        Material material;
        material.base_colour_texture.texture = i;
        material.roughness = 0.5f;
        material.metallic = 0.0f;
        scene.materials.push_back(material);
    }
    scene.meshes[0].submeshes[0].material = 1;
    const Trip trip = travel(scene);
    ASSERT_EQ(trip.asset.images.size(), 1u);
    EXPECT_EQ(trip.asset.images[0].name, "image_0.png");
    EXPECT_EQ(trip.asset.images[0].bytes.size(), 5u);
    ASSERT_EQ(trip.after.images.size(), 2u);
    EXPECT_EQ(trip.after.images[0].uri, "image_0.png");
    EXPECT_EQ(trip.after.images[1].uri, "some%20skin.jpg");
    EXPECT_FLOAT_EQ(trip.after.materials.at(1).roughness, 0.5f);
}

TEST(ExportX, BmpAndTgaImagesKeepTheirEndings) {
    const auto bytes_of = [](std::initializer_list<int> values) {
        std::vector<std::byte> bytes;
        for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
        return bytes;
    };
    Scene scene = small_scene();
    scene.images.push_back({"", "", bytes_of({'B', 'M', 0, 0}), ""});
    scene.images.push_back({"", "", bytes_of({0, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 4, 0, 24, 0, 1, 2, 3}), ""});
    scene.images.push_back({"", "", bytes_of({0, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 4, 0, 25, 0, 1, 2, 3}), ""});
    for (std::uint32_t i = 0; i < 3; ++i) {
        scene.textures.emplace_back().images.push_back(i);
        scene.materials.emplace_back().base_colour_texture.texture = i;
    }
    const Trip trip = travel(scene);
    ASSERT_EQ(trip.asset.images.size(), 3u);
    EXPECT_EQ(trip.asset.images[0].name, "image_0.bmp");
    EXPECT_EQ(trip.asset.images[1].name, "image_1.tga");
    EXPECT_EQ(trip.asset.images[2].name, "image_2.bin");
}

TEST(ExportX, ColoursAreThoseOfTheScreen) {
    Scene scene = small_scene();
    Material& material = scene.materials.emplace_back();
    material.base_colour = {0.21404114f, 1.0f, 0.0f, 0.5f};
    material.emissive = {0.21404114f, 0.0f, 4.0f};
    material.metallic = 0.0f;
    scene.meshes[0].submeshes[0].material = 0;
    scene.meshes[0].colours.push_back({"", 0, 4, std::vector<float>(12, 0.21404114f)});
    const Trip trip = travel(scene);
    const std::string& text = trip.asset.text;
    EXPECT_NE(text.find("0.5;1.0;0.0;0.5;;"), std::string::npos) << text;
    EXPECT_NE(text.find("0;0.5;0.5;0.5;0.21404114;"), std::string::npos) << text;
    const Material& back = trip.after.materials.at(0);
    EXPECT_FLOAT_EQ(back.base_colour.x, 0.21404114f);
    EXPECT_FLOAT_EQ(back.emissive.z, 4.0f);
}

TEST(ExportX, OwnLightIsSeenThroughTheTexture) {
    const std::string no_place = " left out: X-files have no place for it";
    for (const bool is_same : {true, false}) {
        Scene scene = small_scene();
        scene.images.emplace_back().uri = "skin.png";
        scene.textures.emplace_back().images = {0};
        Material& material = scene.materials.emplace_back();
        material.metallic = 0.0f;
        material.emissive = {0.5f, 0.25f, 0.0f};
        material.base_colour_texture.texture = 0;
        if (is_same) material.emissive_texture.texture = 0;
        scene.meshes[0].submeshes[0].material = 0;
        const Trip trip = travel(scene);
        EXPECT_EQ(losses_of(trip).contains("that the texture has no part in a material's own light" + no_place),
                  !is_same);
        EXPECT_FALSE(losses_of(trip).contains("emissive texture" + no_place));
        EXPECT_EQ(trip.after.materials.at(0).emissive_texture.texture, 0u);
    }
}

TEST(ExportX, AJointsOwnMaterialStandsInItsMesh) {
    Scene scene = small_scene();
    scene.materials.resize(2);
    scene.materials[0].name = "Shared";
    scene.materials[1].name = "Own";
    scene.materials[1].joint = 0;
    scene.meshes[0].submeshes.push_back(scene.meshes[0].submeshes[0]);
    scene.meshes[0].submeshes[0].material = 0;
    scene.meshes[0].submeshes[1].material = 1;
    scene.meshes.push_back(scene.meshes[0]);
    const Trip trip = travel(scene);
    ASSERT_EQ(trip.after.materials.size(), 2u);
    EXPECT_EQ(trip.after.materials[0].joint, kNone);
    EXPECT_EQ(trip.after.materials[1].joint, 0u);
    for (const Mesh& mesh : trip.after.meshes) EXPECT_EQ(mesh.submeshes.at(1).material, 1u);
    EXPECT_EQ(losses_of(trip).count("a joint's own material is written as the file's"), 0u);

    Mesh& skin = scene.meshes[1];
    skin.influences = 1;
    skin.palette = {{0}, {glm::mat4(1.0f)}};
    skin.bones = {0, 0, 0};
    skin.weights = {1.0f, 1.0f, 1.0f};
    const Trip skinned = travel(scene);
    EXPECT_EQ(skinned.before.materials.at(1).joint, 0u);
    EXPECT_EQ(skinned.after.materials.at(1).joint, kNone);
    EXPECT_EQ(losses_of(skinned).at("a joint's own material is written as the file's"), 1u);
}

TEST(ExportX, BadFilesAreRefused) {
    Report report;
    const std::vector<std::byte> bytes(32);
    EXPECT_FALSE(export_x(bytes, "image", report));
}

}  // namespace
}  // namespace bendy::converter::export_x_test
