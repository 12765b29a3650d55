#include <bendy/converter/build_chunks.h>
#include <bendy/converter/convert.h>
#include <bendy/converter/import.h>
#include <bendy/format/file.h>
#include <bendy/format/marker.h>

#include "format/edit_file.h"
#include "source_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace bendy::converter::import_bendy_test {
namespace {

using bendy::test::Buffer;

const std::filesystem::path kSource = source_folder();

Scene import_good(Bytes bytes, Report& report) {
    Result<Scene, ImportError> scene = import_bendy(bytes, report);
    EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
    return scene ? *std::move(scene) : Scene{};
}

std::string import_fault(Bytes bytes) {
    Report report;
    const auto scene = import_bendy(bytes, report);
    return scene ? "" : scene.error().message;
}

std::vector<std::string> messages_of(const Report& report) {
    std::vector<std::string> lines;
    for (const Warning& warning : report.warnings()) lines.push_back(warning.first_place + ": " + warning.message);
    return lines;
}

/// A place of the test's own for files.
std::filesystem::path folder() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    const auto path = std::filesystem::temp_directory_path() / (std::string("bendy_import_") + test->name());
    std::filesystem::create_directories(path);
    return path;
}

TEST(ImportBendy, ThePartsThatMoveAreTheSameWithoutTheOthers) {
    const Buffer file = bendy::test::sample_file();
    Report report;
    const Scene all = import_good(file, report);
    const auto moved = import_bendy(file, report, MeshParts::motion);
    ASSERT_TRUE(moved);
    ASSERT_EQ(moved->meshes.size(), all.meshes.size());
    for (std::size_t number = 0; number < all.meshes.size(); ++number) {
        const Mesh& mesh = moved->meshes[number];
        EXPECT_EQ(mesh.positions, all.meshes[number].positions);
        EXPECT_EQ(mesh.bones, all.meshes[number].bones);
        EXPECT_EQ(mesh.weights, all.meshes[number].weights);
        EXPECT_EQ(mesh.joint, all.meshes[number].joint);
        ASSERT_EQ(mesh.targets.size(), all.meshes[number].targets.size());
        for (std::size_t t = 0; t < mesh.targets.size(); ++t) {
            EXPECT_EQ(mesh.targets[t].positions, all.meshes[number].targets[t].positions);
            EXPECT_TRUE(mesh.targets[t].normals.empty());
        }
        EXPECT_TRUE(mesh.normals.empty() && mesh.submeshes.empty() && mesh.texture_coords.empty());
    }
    EXPECT_FALSE(all.meshes[0].submeshes.empty());
}

TEST(ImportBendy, EveryKindOfChunkComesBack) {
    const Buffer file = bendy::test::sample_file();
    Report report;
    const Scene scene = import_good(file, report);

    EXPECT_EQ(scene.name, "fox");
    EXPECT_EQ(scene.extras, R"({"a":1})");
    EXPECT_EQ(scene.extensions, R"({"KHR_z":{}})");
    EXPECT_EQ(scene.source_extras, R"({"file":true})");
    ASSERT_EQ(scene.joints.size(), 4u);
    EXPECT_EQ(scene.joints[0].extras, R"({"mass":3})");
    EXPECT_EQ(scene.joints[2].parent, 1u);
    EXPECT_EQ(scene.joints[3].parent, 0u);
    EXPECT_EQ(scene.joints[3].extensions, R"({"KHR_y":[]})");
    EXPECT_EQ(scene.joints[1].rest.translation, glm::vec3(0.0f, 0.5f, 0.0f));
    ASSERT_EQ(scene.joints[1].constraints.size(), 2u);
    EXPECT_EQ(scene.joints[1].constraints[1].rotation_max[1], 0.75f);
    ASSERT_EQ(scene.chains.size(), 2u);
    EXPECT_EQ(scene.chains[0].name, "back");
    EXPECT_EQ(scene.chains[0].record.stretch, 1.5f);
    EXPECT_EQ(scene.chains[0].extras, "[1]");
    ASSERT_EQ(scene.chains[1].weights.size(), 1u);
    EXPECT_EQ(scene.chains[1].weights[0].joint, 3u);
    EXPECT_EQ(scene.chains[1].weights[0].weight, 0.25f);

    ASSERT_EQ(scene.textures.size(), 3u);
    ASSERT_EQ(scene.images.size(), 2u);
    EXPECT_EQ(scene.images[0].uri, "skin.png");
    EXPECT_EQ(scene.images[1].media_type, "image/webp");
    EXPECT_EQ(scene.images[1].bytes.size(), 5u);
    EXPECT_EQ(scene.textures[2].images, scene.textures[1].images);
    EXPECT_EQ(scene.textures[0].wrap_t, Wrap::mirrored_repeat);
    ASSERT_EQ(scene.materials.size(), 2u);
    EXPECT_EQ(scene.materials[0].alpha_mode, AlphaMode::blend);
    EXPECT_EQ(scene.materials[0].base_colour_texture.texture, 2u);
    EXPECT_EQ(scene.materials[0].extensions, R"({"KHR_x":{}})");
    EXPECT_EQ(scene.materials[1].metallic, 0.25f);  // the joint's own

    ASSERT_EQ(scene.meshes.size(), 2u);
    const Mesh& fur = scene.meshes[0];
    EXPECT_EQ(fur.positions[3], glm::vec3(1, 1, 0));
    EXPECT_EQ(fur.tangents[2].w, -1.0f);
    ASSERT_EQ(fur.texture_coords.size(), 2u);
    EXPECT_EQ(fur.texture_coords[1].set, 1u);
    EXPECT_EQ(fur.texture_coords[1].values, (std::vector<float>{0, 0, 1, 0, 0, 1, 1, 1}));
    EXPECT_EQ(fur.colours[0].values[9], 0.2f);
    EXPECT_EQ(fur.attributes[0].name, "_WIND");
    EXPECT_EQ(fur.attributes[0].values, (std::vector<float>{-32768, 0, 1, 32767}));
    EXPECT_EQ(fur.bones, (std::vector<std::uint32_t>{0, 1, 0, 1, 1, 0, 1, 1}));
    EXPECT_EQ(fur.weights[3], 0.25f);
    EXPECT_EQ(fur.palette.inverse_bind[1][3][1], -1.0f);
    ASSERT_EQ(fur.targets.size(), 2u);
    EXPECT_EQ(fur.targets[0].rest_weight, 0.125f);
    EXPECT_EQ(fur.targets[1].positions, (std::vector<glm::vec3>{{}, {9, 0, 0}, {}, {0, 9, 0}}));
    EXPECT_TRUE(fur.targets[1].normals.empty());
    ASSERT_EQ(fur.submeshes.size(), 2u);
    EXPECT_EQ(fur.submeshes[0].material, 1u);
    EXPECT_EQ(fur.submeshes[1].indices, (std::vector<std::uint32_t>{2, 1, 3}));

    ASSERT_EQ(scene.clips.size(), 1u);
    EXPECT_TRUE(scene.clips[0].loop);
    ASSERT_EQ(scene.clips[0].tracks.size(), 5u);
    EXPECT_EQ(scene.clips[0].tracks[4].times, (std::vector<float>{0.5f, 0.75f, 1.0f}));  // were fixed frames
    EXPECT_EQ(scene.clips[0].tracks[3].values, (std::vector<float>{0, 0.5f, 1, 0.25f}));

    const std::vector<std::string> lines = messages_of(report);
    const auto is_said = [&](const std::string& line) { return std::count(lines.begin(), lines.end(), line) == 1; };
    ASSERT_EQ(scene.materials.size(), 2u);
    EXPECT_EQ(scene.materials[0].joint, kNone);
    EXPECT_EQ(scene.materials[1].joint, 0u) << "a joint's own material";
    EXPECT_TRUE(is_said("HEAD/OBJE/CYCL: tracks of fixed frames are written as timed keys"));
    EXPECT_TRUE(is_said("HEAD/OBJE/VECT[1]: rigid mesh that several joints move is written as a skinned one"));
}

TEST(ImportBendy, ARigidMeshOfSeveralJointsIsMovedAsBefore) {
    Report report;
    const Scene scene = import_good(bendy::test::sample_file(), report);
    const Mesh& mesh = scene.meshes[1];
    ASSERT_EQ(mesh.influences, 1u);
    for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex)
        EXPECT_EQ(mesh.palette.joints[mesh.bones[vertex]], vertex == 5 ? 1u : 2u) << vertex;
}

TEST(ImportBendy, WhatWasWrittenFromASceneIsWrittenAgainToTheByte) {
    Report report;
    const Buffer once = build_chunks(import_good(bendy::test::sample_file(), report), "g", report);
    Report silent;
    const Buffer twice = build_chunks(import_good(once, silent), "g", silent);
    EXPECT_EQ(once, twice);
    EXPECT_TRUE(silent.warnings().empty()) << messages_of(silent).front();
}

TEST(ImportBendy, TheExamplesComeBackToTheByte) {
    for (const char* name : {"mannequin.glb", "tentacle.glb"}) {
        Report report;
        const auto once = convert(kSource / "examples" / name, {}, report);
        ASSERT_TRUE(once) << once.error().message;
        const auto path = folder() / "file.of-no-known-name";
        ASSERT_TRUE(write_file(path, *once));
        Report silent;
        const auto twice = convert(path, {}, silent);
        ASSERT_TRUE(twice) << twice.error().message;
        EXPECT_TRUE(*once == *twice) << name;
        EXPECT_TRUE(silent.warnings().empty());
    }
}

TEST(ImportBendy, EmbeddedImagesThatNobodyUsesDoNotMoveTheTextures) {
    Scene scene;
    scene.joints.resize(1);
    scene.images.resize(2);
    scene.images[0].uri = "a.png";
    scene.images[1].bytes.resize(3);
    scene.textures.resize(1);
    scene.textures[0].images = {0};
    Report report;
    const Buffer once = build_chunks(scene, "g", report);
    EXPECT_EQ(once, build_chunks(import_good(once, report), "g", report));
}

/// A joint that goes from 0 to 1 s in so many keys, with markers from end to end.
Scene marked_scene(std::size_t keys) {
    Scene scene;
    scene.joints.resize(1);
    Clip& clip = scene.clips.emplace_back();
    Track& track = clip.tracks.emplace_back();
    track.target = 0;
    track.components = 3;
    for (std::size_t k = 0; k < keys; ++k) {
        const float time = static_cast<float>(k) / static_cast<float>(keys - 1);
        track.times.push_back(time);
        track.values.insert(track.values.end(), {std::sin(3.0f * time), time * time, 0.0f});
    }
    clip.markers = {{0.0f, "first"}, {0.3f, "step"}, {0.7f, "step"}, {1.0f, "last"}};
    return scene;
}

TEST(ImportBendy, MarkersComeBackToTheByte) {
    Report report;
    const Buffer once = build_chunks(marked_scene(2), "g", report);
    const Scene scene = import_good(once, report);
    ASSERT_EQ(scene.clips[0].markers.size(), 4u);
    EXPECT_EQ(scene.clips[0].markers[2].seconds, 0.7f);
    EXPECT_EQ(scene.clips[0].markers[2].name, "step");
    EXPECT_EQ(build_chunks(scene, "g", report), once);
    EXPECT_TRUE(report.warnings().empty());
}

TEST(ImportBendy, CompactFilesKeepMarkers) {
    Report report;
    const auto path = folder() / "exact.bendy";
    ASSERT_TRUE(write_file(path, build_chunks(marked_scene(100), "g", report)));
    ConvertOptions options;
    options.compact = ErrorBound{1e-4, false};
    const auto compact = convert(path, options, report);
    ASSERT_TRUE(compact) << compact.error().message;
    const Result<ChunkTree> tree = read_chunk_tree(*compact);
    ASSERT_TRUE(tree);
    const auto is_packed = [](const Chunk& chunk) { return chunk.id == FourCC("PACK"); };
    EXPECT_EQ(std::count_if(tree->chunks().begin(), tree->chunks().end(), is_packed), 1);
    const Scene scene = import_good(*compact, report);
    ASSERT_EQ(scene.clips[0].markers.size(), 4u);
    EXPECT_EQ(scene.clips[0].markers[1].seconds, 0.3f);
    EXPECT_EQ(scene.clips[0].markers[3].name, "last");
    EXPECT_NEAR(scene.clips[0].markers[3].seconds, 1.0f, 1e-6f);
}

TEST(ImportBendy, AClipThatIsLongerThanItsKeysStaysAsLong) {
    bendy::test::Buffer payload = write_markers(std::vector<bendy::Marker>{{0.5f, "in"}, {1.5f, "behind"}});
    Report report;
    Buffer file = build_chunks(marked_scene(2), "g", report);
    bendy::test::Node root = bendy::test::to_node(file);
    bendy::test::edit<ClipRecord>(bendy::test::at(root, "HEAD/OBJE/CYCL/CINF"),
                                  [](ClipRecord& clip) { clip.end = 2.0f; });
    bendy::test::at(root, "HEAD/OBJE/CYCL/MARK").payload = payload;
    file = bendy::test::to_file(root);
    const Scene scene = import_good(file, report);
    ASSERT_EQ(scene.clips[0].markers.size(), 2u);
    EXPECT_EQ(scene.clips[0].markers[1].name, "behind");
    EXPECT_TRUE(report.warnings().empty());
    EXPECT_EQ(build_chunks(scene, "g", report), file);
}

TEST(ImportBendy, UnknownChunksAreNamed) {
    ChunkWriter out;
    out.begin(FourCC("HEAD"));
    VersionRecord version;
    version.objects = 1;
    out.leaf(FourCC("VERS"), bytes_of(version));
    for (int i = 0; i < 3; ++i) out.text_leaf(FourCC("ZZZZ"), "later");
    out.begin(FourCC("OBJE"));
    out.begin(FourCC("QQQQ"));
    out.text_leaf(FourCC("ZZZZ"), "inside another: not counted");
    out.end();
    out.end();
    out.end();
    const Buffer file = std::move(out).finish();
    Report report;
    import_good(file, report);
    ASSERT_EQ(report.warnings().size(), 2u);
    EXPECT_EQ(messages_of(report)[0], "HEAD/OBJE/QQQQ: chunk that is not read is left out: QQQQ");
    EXPECT_EQ(messages_of(report)[1], "HEAD/ZZZZ: chunk that is not read is left out: ZZZZ");
    EXPECT_EQ(report.warnings()[1].count, 3u);
}

TEST(ImportBendy, FieldsOfALaterVersionAreNamed) {
    ChunkWriter out;
    out.begin(FourCC("HEAD"));
    VersionRecord version;
    version.objects = 1;
    const std::uint32_t more = 7;
    out.leaf(FourCC("VERS"), std::array{bytes_of(version), bytes_of(more)});
    out.begin(FourCC("OBJE"));
    out.end();
    out.end();
    Report report;
    import_good(std::move(out).finish(), report);
    ASSERT_EQ(report.warnings().size(), 1u);
    EXPECT_EQ(messages_of(report)[0], "HEAD/VERS: fields of a later version are left out: VERS");
}

TEST(ImportBendy, FactsAboutTheSourceAreTakenApart) {
    const auto facts = [](std::string_view text, Scene& scene, Report& report) {
        ChunkWriter out;
        out.begin(FourCC("HEAD"));
        VersionRecord version;
        version.objects = 1;
        out.leaf(FourCC("VERS"), bytes_of(version));
        out.text_leaf(FourCC("EXTR"), text);
        out.begin(FourCC("OBJE"));
        out.end();
        out.end();
        scene = import_good(std::move(out).finish(), report);
    };
    Scene scene;
    Report silent;
    facts(R"({"asset":{"a":"}\"{","b":[1,{"asset":2}]},"extras":"x,:\\"})", scene, silent);
    EXPECT_EQ(scene.asset, R"({"a":"}\"{","b":[1,{"asset":2}]})");
    EXPECT_EQ(scene.source_extras, R"("x,:\\")");
    facts(R"( {"extras": [1, 2] } )", scene, silent);
    EXPECT_EQ(scene.asset, "");
    EXPECT_EQ(scene.source_extras, "[1, 2]");
    EXPECT_TRUE(silent.warnings().empty());
    for (const char* other : {"[1]", "{}", R"({"asset":1,"asset":2})", R"({"asset":1,"more":2})", "7"}) {
        Report report;
        facts(other, scene, report);
        EXPECT_EQ(scene.source_extras, other);
        EXPECT_EQ(report.warnings().size(), 1u) << other;
    }
    Report report;
    facts(R"({"asset":)", scene, report);
    EXPECT_EQ(scene.asset + scene.source_extras, "");
    EXPECT_EQ(report.warnings().size(), 1u);
}

TEST(ImportBendy, ADamagedFileIsRefusedWithItsPlace) {
    const Buffer good = bendy::test::sample_file();
    for (std::size_t size = 0; size < good.size(); size += 48) {
        const Buffer cut(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
        EXPECT_NE(import_fault(cut), "") << size;
    }
    for (std::size_t at = 0; at < good.size(); at += 37) {
        Buffer flipped = good;
        flipped[at] ^= std::byte{0x10};
        EXPECT_NE(import_fault(flipped), "") << at;
    }
    Buffer flipped = good;
    flipped[40] ^= std::byte{1};
    EXPECT_NE(import_fault(flipped).find("HEAD/VERS, offset 16"), std::string::npos) << import_fault(flipped);
}

TEST(ImportBendy, TracksThatShareKeysWithoutEndAreRefused) {
    constexpr std::uint32_t kJoints = 2'000;
    constexpr std::uint32_t kKeys = 300'000;
    ChunkWriter out;
    out.begin(FourCC("HEAD"));
    VersionRecord version;
    version.objects = 1;
    version.joints = kJoints;
    version.clips = 1;
    out.leaf(FourCC("VERS"), bytes_of(version));
    out.begin(FourCC("OBJE"));
    for (std::uint32_t joint = 0; joint < kJoints; ++joint) {
        bendy::test::begin_joint(out, "", 0.0f);
        out.end();
    }
    out.begin(FourCC("CYCL"));
    ClipRecord info;
    info.end = kKeys - 1;
    out.leaf(FourCC("CINF"), bytes_of(info));
    std::vector<TrackRecord> tracks;
    for (std::uint32_t joint = 0; joint < kJoints; ++joint)
        tracks.push_back(bendy::test::track(joint, TrackPath::translation, Interpolation::linear, 3, kKeys, 0, 0));
    std::vector<float> times;
    for (std::uint32_t key = 0; key < kKeys; ++key) times.push_back(static_cast<float>(key));
    out.leaf(FourCC("TRAK"), bendy::test::bytes_of_all(tracks));
    out.leaf(FourCC("TIME"), bendy::test::bytes_of_all(times));
    out.leaf(FourCC("KEYV"), bendy::test::bytes_of_all(std::vector<float>(std::size_t{kKeys} * 3)));
    out.end();
    out.end();
    out.end();
    EXPECT_EQ(import_fault(std::move(out).finish()), "the decoded data would be implausibly large");
}

TEST(ImportBendy, ASceneCannotBeChosen) {
    const auto path = folder() / "a.gltf";
    ASSERT_TRUE(write_file(path, bendy::test::sample_file()));
    ConvertOptions options;
    options.gltf.scene = "0";
    Report report;
    const auto bytes = convert(path, options, report);
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().message, "a scene can be chosen in glTF files only");
}

TEST(ImportBendy, ARigFileGoesBeforeWhatIsThere) {
    const auto path = folder() / "a.bendy";
    const auto rig = folder() / "rig.json";
    ASSERT_TRUE(write_file(path, bendy::test::sample_file()));
    const std::string members =
        R"("joints": {"head": {"model": "locked"}}, "chains": [{"name": "back", "start": "spine", "effector": "head"}])";
    const auto converted = [&](const std::string& text) {
        EXPECT_TRUE(write_file(rig, as_byte_span(text)));
        ConvertOptions options;
        options.rig = rig;
        Report report;
        const auto bytes = convert(path, options, report);
        EXPECT_TRUE(bytes) << (bytes ? "" : bytes.error().place + bytes.error().message);
        return bytes ? import_good(*bytes, report) : Scene{};
    };
    const Scene changed = converted(R"({"bendy_rig": 1, )" + members + "}");
    ASSERT_EQ(changed.chains.size(), 2u);
    EXPECT_EQ(changed.chains[0].name, "");
    EXPECT_EQ(changed.chains[1].record.start, 1u);
    EXPECT_EQ(changed.joints[1].constraints.size(), 2u);
    EXPECT_EQ(changed.joints[2].constraints.size(), 1u);
    const Scene replaced = converted(R"({"bendy_rig": 1, "complete": true, )" + members + "}");
    EXPECT_EQ(replaced.chains.size(), 1u);
    EXPECT_EQ(replaced.joints[1].constraints.size(), 0u);
    EXPECT_EQ(replaced.joints[2].constraints.size(), 1u);
}

}  // namespace
}  // namespace bendy::converter::import_bendy_test
