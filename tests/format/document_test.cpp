#include <bendy/format/document.h>

#include "edit_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace bendy::document_test {
namespace {

using namespace test;

TEST(Document, GivesTheWholeFile) {
    const Loaded sample(sample_file());
    EXPECT_EQ(sample.lines(), Lines{});
    const Document& document = sample.document;
    ASSERT_TRUE(document.version.has_value());
    EXPECT_EQ(document.version->major, kVersionMajor);
    EXPECT_EQ(document.version->vertices, 10u);
    EXPECT_STREQ(reinterpret_cast<const char*>(document.version->generator.data()), "sample");
    EXPECT_EQ(document.extras, "{\"file\":true}");
    EXPECT_EQ(document.textures.size(), 3u);
    EXPECT_EQ(document.materials.size(), 2u);
    ASSERT_EQ(document.objects.size(), 1u);
    const ObjectView& object = document.objects[0];
    EXPECT_EQ(object.name, "fox");
    EXPECT_EQ(object.extras, "{\"a\":1}");
    EXPECT_EQ(object.skeleton.joints.size(), 4u);
    EXPECT_EQ(object.meshes.size(), 2u);
    EXPECT_EQ(object.clips.size(), 1u);
}

TEST(Document, TakesAFileWithNothingButItsVersion) {
    const Node root = make_container(FourCC("HEAD"), {make_leaf(FourCC("VERS"), bytes_of(VersionRecord{}))});
    EXPECT_EQ(faults_in(root), Lines{});
    EXPECT_TRUE(Loaded(root).document.objects.empty());
}

TEST(Document, ReadsSiblingsInAnyOrder) {
    Node root = sample();
    const auto reverse = [](Node& node) { std::reverse(node.children.begin(), node.children.end()); };
    reverse(at(root, "HEAD/MATE"));
    reverse(at(root, "HEAD/TEXT"));
    reverse(at(root, "HEAD/OBJE/CYCL"));
    reverse(at(root, "HEAD/OBJE/VECT[1]"));
    reverse(at(root, "HEAD/OBJE/VECT/USER"));
    reverse(at(root, "HEAD/OBJE/SKIN/SKIN[1]"));
    // The object's clip and meshes before its joints; HEAD's object before its materials and textures.
    Node& object = at(root, "HEAD/OBJE");
    std::stable_partition(object.children.begin(), object.children.end(),
                          [](const Node& node) { return node.id == FourCC("CYCL"); });
    std::stable_partition(object.children.begin(), object.children.end(),
                          [](const Node& node) { return node.id != FourCC("SKIN"); });
    std::stable_partition(root.children.begin(), root.children.end(),
                          [](const Node& node) { return node.id == FourCC("OBJE"); });
    EXPECT_EQ(faults_in(root), Lines{});
    const Loaded loaded(root);
    EXPECT_EQ(loaded.document.objects.at(0).clips.at(0).tracks.size(), 5u);
    EXPECT_EQ(loaded.document.materials.at(0).name, "red");
    EXPECT_EQ(loaded.document.textures.at(0).images.at(0).uri, "skin.png");
}

TEST(Document, TurnsLocalMaterialNumbersIntoItsOwn) {
    const Loaded sample(sample_file());
    const auto& submeshes = sample.document.objects.at(0).skeleton.submeshes;
    EXPECT_EQ(submeshes[0].material, 1u);  // the local one, after the global one
    EXPECT_EQ(submeshes[1].material, kNone);
    EXPECT_EQ(submeshes[3].material, 0u);
}

TEST(Document, KeepsLocalMaterialsOfSeveralObjectsApart) {
    Node root = sample();
    Node second = at(root, "HEAD/OBJE");
    Node& spine = at(second, "OBJE/SKIN/SKIN");
    spine.children.insert(spine.children.begin(), at(second, "OBJE/SKIN/MATE"));
    edit<SubmeshRecord>(child(spine, "POLY"), [](auto& submesh) { submesh.material = kLocalMaterial; });
    root.children.push_back(second);
    edit<VersionRecord>(at(root, "HEAD/VERS"), [](auto& version) {
        version = sample_version();
        version.objects = 2, version.joints = 8, version.meshes = 4, version.vertices = 20, version.clips = 2,
        version.materials = 4;
    });
    EXPECT_EQ(faults_in(root), Lines{});
    const Loaded loaded(root);
    EXPECT_EQ(loaded.document.objects.at(0).skeleton.submeshes[0].material, 1u);
    EXPECT_EQ(loaded.document.objects.at(1).skeleton.submeshes[0].material, 2u);
    EXPECT_EQ(loaded.document.objects.at(1).skeleton.submeshes[1].material, 3u);
}

template <class Change>
Lines faults_with_submesh(const char* path, Change change) {
    Node root = sample();
    edit<SubmeshRecord>(at(root, path), change);
    return faults_in(root);
}

TEST(Document, RefusesMaterialsThatAreNotThere) {
    const char* const hip = "HEAD/OBJE/SKIN/POLY";
    const Lines bad{"MATERIAL_RANGE HEAD/OBJE/SKIN/POLY"};
    EXPECT_EQ(faults_with_submesh(hip, [](auto& submesh) { submesh.material = 0; }), Lines{});
    for (const std::uint32_t material : {1u, 2u, 0x7fff'ffffu, kLocalMaterial | 1u, kNone - 1}) {
        EXPECT_EQ(faults_with_submesh(hip, [=](auto& submesh) { submesh.material = material; }), bad) << material;
    }
    // The spine has no local materials; the last joint's are the end of the table.
    EXPECT_EQ(faults_with_submesh("HEAD/OBJE/SKIN/SKIN/POLY", [](auto& submesh) { submesh.material = kLocalMaterial; }),
              Lines{"MATERIAL_RANGE HEAD/OBJE/SKIN/SKIN/POLY"});
    Node root = sample();
    Node& tail = at(root, "HEAD/OBJE/SKIN/SKIN[1]");
    Node polygons = at(root, "HEAD/OBJE/SKIN/POLY");
    tail.children.push_back(polygons);
    EXPECT_EQ(Loaded(root).lines(), Lines{"MATERIAL_RANGE HEAD/OBJE/SKIN/SKIN[1]/POLY"});
}

TEST(Document, RefusesMeshesThatAreNotThere) {
    for (const std::uint32_t mesh : {2u, 0x8000'0000u, kNone}) {
        EXPECT_EQ(faults_with_submesh("HEAD/OBJE/SKIN/POLY", [=](auto& submesh) { submesh.mesh = mesh; }),
                  Lines{"MESH_RANGE HEAD/OBJE/SKIN/POLY"});
    }
}

TEST(Document, RefusesPolygonsPastTheIndices) {
    const char* const hip = "HEAD/OBJE/SKIN/POLY";
    const Lines bad{"INDEX_RANGE HEAD/OBJE/SKIN/POLY"};
    const auto faults = [&](std::uint32_t first, std::uint32_t count) {
        return faults_with_submesh(hip, [=](auto& submesh) { submesh.first = first, submesh.count = count; });
    };
    EXPECT_EQ(faults(0, 3), Lines{});
    EXPECT_EQ(faults(6, 0), Lines{});
    EXPECT_EQ(faults(0, 6), Lines{"SUBMESH_OVERLAP HEAD/OBJE/SKIN/SKIN/POLY"});  // inside them, at any rate
    EXPECT_EQ(faults(4, 3), bad);
    EXPECT_EQ(faults(7, 0), bad);
    EXPECT_EQ(faults(0, 9), bad);
    EXPECT_EQ(faults(kNone, 3), bad);
    EXPECT_EQ(faults(1, 0xffff'ffffu), bad);  // whose sum wraps to 0 in 32 bits
}

TEST(Document, RefusesPolygonsOfAMeshWithoutIndices) {
    Node root = sample();
    remove(at(root, "HEAD/OBJE/VECT"), "INDX");
    EXPECT_EQ(faults_in(root), (Lines{"INDEX_RANGE HEAD/OBJE/SKIN/POLY", "INDEX_RANGE HEAD/OBJE/SKIN/SKIN/POLY"}));
}

TEST(Document, RefusesAVertexOfARigidMeshThatTwoJointsMove) {
    Node root = sample();
    Node& indices = at(root, "HEAD/OBJE/VECT[1]/INDX");
    set(indices, sizeof(StreamRecord) + 5 * sizeof(std::uint32_t),
        2u);  // the spine's point, a corner of the head's triangle
    EXPECT_EQ(faults_in(root), Lines{"RIGID_SHARED HEAD/OBJE/SKIN/SKIN/POLY[1]"});
    set(indices, sizeof(StreamRecord) + 5 * sizeof(std::uint32_t), 5u);
    set(indices, sizeof(StreamRecord) + 3 * sizeof(std::uint32_t), 2u);  // the head's line: the same joint
    EXPECT_EQ(faults_in(root), Lines{});
}

TEST(Document, LetsJointsShareTheVerticesOfASkinnedMesh) {
    // The two triangles of the sample have an edge in common.
    const Loaded sample(sample_file());
    const MeshView& mesh = sample.document.objects.at(0).meshes.at(0);
    EXPECT_EQ(mesh.indices->index(1, 0), mesh.indices->index(4, 0));
    EXPECT_EQ(sample.lines(), Lines{});
}

TEST(Document, RefusesPolygonsThatOverlap) {
    const char* const spine = "HEAD/OBJE/SKIN/SKIN/POLY";
    const auto faults = [&](std::uint32_t first, std::uint32_t count) {
        return faults_with_submesh(spine, [=](auto& submesh) { submesh.first = first, submesh.count = count; });
    };
    EXPECT_EQ(faults(3, 3), Lines{});
    EXPECT_EQ(faults(1, 0), Lines{});
    EXPECT_EQ(faults(2, 3), Lines{"SUBMESH_OVERLAP HEAD/OBJE/SKIN/SKIN/POLY"});
    EXPECT_EQ(faults(0, 3).size(), 1u);
    EXPECT_EQ(faults(0, 6).size(), 1u);
    // In another mesh the same numbers are other indices.
    EXPECT_EQ(faults_with_submesh(spine, [](auto& submesh) { submesh.mesh = 1, submesh.first = 5, submesh.count = 0; }),
              Lines{});
}

TEST(Document, HoldsEveryCountOfTheVersionAgainstTheFile) {
    for (const std::size_t offset :
         {offsetof(VersionRecord, objects), offsetof(VersionRecord, joints), offsetof(VersionRecord, meshes),
          offsetof(VersionRecord, vertices), offsetof(VersionRecord, clips), offsetof(VersionRecord, materials),
          offsetof(VersionRecord, textures)}) {
        for (const std::uint32_t change : {1u, ~0u}) {
            Node root = sample();
            edit<std::uint32_t>(
                at(root, "HEAD/VERS"), [=](std::uint32_t& count) { count += change; }, offset);
            EXPECT_EQ(faults_in(root), Lines{"COUNT_MISMATCH HEAD/VERS"}) << offset;
        }
    }
    Node root = sample();
    edit<VersionRecord>(at(root, "HEAD/VERS"), [](auto& version) { version.vertices |= std::uint64_t{1} << 32; });
    EXPECT_EQ(faults_in(root), Lines{"COUNT_MISMATCH HEAD/VERS"});
}

TEST(Document, RefusesOtherSignaturesAndMajorVersions) {
    for (std::size_t byte = 0; byte < kSignature.size(); ++byte) {
        Node root = sample();
        edit<VersionRecord>(at(root, "HEAD/VERS"), [=](auto& version) { version.signature[byte] ^= 0x20; });
        EXPECT_EQ(faults_in(root), Lines{"SIGNATURE HEAD/VERS"}) << byte;
    }
    Node root = sample();
    edit<VersionRecord>(at(root, "HEAD/VERS"), [](auto& version) { version.major = kVersionMajor + 1; });
    EXPECT_EQ(faults_in(root), Lines{"UNSUPPORTED_VERSION HEAD/VERS"});
}

TEST(Document, TakesLaterMinorVersionsWithWhatTheyAdd) {
    Node root = sample();
    Node& version = at(root, "HEAD/VERS");
    edit<VersionRecord>(version, [](auto& record) { record.minor = 65535; });
    version.payload.resize(version.payload.size() + 100, std::byte{0xee});
    EXPECT_EQ(faults_in(root), Lines{});
}

TEST(Document, RefusesAReservedFieldOfTheVersion) {
    Node root = sample();
    edit<VersionRecord>(at(root, "HEAD/VERS"), [](auto& record) { record.reserved = 0x100; });
    EXPECT_EQ(faults_in(root), Lines{"RESERVED_FIELD HEAD/VERS"});
}

TEST(Document, WantsTheGeneratorToBeTextAndThenZeros) {
    const auto faults = [](std::string_view generator) {
        Node root = sample();
        edit<VersionRecord>(at(root, "HEAD/VERS"), [&](auto& record) {
            record.generator = {};
            std::memcpy(record.generator.data(), generator.data(), generator.size());
        });
        return faults_in(root);
    };
    EXPECT_EQ(faults(""), Lines{});
    EXPECT_EQ(faults("0123456789abcdef0123456789abcdef"), Lines{});  // to the last byte
    EXPECT_EQ(faults("\xe2\x82\xac"), Lines{});
    EXPECT_EQ(faults("a\xff"), Lines{"NOT_UTF8 HEAD/VERS"});
    EXPECT_EQ(faults("0123456789abcdef0123456789abcde\xe2"), Lines{"NOT_UTF8 HEAD/VERS"});
    EXPECT_EQ(faults(std::string_view("a\0b", 3)), Lines{"RESERVED_FIELD HEAD/VERS"});
    EXPECT_EQ(faults(std::string_view("\0\0\0b", 4)), Lines{"RESERVED_FIELD HEAD/VERS"});
}

TEST(Document, ReadsAVersionWithoutAGenerator) {
    Node root = sample();
    Node& version = at(root, "HEAD/VERS");
    version.payload.resize(offsetof(VersionRecord, generator));
    EXPECT_EQ(faults_in(root), Lines{});
    version.payload.pop_back();
    EXPECT_EQ(faults_in(root), Lines{"RECORD_TOO_SHORT HEAD/VERS"});
}

TEST(Document, SurvivesKnownChunksOfTheWrongShapeAnywhere) {
    const Loaded good(sample_file());
    for (std::uint32_t number = 1; number < good.tree.chunks().size(); ++number) {
        const std::string path = chunk_path(good.file, good.tree[number].offset);
        Node root = sample();
        Node& node = at(root, path);
        if (node.is_container()) {
            node = make_leaf(node.id, Buffer(40, std::byte{1}));
        } else {
            node =
                make_container(node.id, {make_leaf(FourCC("NAME"), as_byte_span("x")), make_container(FourCC("SKIN"))});
        }
        EXPECT_FALSE(faults_in(root).empty()) << path;
    }
}

TEST(Document, SurvivesTheLossOfAnyChunk) {
    const Loaded good(sample_file());
    for (std::uint32_t number = 1; number < good.tree.chunks().size(); ++number) {
        const std::string path = chunk_path(good.file, good.tree[number].offset);
        Node root = sample();
        Node& parent = at(root, chunk_path(good.file, good.tree[good.tree[number].parent].offset));
        const auto index = &at(root, path) - parent.children.data();
        parent.children.erase(parent.children.begin() + index);
        const Faults faults = validate(to_file(root));
        for (const Error& fault : faults.list()) EXPECT_EQ(error_class(fault.code), ErrorClass::invalid) << path;
    }
}

}  // namespace
}  // namespace bendy::document_test
