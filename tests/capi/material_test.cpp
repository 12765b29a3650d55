// Materials, textures and images through the C API.
#include "capi/open_handles.h"

#include <cstring>
#include <string>

namespace bendy::test::material_test {
namespace {

/// A material in which every field has a value of its own, and two textures for it.
Buffer file_with_a_material() {
    SurfaceRecord surface;
    surface.base_colour = {0.125f, 0.25f, 0.375f, 0.5f};
    surface.emissive = {1, 2, 3};
    surface.metallic = 0.0625f;
    surface.roughness = 0.625f;
    surface.normal_scale = 4;
    surface.occlusion_strength = 0.75f;
    surface.alpha_cutoff = 0.875f;
    surface.alpha_mode = 1;
    surface.double_sided = 1;
    surface.unlit = 1;
    surface.base_colour_texture = {0, 1, {2, 3}, {4, 5}, 6, 0};
    surface.metallic_roughness_texture = {1, 2, {3, 4}, {5, 6}, 7, 0};
    surface.normal_texture = {2, 3, {4, 5}, {6, 7}, 8, 0};
    surface.occlusion_texture = {0, 4, {5, 6}, {7, 8}, 9, 0};
    surface.emissive_texture = {1, 5, {6, 7}, {8, 9}, 10, 0};
    Node root = sample();
    child(child(root, "MATE"), "SURF").payload.assign(bytes_of(surface).begin(), bytes_of(surface).end());
    return to_file(root);
}

void expect_use(const bendy_texture_use& use, std::uint32_t texture, std::uint32_t set) {
    const auto first = static_cast<float>(set);
    EXPECT_EQ(use.texture, texture);
    EXPECT_EQ(use.set, set);
    EXPECT_EQ(use.offset[0], first + 1);
    EXPECT_EQ(use.offset[1], first + 2);
    EXPECT_EQ(use.scale[0], first + 3);
    EXPECT_EQ(use.scale[1], first + 4);
    EXPECT_EQ(use.rotation, first + 5);
}

TEST(CMaterial, HasEveryParameter) {
    const ModelHandle model = open_copy(file_with_a_material());
    bendy_error error = BENDY_ERROR_INIT;
    auto material = sized<bendy_material>();
    ASSERT_EQ(bendy_get_material(model.get(), 0, &material, &error), BENDY_OK) << error.message;
    EXPECT_STREQ(material.name, "red");
    EXPECT_EQ(material.base_colour[1], 0.25f);
    EXPECT_EQ(material.base_colour[3], 0.5f);
    EXPECT_EQ(material.emissive[2], 3.0f);
    EXPECT_EQ(material.metallic, 0.0625f);
    EXPECT_EQ(material.roughness, 0.625f);
    EXPECT_EQ(material.normal_scale, 4.0f);
    EXPECT_EQ(material.occlusion_strength, 0.75f);
    EXPECT_EQ(material.alpha_cutoff, 0.875f);
    EXPECT_EQ(material.alpha_mode, static_cast<std::uint32_t>(BENDY_ALPHA_MASK));
    EXPECT_EQ(material.double_sided, 1u);
    EXPECT_EQ(material.unlit, 1u);
    expect_use(material.base_colour_texture, 0, 1);
    expect_use(material.metallic_roughness_texture, 1, 2);
    expect_use(material.normal_texture, 2, 3);
    expect_use(material.occlusion_texture, 0, 4);
    expect_use(material.emissive_texture, 1, 5);
    EXPECT_STREQ(material.extensions, "{\"KHR_x\":{}}");
    EXPECT_STREQ(material.extras, "null");
    EXPECT_STREQ(material.more, "");
    ASSERT_EQ(bendy_get_material(model.get(), 1, &material, &error), BENDY_OK);
    EXPECT_EQ(material.metallic, 0.25f) << "a joint's own material";
    EXPECT_EQ(material.normal_texture.texture, BENDY_NONE);
}

// A program that was compiled before the struct grew.
TEST(CMaterial, ShorterStructIsFilledAsFarAsItGoes) {
    const ModelHandle model = open_copy(file_with_a_material());
    bendy_material material;
    std::memset(&material, 0x5a, sizeof material);
    material.size = 56;
    bendy_error error = BENDY_ERROR_INIT;
    ASSERT_EQ(bendy_get_material(model.get(), 0, &material, &error), BENDY_OK) << error.message;
    EXPECT_EQ(material.size, 56u);
    EXPECT_EQ(material.double_sided, 1u);
    unsigned char bytes[sizeof material];
    std::memcpy(bytes, &material, sizeof material);
    for (std::size_t k = 56; k < sizeof material; ++k) EXPECT_EQ(bytes[k], 0x5a) << k;
    material.size = 55;
    EXPECT_EQ(bendy_get_material(model.get(), 0, &material, &error), BENDY_BAD_ARGUMENT);
}

// The sizes that structs had when they were first declared: a program may go on to use them.
TEST(CMaterial, EveryStructThatHasGrownKeepsItsFirstSize) {
    const ModelHandle model = open_copy(sample_file());
    const auto fills = [&](auto out, std::uint32_t first, const auto& call) {
        out.size = first;
        EXPECT_EQ(call(&out), BENDY_OK) << first;
        EXPECT_EQ(out.size, first);
        EXPECT_GT(sizeof out, first) << "or it has not grown";
    };
    const bendy_model* const m = model.get();
    fills(bendy_joint{}, 72, [&](bendy_joint* out) { return bendy_get_joint(m, 0, out, nullptr); });
    fills(bendy_clip{}, 32, [&](bendy_clip* out) { return bendy_get_clip(m, 0, out, nullptr); });
    fills(bendy_chain{}, 32, [&](bendy_chain* out) { return bendy_get_chain(m, 0, out, nullptr); });
    fills(bendy_morph_target{}, 24,
          [&](bendy_morph_target* out) { return bendy_get_morph_target(m, 0, out, nullptr); });
    fills(bendy_mesh{}, 64, [&](bendy_mesh* out) { return bendy_get_mesh(m, 0, out, nullptr); });
}

TEST(CTexture, HasSamplerNameAndImages) {
    const ModelHandle model = open_copy(sample_file());
    bendy_error error = BENDY_ERROR_INIT;
    EXPECT_EQ(bendy_texture_count(model.get()), 3u);
    EXPECT_EQ(bendy_texture_count(nullptr), 0u);
    EXPECT_EQ(bendy_find_texture(model.get(), "skin", &error), 0u);
    EXPECT_EQ(bendy_find_texture(model.get(), "fur", &error), BENDY_NONE);
    EXPECT_EQ(error.status, BENDY_NOT_FOUND);
    auto texture = sized<bendy_texture>();
    ASSERT_EQ(bendy_get_texture(model.get(), 0, &texture, &error), BENDY_OK) << error.message;
    EXPECT_STREQ(texture.name, "skin");
    EXPECT_EQ(texture.images, 1u);
    EXPECT_EQ(texture.mag_filter, static_cast<std::uint32_t>(BENDY_FILTER_LINEAR));
    EXPECT_EQ(texture.min_filter, static_cast<std::uint32_t>(BENDY_FILTER_LINEAR_MIPMAP_LINEAR));
    EXPECT_EQ(texture.wrap_s, static_cast<std::uint32_t>(BENDY_REPEAT));
    EXPECT_EQ(texture.wrap_t, static_cast<std::uint32_t>(BENDY_MIRRORED_REPEAT));
    EXPECT_STREQ(texture.extras, "1");
    EXPECT_STREQ(texture.more, "");
}

TEST(CTexture, AUriWithAZeroIsNotCutShort) {
    Node root = sample();
    child(child(root, "TEXT"), "LINK").payload[4] = std::byte{0};
    const ModelHandle model = open_copy(to_file(root));
    bendy_error error = BENDY_ERROR_INIT;
    auto image = sized<bendy_image>();
    ASSERT_EQ(bendy_get_image(model.get(), 0, 0, &image, &error), BENDY_OK) << error.message;
    EXPECT_STREQ(image.uri, "");
}

TEST(CTexture, ImageIsALinkOrBytesOrThoseOfAnotherTexture) {
    const ModelHandle model = open_copy(sample_file());
    bendy_error error = BENDY_ERROR_INIT;
    auto image = sized<bendy_image>();
    ASSERT_EQ(bendy_get_image(model.get(), 0, 0, &image, &error), BENDY_OK) << error.message;
    EXPECT_STREQ(image.uri, "skin.png");
    EXPECT_EQ(image.bytes, nullptr);
    EXPECT_EQ(image.byte_count, 0u);
    EXPECT_EQ(image.media, static_cast<std::uint32_t>(BENDY_MEDIA_OTHER));
    for (const std::uint32_t number : {1u, 2u}) {
        ASSERT_EQ(bendy_get_image(model.get(), number, 0, &image, &error), BENDY_OK) << error.message;
        EXPECT_EQ(image.media, static_cast<std::uint32_t>(BENDY_MEDIA_WEBP));
        EXPECT_EQ(image.uri, nullptr);
        ASSERT_EQ(image.byte_count, 5u);
        EXPECT_EQ(std::memcmp(image.bytes, "RIFF?", 5), 0);
        EXPECT_EQ(image.texture, 1u) << "where the bytes are";
        EXPECT_EQ(image.image, 0u);
    }
    EXPECT_EQ(bendy_get_image(model.get(), 0, 1, &image, &error), BENDY_BAD_ARGUMENT);
    EXPECT_STREQ(error.message, "image 1 does not exist: the texture has 1 image");
    EXPECT_EQ(bendy_get_image(model.get(), 3, 0, &image, &error), BENDY_BAD_ARGUMENT);
    EXPECT_STREQ(error.message, "texture 3 does not exist: the model has 3 textures");
    EXPECT_EQ(bendy_get_image(model.get(), 0, 0, nullptr, &error), BENDY_BAD_ARGUMENT);
    EXPECT_EQ(bendy_get_image(nullptr, 0, 0, &image, &error), BENDY_BAD_ARGUMENT);
}

}  // namespace
}  // namespace bendy::test::material_test
