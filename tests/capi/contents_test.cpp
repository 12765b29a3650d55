// What the C API says is in a model, held against the C++ API and against numbers of test::sample_file.
#include "capi/open_handles.h"

#include <string>

namespace bendy::test::contents_test {
namespace {

class CContents : public testing::Test {
protected:
    const Buffer file_ = sample_file();
    const Owned expected_{sample_file()};
    const ModelHandle model_ = open_copy(file_);
    bendy_error error_ = BENDY_ERROR_INIT;
};

TEST_F(CContents, CountsAreTheModels) {
    EXPECT_EQ(bendy_joint_count(model_.get()), 4u);
    EXPECT_EQ(bendy_mesh_count(model_.get()), 2u);
    EXPECT_EQ(bendy_vertex_count(model_.get()), 10u);
    EXPECT_EQ(bendy_clip_count(model_.get()), 1u);
    EXPECT_EQ(bendy_material_count(model_.get()), 2u);
    EXPECT_EQ(bendy_morph_target_count(model_.get()), 2u);
    EXPECT_EQ(bendy_chain_count(model_.get()), expected_->chains().size());
    EXPECT_EQ(bendy_submesh_count(model_.get()), expected_->submeshes().size());
    EXPECT_EQ(bendy_has_levels(model_.get()), 1u);
    EXPECT_STREQ(bendy_model_name(model_.get()), "fox");
    EXPECT_STREQ(bendy_model_extras(model_.get()), R"({"a":1})");
    EXPECT_STREQ(bendy_file_extras(model_.get()), R"({"file":true})");
}

TEST_F(CContents, EveryJointIsTheModels) {
    for (std::uint32_t number = 0; number < bendy_joint_count(model_.get()); ++number) {
        auto joint = sized<bendy_joint>();
        ASSERT_EQ(bendy_get_joint(model_.get(), number, &joint, &error_), BENDY_OK) << error_.message;
        const Joint& expected = expected_->joints()[number];
        EXPECT_EQ(joint.name, std::string(expected.name));
        EXPECT_EQ(joint.parent, expected.parent);
        EXPECT_EQ(bendy_joint_parents(model_.get())[number], expected.parent);
        EXPECT_EQ(joint.rest.rotation[3], expected.rest.rotation.w);
        EXPECT_EQ(joint.rest.rotation[0], expected.rest.rotation.x);
        EXPECT_EQ(joint.rest.translation[1], expected.rest.translation.y);
        EXPECT_EQ(joint.rest.scale[2], expected.rest.scale.z);
        EXPECT_EQ(joint.shear[0], expected.shear.x);
    }
}

TEST_F(CContents, ClipHasItsTimes) {
    auto clip = sized<bendy_clip>();
    ASSERT_EQ(bendy_get_clip(model_.get(), bendy_find_clip(model_.get(), "run", nullptr), &clip, &error_), BENDY_OK);
    EXPECT_STREQ(clip.name, "run");
    EXPECT_EQ(clip.start, 0.5f);
    EXPECT_EQ(clip.end, 1.0f);
    EXPECT_EQ(clip.frame_rate, 4.0f);
    EXPECT_EQ(clip.loops, 1u);
}

TEST_F(CContents, ChainsMeshesTargetsAndMaterialsAreTheModels) {
    for (std::uint32_t number = 0; number < expected_->chains().size(); ++number) {
        auto chain = sized<bendy_chain>();
        ASSERT_EQ(bendy_get_chain(model_.get(), number, &chain, &error_), BENDY_OK);
        EXPECT_EQ(chain.name, std::string(expected_->chains()[number].name));
        EXPECT_EQ(chain.start, expected_->chains()[number].record.start);
        EXPECT_EQ(chain.effector, expected_->chains()[number].record.effector);
        EXPECT_EQ(chain.links, expected_->chains()[number].links);
    }
    std::uint32_t targets = 0;
    for (std::uint32_t number = 0; number < 2; ++number) {
        const Mesh& expected = expected_->meshes()[number];
        auto mesh = sized<bendy_mesh>();
        ASSERT_EQ(bendy_get_mesh(model_.get(), number, &mesh, &error_), BENDY_OK);
        EXPECT_EQ(mesh.name, std::string(expected.name));
        EXPECT_EQ(mesh.vertices, expected.vertices);
        EXPECT_EQ(mesh.first_vertex, expected_->first_vertex(number));
        EXPECT_EQ(mesh.first_morph_target, targets);
        EXPECT_EQ(mesh.bones == 0, expected.is_rigid());
        EXPECT_EQ(mesh.has_normals, expected.normals ? 1u : 0u);
        for (const MorphTargetView& view : expected.targets) {
            auto target = sized<bendy_morph_target>();
            ASSERT_EQ(bendy_get_morph_target(model_.get(), targets++, &target, &error_), BENDY_OK);
            EXPECT_EQ(target.name, std::string(view.name));
            EXPECT_EQ(target.rest_weight, view.rest_weight);
            EXPECT_EQ(target.mesh, number);
        }
    }
    auto material = sized<bendy_material>();
    ASSERT_EQ(bendy_get_material(model_.get(), 0, &material, &error_), BENDY_OK);
    EXPECT_STREQ(material.name, "red");
    EXPECT_EQ(material.roughness, 1.0f);
    EXPECT_EQ(material.base_colour[3], 1.0f);
}

TEST_F(CContents, GeometryIsTheModels) {
    for (std::uint32_t number = 0; number < 2; ++number) {
        const Mesh& expected = expected_->meshes()[number];
        std::vector<std::uint32_t> indices(expected.indices ? expected.indices->elements : 0);
        ASSERT_EQ(bendy_get_indices(model_.get(), number, indices.data(), indices.size(), &error_), BENDY_OK);
        for (std::uint32_t k = 0; k < indices.size(); ++k) EXPECT_EQ(indices[k], expected.indices->index(k, 0));
        for (const StreamView& set : expected.texture_coords) {
            std::vector<float> uv(std::size_t{2} * expected.vertices);
            ASSERT_EQ(bendy_get_texture_coords(model_.get(), number, set.set, uv.data(), uv.size(), &error_), BENDY_OK);
            for (std::uint32_t k = 0; k < uv.size(); ++k) EXPECT_EQ(uv[k], set.number(k / 2, k % 2));
        }
        if (expected.is_rigid()) continue;
        auto mesh = sized<bendy_mesh>();
        bendy_get_mesh(model_.get(), number, &mesh, nullptr);
        ASSERT_EQ(mesh.influences, expected.bones->components);
        std::vector<std::uint32_t> bones(std::size_t{mesh.vertices} * mesh.influences);
        std::vector<float> weights(bones.size());
        ASSERT_EQ(bendy_get_influences(model_.get(), number, bones.data(), weights.data(), bones.size(), &error_),
                  BENDY_OK);
        for (std::uint32_t k = 0; k < bones.size(); ++k) {
            EXPECT_EQ(bones[k], expected.bones->index(k / mesh.influences, k % mesh.influences));
            EXPECT_EQ(weights[k], expected.weights->number(k / mesh.influences, k % mesh.influences));
        }
    }
}

TEST_F(CContents, NamesAreFoundAndMissingOnesSayWhatThereIs) {
    for (std::uint32_t number = 0; number < 4; ++number) {
        const std::string name(expected_->joints()[number].name);
        EXPECT_EQ(bendy_find_joint(model_.get(), name.c_str(), nullptr), expected_->joint(name));
    }
    EXPECT_EQ(bendy_find_material(model_.get(), "red", nullptr), 0u);
    EXPECT_EQ(bendy_find_clip(model_.get(), "Run", &error_), BENDY_NONE);
    EXPECT_EQ(error_.status, BENDY_NOT_FOUND);
    EXPECT_STREQ(error_.code, "NOT_FOUND");
    EXPECT_STREQ(error_.message, "there is no clip \"Run\"; did you mean \"run\"? There is: \"run\"");
}

TEST(CVersion, IsTheProjects) {
    EXPECT_EQ(bendy_version(), BENDY_VERSION_MAJOR << 16 | BENDY_VERSION_MINOR << 8 | BENDY_VERSION_PATCH);
    EXPECT_STREQ(bendy_version_string(), BENDY_PROJECT_VERSION);
}

}  // namespace
}  // namespace bendy::test::contents_test
