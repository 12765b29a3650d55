// Streams, bind palettes, morph targets and movers through the C API: the numbers of test::sample_file, and the C++
// API's.
#include "capi/open_handles.h"
#include "source_folder.h"

#include <cstring>
#include <string>

namespace bendy::test::geometry_test {
namespace {

using Floats = std::vector<float>;
using Integers = std::vector<std::uint32_t>;

class CGeometry : public testing::Test {
protected:
    bendy_stream stream(std::uint32_t mesh, std::uint32_t kind, std::uint32_t set = 0) {
        auto out = sized<bendy_stream>();
        const std::uint32_t number = bendy_find_stream(model_.get(), mesh, kind, set, &error_);
        EXPECT_EQ(bendy_get_stream(model_.get(), mesh, number, &out, &error_), BENDY_OK) << error_.message;
        return out;
    }
    Floats numbers(std::uint32_t mesh, std::uint32_t kind, std::uint32_t set = 0) {
        const bendy_stream found = stream(mesh, kind, set);
        Floats numbers(std::size_t{found.elements} * found.components);
        EXPECT_EQ(bendy_get_numbers(model_.get(), mesh, bendy_find_stream(model_.get(), mesh, kind, set, nullptr),
                                    numbers.data(), numbers.size(), &error_),
                  BENDY_OK)
            << error_.message;
        return numbers;
    }
    Integers integers(std::uint32_t mesh, std::uint32_t kind) {
        const bendy_stream found = stream(mesh, kind);
        Integers integers(std::size_t{found.elements} * found.components);
        EXPECT_EQ(bendy_get_integers(model_.get(), mesh, bendy_find_stream(model_.get(), mesh, kind, 0, nullptr),
                                     integers.data(), integers.size(), &error_),
                  BENDY_OK)
            << error_.message;
        return integers;
    }
    std::string message(bendy_status status) {
        EXPECT_EQ(status, BENDY_BAD_ARGUMENT);
        return error_.message;
    }

    const Owned expected_{sample_file()};
    const ModelHandle model_ = open_copy(sample_file());
    bendy_error error_ = BENDY_ERROR_INIT;
};

TEST_F(CGeometry, EveryStreamOfAMeshIsListed) {
    EXPECT_EQ(bendy_stream_count(model_.get(), 0), 10u);
    EXPECT_EQ(bendy_stream_count(model_.get(), 1), 2u) << "positions and indices";
    EXPECT_EQ(bendy_stream_count(model_.get(), 2), 0u);
    EXPECT_EQ(bendy_stream_count(nullptr, 0), 0u);
    const std::uint32_t kinds[]{BENDY_STREAM_POSITIONS,      BENDY_STREAM_NORMALS,        BENDY_STREAM_TANGENTS,
                                BENDY_STREAM_TEXTURE_COORDS, BENDY_STREAM_TEXTURE_COORDS, BENDY_STREAM_COLOURS,
                                BENDY_STREAM_ATTRIBUTE,      BENDY_STREAM_BONES,          BENDY_STREAM_WEIGHTS,
                                BENDY_STREAM_INDICES};
    for (std::uint32_t number = 0; number < 10; ++number) {
        auto out = sized<bendy_stream>();
        ASSERT_EQ(bendy_get_stream(model_.get(), 0, number, &out, &error_), BENDY_OK);
        EXPECT_EQ(out.kind, kinds[number]);
        EXPECT_STREQ(out.name, out.kind == BENDY_STREAM_ATTRIBUTE ? "_WIND" : "");
    }
}

TEST_F(CGeometry, StreamsHaveTheFilesNumbers) {
    EXPECT_EQ(numbers(0, BENDY_STREAM_POSITIONS), (Floats{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}));
    EXPECT_EQ(numbers(0, BENDY_STREAM_NORMALS), (Floats{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}));
    EXPECT_EQ(numbers(0, BENDY_STREAM_TANGENTS), (Floats{1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1, 1, 0, 0, -1}));
    EXPECT_EQ(numbers(0, BENDY_STREAM_TEXTURE_COORDS, 1), (Floats{0, 0, 1, 0, 0, 1, 1, 1}));
    EXPECT_EQ(numbers(0, BENDY_STREAM_COLOURS), (Floats{1, 0, 0, 0, 1, 0, 0, 0, 1, 0.2f, 0.2f, 0.2f}));
    EXPECT_EQ(numbers(0, BENDY_STREAM_ATTRIBUTE), (Floats{-32768, 0, 1, 32767}));
    EXPECT_EQ(numbers(0, BENDY_STREAM_WEIGHTS), (Floats{1, 0, 0.75f, 0.25f, 0.5f, 0.5f, 1, 0}));
    EXPECT_EQ(integers(0, BENDY_STREAM_BONES), (Integers{0, 1, 0, 1, 1, 0, 1, 1}));
    EXPECT_EQ(integers(0, BENDY_STREAM_INDICES), (Integers{0, 1, 2, 2, 1, 3}));
}

TEST_F(CGeometry, StoredNumbersAreThereWithoutACopy) {
    const bendy_stream colours = stream(0, BENDY_STREAM_COLOURS);
    EXPECT_EQ(colours.type, static_cast<std::uint32_t>(BENDY_U8));
    EXPECT_EQ(colours.normalised, 1u);
    EXPECT_EQ(colours.elements, 4u);
    EXPECT_EQ(colours.components, 3u);
    ASSERT_EQ(colours.data_size, 12u);
    EXPECT_EQ(std::memcmp(colours.data, "\xff\0\0\0\xff\0\0\0\xff\x33\x33\x33", 12), 0);
    const bendy_stream coords = stream(0, BENDY_STREAM_TEXTURE_COORDS, 1);
    EXPECT_EQ(coords.set, 1u);
    EXPECT_EQ(coords.type, static_cast<std::uint32_t>(BENDY_U16));
    const bendy_stream indices = stream(0, BENDY_STREAM_INDICES);
    EXPECT_EQ(indices.type, static_cast<std::uint32_t>(BENDY_U16));
    EXPECT_EQ(indices.normalised, 0u);
    EXPECT_EQ(indices.data_size, 12u);
}

// Quantised positions and octahedral normals.
TEST_F(CGeometry, EncodedStreamsAreDecodedAsInCpp) {
    const std::string path = (source_folder() / "tests/seeds/rope_compact.bendy").string();
    const auto expected = Model::open(path);
    ASSERT_TRUE(expected.has_value());
    const ModelHandle model(bendy_open(path.c_str(), nullptr, &error_));
    ASSERT_NE(model, nullptr) << error_.message;
    const Mesh& mesh = expected->meshes()[0];
    for (const bool has_normals : {false, true}) {
        const StreamView& view = has_normals ? *mesh.normals : mesh.positions;
        ASSERT_FALSE(view.type == ComponentType::f32) << "or the file has nothing to decode";
        const std::uint32_t number =
            bendy_find_stream(model.get(), 0, has_normals ? BENDY_STREAM_NORMALS : BENDY_STREAM_POSITIONS, 0, nullptr);
        auto stream = sized<bendy_stream>();
        ASSERT_EQ(bendy_get_stream(model.get(), 0, number, &stream, &error_), BENDY_OK);
        EXPECT_EQ(stream.components, 3u);
        EXPECT_EQ(stream.data, nullptr);
        EXPECT_EQ(stream.data_size, 0u);
        Floats numbers(std::size_t{3} * mesh.vertices);
        ASSERT_EQ(bendy_get_numbers(model.get(), 0, number, numbers.data(), numbers.size(), &error_), BENDY_OK);
        for (std::uint32_t k = 0; k < numbers.size(); ++k)
            EXPECT_EQ(numbers[k], view.vec3(k / 3)[static_cast<int>(k % 3)]);
        Integers integers(numbers.size());
        EXPECT_EQ(message(bendy_get_integers(model.get(), 0, number, integers.data(), integers.size(), &error_)),
                  "the stream has no unsigned integers: get its numbers");
    }
}

TEST_F(CGeometry, BindPaletteIsTheMeshs) {
    const PaletteView& palette = expected_->meshes()[0].palette;
    Integers joints(2);
    Floats matrices(32);
    ASSERT_EQ(bendy_get_bind_palette(model_.get(), 0, joints.data(), matrices.data(), 2, &error_), BENDY_OK);
    EXPECT_EQ(joints, (Integers{0, 1}));
    for (std::size_t k = 0; k < 32; ++k)
        EXPECT_EQ(matrices[k], palette.inverse_bind()[k / 16][static_cast<int>(k % 16 / 4)][static_cast<int>(k % 4)]);
    EXPECT_EQ(matrices[29], -1.0f);
    EXPECT_EQ(bendy_get_bind_palette(model_.get(), 0, nullptr, nullptr, 2, &error_), BENDY_OK);
    EXPECT_EQ(message(bendy_get_bind_palette(model_.get(), 0, joints.data(), nullptr, 1, &error_)),
              "the palette has room for 1, 2 are needed");
    EXPECT_EQ(message(bendy_get_bind_palette(model_.get(), 1, joints.data(), nullptr, 2, &error_)),
              "mesh 1 is rigid: it has no bones");
}

TEST_F(CGeometry, MoversAreTheRigidMeshs) {
    Integers joints(6);
    ASSERT_EQ(bendy_get_movers(model_.get(), 1, joints.data(), 6, &error_), BENDY_OK);
    for (std::uint32_t vertex = 0; vertex < 6; ++vertex) EXPECT_EQ(joints[vertex], expected_->rigid_mover(1, vertex));
    EXPECT_EQ(joints, (Integers{2, 2, 2, 2, 2, 1}));
    auto mesh = sized<bendy_mesh>();
    ASSERT_EQ(bendy_get_mesh(model_.get(), 1, &mesh, &error_), BENDY_OK);
    EXPECT_EQ(mesh.mover, BENDY_NONE) << "two joints move it";
    EXPECT_EQ(message(bendy_get_movers(model_.get(), 1, joints.data(), 5, &error_)),
              "joints has room for 5, 6 are needed");
    EXPECT_EQ(message(bendy_get_movers(model_.get(), 0, joints.data(), 6, &error_)),
              "mesh 0 is not rigid: its bones move it");
    const ModelHandle one = open_copy(two_joint_file());
    ASSERT_EQ(bendy_get_mesh(one.get(), 0, &mesh, &error_), BENDY_OK);
    EXPECT_EQ(mesh.mover, 0u);
}

TEST_F(CGeometry, DisplacementsAreTheTargets) {
    auto target = sized<bendy_morph_target>();
    ASSERT_EQ(bendy_get_morph_target(model_.get(), 1, &target, &error_), BENDY_OK);
    EXPECT_EQ(target.vertices, 2u);
    EXPECT_EQ(target.has_positions, 1u);
    EXPECT_EQ(target.has_normals, 0u);
    EXPECT_EQ(target.has_tangents, 1u);
    Integers vertices(2);
    Floats positions(6);
    Floats normals(6, 5.0f);
    Floats tangents(6);
    ASSERT_EQ(bendy_get_displacements(model_.get(), 1, vertices.data(), positions.data(), normals.data(),
                                      tangents.data(), 2, &error_),
              BENDY_OK);
    EXPECT_EQ(vertices, (Integers{1, 3}));
    EXPECT_EQ(positions, (Floats{9, 0, 0, 0, 9, 0}));
    EXPECT_EQ(normals, Floats(6, 0.0f));
    EXPECT_EQ(tangents, (Floats{0, 0, 9, 0, 0, 8}));
    ASSERT_EQ(bendy_get_morph_target(model_.get(), 0, &target, &error_), BENDY_OK);
    EXPECT_EQ(target.vertices, 4u);
    Integers all(4);
    ASSERT_EQ(bendy_get_displacements(model_.get(), 0, all.data(), nullptr, nullptr, nullptr, 4, &error_), BENDY_OK);
    EXPECT_EQ(all, (Integers{0, 1, 2, 3}));
    message(bendy_get_displacements(model_.get(), 0, all.data(), nullptr, nullptr, nullptr, 3, &error_));
    EXPECT_EQ(message(bendy_get_displacements(model_.get(), 2, all.data(), nullptr, nullptr, nullptr, 4, &error_)),
              "morph target 2 does not exist: the model has 2 morph targets");
}

TEST_F(CGeometry, MorphTargetsAreAppliedAsInCpp) {
    const Floats weights{0.5f, 2.0f};
    std::vector<glm::vec3> positions(4), normals(4);
    std::vector<glm::vec4> tangents(4);
    ASSERT_TRUE(apply_morph_targets(expected_->meshes()[0], weights, {positions, normals, tangents}));
    std::vector<glm::vec3> made(4), made_normals(4);
    std::vector<glm::vec4> made_tangents(4);
    ASSERT_EQ(bendy_apply_morph_targets(model_.get(), 0, weights.data(), &made[0].x, &made_normals[0].x,
                                        &made_tangents[0].x, 4, &error_),
              BENDY_OK)
        << error_.message;
    EXPECT_EQ(made, positions);
    EXPECT_EQ(made[3], glm::vec3(1, 19, 2));
    EXPECT_EQ(made_normals, normals);
    EXPECT_EQ(made_tangents, tangents);
    // Without weights: the mesh; only as many vertices as are asked for.
    ASSERT_EQ(bendy_apply_morph_targets(model_.get(), 0, nullptr, &made[0].x, nullptr, nullptr, 2, &error_), BENDY_OK);
    EXPECT_EQ(made[1], glm::vec3(1, 0, 0));
    EXPECT_EQ(made[3], glm::vec3(1, 19, 2));
    EXPECT_EQ(message(bendy_apply_morph_targets(model_.get(), 0, nullptr, &made[0].x, nullptr, nullptr, 5, &error_)),
              "expected at most 4 vertices, as many as mesh 0 has; found 5");
    const Floats bad{NAN, 0.0f};
    EXPECT_EQ(message(bendy_apply_morph_targets(model_.get(), 0, bad.data(), &made[0].x, nullptr, nullptr, 2, &error_)),
              "weights holds a number that is not finite");
}

TEST_F(CGeometry, MeshesSayWhichFramesTheyHave) {
    auto mesh = sized<bendy_mesh>();
    ASSERT_EQ(bendy_get_mesh(model_.get(), 0, &mesh, &error_), BENDY_OK);
    EXPECT_EQ(mesh.frames, expected_->meshes()[0].frames());
    EXPECT_EQ(mesh.first_frame, expected_->meshes()[0].first_frame);
    EXPECT_EQ(mesh.mover, BENDY_NONE);
    EXPECT_STREQ(mesh.extras, "{}");
    EXPECT_STREQ(mesh.more, "");
}

TEST_F(CGeometry, SubmeshesOfJointsAreTheModels) {
    ASSERT_EQ(bendy_joint_submesh_count(model_.get()), expected_->joint_submeshes().size());
    EXPECT_EQ(bendy_joint_submesh_count(nullptr), 0u);
    for (std::uint32_t number = 0; number < bendy_joint_submesh_count(model_.get()); ++number) {
        auto submesh = sized<bendy_joint_submesh>();
        ASSERT_EQ(bendy_get_joint_submesh(model_.get(), number, &submesh, &error_), BENDY_OK);
        const SubmeshView& view = expected_->joint_submeshes()[number];
        EXPECT_EQ(submesh.joint, view.joint);
        EXPECT_EQ(submesh.mesh, view.mesh);
        EXPECT_EQ(submesh.material, view.material);
        EXPECT_EQ(submesh.topology, static_cast<std::uint32_t>(view.topology));
        EXPECT_EQ(submesh.first, view.first);
        EXPECT_EQ(submesh.count, view.count);
    }
    auto submesh = sized<bendy_joint_submesh>();
    ASSERT_EQ(bendy_get_joint_submesh(model_.get(), 0, &submesh, &error_), BENDY_OK);
    EXPECT_EQ(submesh.material, 1u) << "a joint's own material has a number among the model's";
    message(bendy_get_joint_submesh(model_.get(), 5, &submesh, &error_));
}

TEST_F(CGeometry, BadArgumentsAreErrorsAndNothingIsWritten) {
    auto out = sized<bendy_stream>();
    EXPECT_EQ(message(bendy_get_stream(model_.get(), 0, 10, &out, &error_)),
              "stream 10 does not exist: the mesh has 10 streams");
    message(bendy_get_stream(model_.get(), 2, 0, &out, &error_));
    message(bendy_get_stream(nullptr, 0, 0, &out, &error_));
    message(bendy_get_stream(model_.get(), 0, 0, nullptr, &error_));
    EXPECT_EQ(bendy_find_stream(model_.get(), 0, BENDY_STREAM_COLOURS, 1, &error_), BENDY_NONE);
    EXPECT_EQ(error_.status, BENDY_NOT_FOUND);
    EXPECT_STREQ(error_.message, "mesh 0 has no such stream of set 1");
    EXPECT_EQ(bendy_find_stream(model_.get(), 0, 9, 0, &error_), BENDY_NONE);
    EXPECT_STREQ(error_.message, "kind 9 is not a bendy_stream_kind");
    Floats numbers(12, 7.0f);
    EXPECT_EQ(message(bendy_get_numbers(model_.get(), 0, 0, numbers.data(), 11, &error_)),
              "numbers has room for 11, 12 are needed");
    message(bendy_get_numbers(model_.get(), 0, 0, nullptr, 12, &error_));
    Integers integers(12, 7u);
    message(bendy_get_integers(model_.get(), 0, 0, integers.data(), 12, &error_));  // floats
    message(bendy_get_integers(model_.get(), 0, 9, integers.data(), 5, &error_));
    message(bendy_get_integers(model_.get(), 0, 9, nullptr, 6, &error_));
    EXPECT_EQ(numbers, Floats(12, 7.0f));
    EXPECT_EQ(integers, Integers(12, 7u));
}

}  // namespace
}  // namespace bendy::test::geometry_test
