#include <bendy/runtime/model.h>

#include <bendy/runtime/pose.h>
#include <bendy/runtime/skin.h>

#include "runtime/build_model.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace bendy::model_test {
namespace {

using test::Buffer;
using test::Owned;

ErrorCode refusal(Bytes bytes, const OpenOptions& options = {}) {
    const Result<Model> model = Model::from_memory(bytes, options);
    EXPECT_FALSE(model.has_value());
    return model ? ErrorCode::kCannotWrite : model.error().code;
}

TEST(Model, HoldsTheSample) {
    const Owned model(test::sample_file());
    EXPECT_EQ(model->name(), "fox");
    ASSERT_EQ(model->joints().size(), 4u);
    const std::vector<std::uint32_t> parents{kNone, 0, 1, 0};
    const std::vector<std::string_view> names{"hip", "spine", "head", "tail \xc3\xa9"};
    const std::vector<float> up{1.0f, 0.5f, 0.25f, -0.25f};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(model->joints()[i].parent, parents[i]);
        EXPECT_EQ(model->joints()[i].name, names[i]);
        EXPECT_EQ(model->joints()[i].rest.translation, glm::vec3(0, up[i], 0));
        EXPECT_EQ(model->joints()[i].rest.scale, glm::vec3(1.0f));
        EXPECT_EQ(model->joints()[i].rest.rotation.w, 1.0f);
    }
    EXPECT_EQ(model->joints()[0].extras, R"({"mass":3})");
    EXPECT_EQ(model->meshes().size(), 2u);
    EXPECT_EQ(model->clips().size(), 1u);
    EXPECT_EQ(model->textures().size(), 3u);
    EXPECT_EQ(model->joint_submeshes().size(), 5u);
    EXPECT_EQ(model->largest_palette(), 2u);
}

TEST(Model, RestTransformsComeWithRotationAndShear) {
    test::ModelSpec spec;
    spec.joints.resize(1);
    spec.joints[0].rest.rotation = {0.5f, -0.5f, 0.5f, -0.5f};
    spec.joints[0].rest.shear = {1, 2, 3};
    const Owned model(test::build_file(spec));
    const glm::quat rotation = model->joints()[0].rest.rotation;
    EXPECT_EQ(rotation.x, 0.5f);
    EXPECT_EQ(rotation.y, -0.5f);
    EXPECT_EQ(rotation.z, 0.5f);
    EXPECT_EQ(rotation.w, -0.5f);
    EXPECT_EQ(model->joints()[0].shear, glm::vec3(1, 2, 3));
}

TEST(Model, VerticesAndTargetsAreNumberedMeshAfterMesh) {
    const Owned model(test::sample_file());
    EXPECT_EQ(model->vertex_count(), 10u);
    EXPECT_EQ(model->first_vertex(0), 0u);
    EXPECT_EQ(model->first_vertex(1), 4u);
    EXPECT_EQ(model->morph_target_count(), 2u);
    EXPECT_EQ(model->first_morph_target(0), 0u);
    EXPECT_EQ(model->first_morph_target(1), 2u);
}

TEST(Model, FindsByNameTheFirstOfEqualNames) {
    test::Node file = test::sample();
    test::Node& object = test::at(file, "HEAD/OBJE");
    object.children.push_back(test::child(object, "CYCL"));  // "run" again
    test::at(file, "HEAD/OBJE/SKIN/SKIN[1]/NAME") =
        test::at(file, "HEAD/OBJE/SKIN/SKIN/NAME");  // the tail is "spine", too
    const Owned model(test::to_file(file));
    ASSERT_EQ(model->clips().size(), 2u);
    EXPECT_EQ(model->clip("run"), model->clips().data());
    EXPECT_EQ(model->clip("Run"), nullptr);
    EXPECT_EQ(model->clip(""), nullptr);
    EXPECT_EQ(model->joint("spine"), 1u);
    EXPECT_EQ(model->joint("head"), 2u);
    EXPECT_EQ(model->joint("nobody"), kNone);
    EXPECT_EQ(model->chain("back"), model->chains().data());
    EXPECT_EQ(model->chain("front"), nullptr);
}

TEST(Model, HoldsItsClipsMarkers) {
    test::Node file = test::sample();
    test::at(file, "HEAD/OBJE/CYCL")
        .children.push_back(
            test::make_leaf(FourCC("MARK"), test::markers_payload({{0.5f, 4}, {0.5f, 4}, {1.0f, 7}}, "stephit")));
    const Owned model(test::to_file(file));
    const std::span<const Marker> markers = model->clip("run")->markers;
    ASSERT_EQ(markers.size(), 3u);
    EXPECT_EQ(markers[0].name, "step");
    EXPECT_EQ(markers[1].name, "");
    EXPECT_EQ(markers[2].name, "hit");
    EXPECT_EQ(markers[2].seconds, 1.0f);
}

TEST(Model, HoldsRolesInPlace) {
    EXPECT_TRUE(Owned(test::sample_file())->roles().empty());
    test::Node file = test::sample();
    const std::vector<RoleRecord> roles{{0, static_cast<std::uint16_t>(Role::hips), 0},
                                        {3, static_cast<std::uint16_t>(Role::tail), 0}};
    test::at(file, "HEAD/OBJE").children.push_back(test::make_leaf(FourCC("ROLE"), test::bytes_of_all(roles)));
    const Owned model(test::to_file(file));
    ASSERT_EQ(model->roles().size(), 2u);
    EXPECT_EQ(model->roles()[0].joint, 0u);
    EXPECT_EQ(model->roles()[1].joint, 3u);
    EXPECT_EQ(static_cast<Role>(model->roles()[1].role), Role::tail);
}

// --- draws

TEST(Model, DrawsMeanTheMaterialsOfTheWholeFile) {
    const Owned model(test::sample_file());
    ASSERT_EQ(model->materials().size(), 2u);  // HEAD's "red", then the one inside joint 0
    EXPECT_EQ(model->materials()[0].name, "red");
    EXPECT_EQ(model->materials()[1].surface.metallic, 0.25f);
    struct Expected {
        std::uint32_t mesh, material;
        Topology topology;
        std::uint32_t first, count;
    };
    const std::vector<Expected> expected{{0, 1, Topology::triangles, 0, 3},
                                         {0, kNone, Topology::triangles, 3, 3},
                                         {1, 0, Topology::triangles, 0, 3},
                                         {1, 0, Topology::lines, 3, 2},
                                         {1, kNone, Topology::points, 5, 1}};
    ASSERT_EQ(model->submeshes().size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const Submesh& submesh = model->submeshes()[i];
        EXPECT_EQ(submesh.mesh, expected[i].mesh) << i;
        EXPECT_EQ(submesh.material, expected[i].material) << i;
        EXPECT_EQ(submesh.topology, expected[i].topology) << i;
        EXPECT_EQ(submesh.first, expected[i].first) << i;
        EXPECT_EQ(submesh.count, expected[i].count) << i;
    }
}

TEST(Model, OneSubmeshAMaterialWhateverJointsThePolygonsBelongTo) {
    test::Node file = test::sample();
    test::Node& hip = test::at(file, "HEAD/OBJE/SKIN");
    test::Node& spine = test::at(file, "HEAD/OBJE/SKIN/SKIN");
    test::edit<SubmeshRecord>(test::child(hip, "POLY"), [](SubmeshRecord& record) { record.material = 0; });
    test::edit<SubmeshRecord>(test::child(spine, "POLY"), [](SubmeshRecord& record) { record.material = 0; });
    const Owned model(test::to_file(file));
    ASSERT_EQ(model->submeshes().size(), 4u);
    EXPECT_EQ(model->submeshes()[0].first, 0u);
    EXPECT_EQ(model->submeshes()[0].count, 6u);
    EXPECT_EQ(model->submeshes()[0].material, 0u);
    ASSERT_EQ(model->joint_submeshes().size(), 5u);  // the joints keep their own
    EXPECT_EQ(model->joint_submeshes()[0].count, 3u);
}

TEST(Model, DrawsJoinAcrossJointsInAnyOrderButNotAcrossGaps) {
    test::ModelSpec spec;
    // Joint 0 has the last range, joint 2 the first; entries 9 to 11 belong to nobody.
    spec.joints = {{kNone, {}, {test::submesh(0, 6, 3), test::submesh(0, 12, 3)}, ""},
                   {0, {}, {test::submesh(0, 3, 3)}, ""},
                   {0, {}, {test::submesh(0, 0, 3), test::submesh(1, 0, 3)}, ""}};
    spec.meshes.resize(2);
    for (test::MeshSpec& mesh : spec.meshes) {
        mesh.joint = 0;
        mesh.positions.resize(15);
    }
    for (std::uint32_t i = 0; i < 15; ++i) spec.meshes[0].indices.push_back(i);
    spec.meshes[1].indices = {0, 1, 2};
    const Owned model(test::build_file(spec));
    ASSERT_EQ(model->submeshes().size(), 3u);
    EXPECT_EQ(model->submeshes()[0].count, 9u);
    EXPECT_EQ(model->submeshes()[1].first, 12u);
    EXPECT_EQ(model->submeshes()[1].count, 3u);
    EXPECT_EQ(model->submeshes()[2].mesh, 1u);
    EXPECT_EQ(model->submeshes()[2].count, 3u);
}

// --- moves

TEST(Model, MovesKeepEveryViewValid) {
    const Buffer bytes = test::sample_file();
    Result<Model> opened = Model::from_memory(bytes);
    ASSERT_TRUE(opened.has_value());
    const Joint* joints = opened->joints().data();
    const Clip* run = opened->clip("run");
    const Mesh* meshes = opened->meshes().data();
    const Submesh* submeshes = opened->submeshes().data();
    Model model = *std::move(opened);
    Model other = std::move(model);
    EXPECT_EQ(other.joints().data(), joints);
    EXPECT_EQ(other.clip("run"), run);
    EXPECT_EQ(other.meshes().data(), meshes);
    EXPECT_EQ(other.submeshes().data(), submeshes);
    EXPECT_EQ(joints[1].name, "spine");
    EXPECT_EQ(run->tracks.size(), 5u);

    const Buffer rope = test::rope_file(3);
    Result<Model> second = Model::from_memory(rope);
    ASSERT_TRUE(second.has_value());
    other = *std::move(second);
    EXPECT_EQ(other.joints().size(), 3u);
}

TEST(Model, AFileStaysMappedThroughMoves) {
    const test::TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "file.bendy";
    const Buffer bytes = test::sample_file();
    std::ofstream(path, std::ios::binary).write(as_text(bytes).data(), static_cast<std::streamsize>(bytes.size()));
    Result<Model> opened = Model::open(path);
    ASSERT_TRUE(opened.has_value());
    std::error_code refused;  // on Windows, where a mapped file cannot be removed
    std::filesystem::remove(path, refused);
    const Model model = *std::move(opened);
    EXPECT_EQ(model.joints()[2].name, "head");
    Pose pose(model);
    std::vector<glm::vec3> positions(model.vertex_count());
    ASSERT_TRUE(skin(pose, {.out = {.positions = positions}}));
    EXPECT_EQ(positions[4], glm::vec3(0, 1.75f, 0));
}

// --- what is refused

TEST(Model, OpensNoMissingFileAndNoFolder) {
    const auto missing = Model::open(std::filesystem::path(testing::TempDir()) / "no such file.bendy");
    ASSERT_FALSE(missing.has_value());
    EXPECT_EQ(missing.error().code, ErrorCode::kCannotOpen);
    const auto folder = Model::open(testing::TempDir());
    ASSERT_FALSE(folder.has_value());
    EXPECT_EQ(error_class(folder.error().code), ErrorClass::io);
}

TEST(Model, RefusesNothingAndAnythingElse) {
    EXPECT_EQ(error_class(refusal({})), ErrorClass::malformed);
    const Buffer zeros(4096);
    EXPECT_EQ(refusal(zeros), ErrorCode::kNotABendyFile);
}

TEST(Model, RefusesEveryPrefixOfAFile) {
    const Buffer file = test::sample_file();
    for (std::size_t size = 0; size < file.size(); ++size) {
        const Buffer prefix(file.begin(),
                            file.begin() + static_cast<std::ptrdiff_t>(size));  // its own memory: reads past it show
        ASSERT_EQ(error_class(refusal(prefix)), ErrorClass::malformed) << size;
    }
}

TEST(Model, RefusesBytesThatAreNotAligned) {
    const Buffer file = test::sample_file();
    Buffer shifted(file.size() + kChunkAlignment);
    for (std::size_t shift = 0; shift < kChunkAlignment; ++shift) {
        std::memcpy(shifted.data() + shift, file.data(), file.size());
        const Bytes bytes = Bytes(shifted).subspan(shift, file.size());
        if (shift == 0) {
            EXPECT_TRUE(Model::from_memory(bytes).has_value());
        } else {
            EXPECT_EQ(refusal(bytes), ErrorCode::kUnalignedBuffer) << shift;
        }
    }
}

TEST(Model, AWrongSumIsRefusedUnlessSumsAreNotAskedFor) {
    Buffer file = test::sample_file();
    const std::uint64_t name = test::place_of(file, "HEAD/OBJE/NAME");
    test::patch(file, name + kChunkHeaderSize, 'F');
    const auto refused = Model::from_memory(file);
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().code, ErrorCode::kSumMismatch);
    EXPECT_EQ(refused.error().offset, name);
    OpenOptions options;
    options.sums = Sums::later;
    const Owned model(file, options);
    EXPECT_EQ(model->name(), "Fox");
    const Result<void> checked = model->check_sums();
    ASSERT_FALSE(checked.has_value());
    EXPECT_EQ(checked.error().code, ErrorCode::kSumMismatch);
    EXPECT_EQ(checked.error().offset, name);
}

TEST(Model, SumsCanBeCheckedAtAnyTime) {
    const Buffer file = test::sample_file();
    for (const Sums sums : {Sums::checked, Sums::later}) {
        OpenOptions options;
        options.sums = sums;
        const Owned model(file, options);
        EXPECT_TRUE(model->check_sums().has_value());
    }
}

TEST(Model, SumsAreCheckedOverAFileThatWasChangedMeanwhile) {
    Buffer file = test::sample_file();
    const auto model = Model::from_memory(file);
    ASSERT_TRUE(model.has_value());
    EXPECT_TRUE(model->check_sums().has_value());
    test::patch(file, 8, std::uint64_t{0});  // HEAD's own size
    const auto checked = model->check_sums();
    ASSERT_FALSE(checked.has_value());
    EXPECT_NE(checked.error().code, ErrorCode::kSumMismatch);
}

TEST(Model, WithoutSumsWhatIsWrongIsStillRefused) {
    Buffer file = test::sample_file();
    test::patch(file, test::place_of(file, "HEAD/OBJE/VECT/INDX") + kChunkHeaderSize + sizeof(StreamRecord),
                std::uint16_t{4});
    OpenOptions options;
    options.sums = Sums::later;
    EXPECT_EQ(refusal(file, options), ErrorCode::kIndexRange);
}

TEST(Model, OneOfSeveralObjects) {
    test::Node file = test::sample();
    test::Node second = test::at(file, "HEAD/OBJE");
    test::remove(second, "VECT");  // mesh 0 with all that means it
    test::remove(second, "CYCL");
    test::child(second, "NAME") = test::make_leaf(FourCC("NAME"), as_byte_span("wolf"));
    test::remove(test::child(second, "SKIN"), "POLY");
    test::remove(test::child(test::child(second, "SKIN"), "SKIN"), "POLY");
    for (test::Node* joint : {&test::child(test::child(second, "SKIN"), "SKIN"),
                              &test::child(test::child(test::child(second, "SKIN"), "SKIN"), "SKIN")}) {
        for (test::Node& node : joint->children) {
            if (node.id == FourCC("POLY"))
                test::edit<SubmeshRecord>(node, [](SubmeshRecord& record) { record.mesh = 0; });
        }
    }
    file.children.push_back(second);
    const Buffer bytes = test::to_file(file);
    EXPECT_EQ(Owned(bytes)->name(), "fox");
    OpenOptions options;
    options.object = 1;
    const Owned wolf(bytes, options);
    EXPECT_EQ(wolf->name(), "wolf");
    EXPECT_EQ(wolf->meshes().size(), 1u);
    EXPECT_EQ(wolf->vertex_count(), 6u);
    EXPECT_TRUE(wolf->clips().empty());
    EXPECT_EQ(wolf->materials().size(), 3u);  // HEAD's, and a local one of either object
    for (const std::uint32_t object : {2u, 3u, kNone}) {
        options.object = object;
        const auto refused = Model::from_memory(bytes, options);
        ASSERT_FALSE(refused.has_value()) << object;
        EXPECT_EQ(error_class(refused.error().code), ErrorClass::invalid);
    }
}

TEST(Model, MayHaveItsFileInMemory) {
    const test::TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "fox.bendy";
    const Buffer bytes = test::sample_file();
    ASSERT_TRUE(write_file(path, bytes).has_value());
    OpenOptions options;
    options.storage = Storage::copied;
    const auto model = Model::open(path, options);
    ASSERT_TRUE(model.has_value());
    std::filesystem::resize_file(path, 0);  // would end the program by SIGBUS if it were mapped
    EXPECT_EQ(model->name(), "fox");
    EXPECT_TRUE(model->check_sums().has_value());
    EXPECT_FALSE(Model::open(path, options).has_value());
}

TEST(Model, AFileWithoutObjectsIsNoModel) {
    test::Node file = test::sample();
    test::remove(file, "OBJE");
    EXPECT_EQ(refusal(test::to_file(file)), ErrorCode::kChunkMissing);
}

// --- what moves rigid vertices

TEST(Model, RigidMoversAreTheMeshesJointOrThatOfThePolygons) {
    const Owned model(test::sample_file());
    for (std::uint32_t vertex = 0; vertex < 5; ++vertex) EXPECT_EQ(model->rigid_mover(1, vertex), 2u) << vertex;
    EXPECT_EQ(model->rigid_mover(1, 5), 1u);
}

TEST(Model, TenThousandNestedJointsLoad) {
    const Owned model(test::rope_file(10'000));
    ASSERT_EQ(model->joints().size(), 10'000u);
    EXPECT_EQ(model->joints()[9'999].parent, 9'998u);
}

}  // namespace
}  // namespace bendy::model_test
