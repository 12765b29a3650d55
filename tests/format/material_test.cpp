#include <bendy/format/material.h>

#include "edit_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <limits>
#include <string>

namespace bendy::material_test {
namespace {

using namespace test;

constexpr std::array kTextureUses{offsetof(SurfaceRecord, base_colour_texture),
                                  offsetof(SurfaceRecord, metallic_roughness_texture),
                                  offsetof(SurfaceRecord, normal_texture), offsetof(SurfaceRecord, occlusion_texture),
                                  offsetof(SurfaceRecord, emissive_texture)};

/// What is wrong with the sample when one number of the record at `path` is another.
template <class T>
Lines faults_with(const char* path, std::size_t offset, T value) {
    Node root = sample();
    set(at(root, path), offset, value);
    return faults_in(root);
}

TEST(Material, GivesItsParts) {
    const Loaded sample(sample_file());
    const MaterialView& material = sample.document.materials.at(0);
    EXPECT_EQ(material.name, "red");
    EXPECT_EQ(material.extensions, "{\"KHR_x\":{}}");
    EXPECT_EQ(material.extras, "null");
    EXPECT_EQ(material.surface.alpha_mode, static_cast<std::uint8_t>(AlphaMode::blend));
    EXPECT_EQ(material.surface.base_colour_texture.texture, 2u);
    EXPECT_EQ(material.surface.normal_texture.texture, kNone);
    EXPECT_EQ(material.surface.emissive_texture.texture, 0u);
    EXPECT_EQ(sample.tree[material.chunk].id, FourCC("MATE"));
}

TEST(Material, StandsInHeadFirstAndThenInJoints) {
    const Loaded sample(sample_file());
    ASSERT_EQ(sample.document.materials.size(), 2u);
    EXPECT_EQ(sample.document.global_materials, 1u);
    EXPECT_EQ(sample.document.materials[1].surface.metallic, 0.25f);
    EXPECT_EQ(sample.document.materials[1].name, "");
}

TEST(Material, RefusesTexturesThatAreNotThere) {
    for (const std::size_t use : kTextureUses) {
        EXPECT_EQ(faults_with("HEAD/MATE/SURF", use, 2u), Lines{}) << use;
        EXPECT_EQ(faults_with("HEAD/MATE/SURF", use, kNone), Lines{}) << use;
        EXPECT_EQ(faults_with("HEAD/MATE/SURF", use, 3u), Lines{"TEXTURE_RANGE HEAD/MATE/SURF"}) << use;
        EXPECT_EQ(faults_with("HEAD/MATE/SURF", use, kNone - 1), Lines{"TEXTURE_RANGE HEAD/MATE/SURF"}) << use;
        EXPECT_EQ(faults_with("HEAD/OBJE/SKIN/MATE/SURF", use, 3u), Lines{"TEXTURE_RANGE HEAD/OBJE/SKIN/MATE/SURF"})
            << use;
    }
}

TEST(Material, RefusesUnknownModesAndSwitches) {
    const auto faults = [](std::size_t offset, std::uint8_t value) {
        return faults_with("HEAD/MATE/SURF", offset, value);
    };
    EXPECT_EQ(faults(offsetof(SurfaceRecord, alpha_mode), 1), Lines{});
    EXPECT_EQ(faults(offsetof(SurfaceRecord, alpha_mode), 3), Lines{"ENUM_RANGE HEAD/MATE/SURF"});
    EXPECT_EQ(faults(offsetof(SurfaceRecord, double_sided), 1), Lines{});
    EXPECT_EQ(faults(offsetof(SurfaceRecord, double_sided), 2), Lines{"ENUM_RANGE HEAD/MATE/SURF"});
    EXPECT_EQ(faults(offsetof(SurfaceRecord, unlit), 1), Lines{});
    EXPECT_EQ(faults(offsetof(SurfaceRecord, unlit), 255), Lines{"ENUM_RANGE HEAD/MATE/SURF"});
}

TEST(Material, RefusesReservedBytes) {
    for (std::size_t byte = 0; byte < 13; ++byte) {
        EXPECT_EQ(faults_with("HEAD/MATE/SURF", offsetof(SurfaceRecord, reserved) + byte, std::uint8_t{1}),
                  Lines{"RESERVED_FIELD HEAD/MATE/SURF"})
            << byte;
    }
    for (const std::size_t use : kTextureUses) {
        EXPECT_EQ(faults_with("HEAD/MATE/SURF", use + offsetof(TextureUseRecord, reserved), 1u),
                  Lines{"RESERVED_FIELD HEAD/MATE/SURF"})
            << use;
    }
}

TEST(Material, RefusesEveryNumberThatIsNotFinite) {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        for (std::size_t offset = 0; offset < offsetof(SurfaceRecord, alpha_mode); offset += sizeof(float)) {
            EXPECT_EQ(faults_with("HEAD/MATE/SURF", offset, bad), Lines{"NOT_FINITE HEAD/MATE/SURF"}) << offset;
        }
        for (const std::size_t use : kTextureUses) {
            for (std::size_t offset = offsetof(TextureUseRecord, offset); offset < offsetof(TextureUseRecord, reserved);
                 offset += sizeof(float)) {
                EXPECT_EQ(faults_with("HEAD/MATE/SURF", use + offset, bad), Lines{"NOT_FINITE HEAD/MATE/SURF"})
                    << use + offset;
            }
        }
    }
}

TEST(Texture, GivesItsParts) {
    const Loaded sample(sample_file());
    ASSERT_EQ(sample.document.textures.size(), 3u);
    const TextureView& link = sample.document.textures[0];
    EXPECT_EQ(link.name, "skin");
    EXPECT_EQ(link.extras, "1");
    EXPECT_EQ(link.sampler.mag_filter, static_cast<std::uint8_t>(Filter::linear));
    EXPECT_EQ(link.sampler.min_filter, static_cast<std::uint8_t>(Filter::linear_mipmap_linear));
    EXPECT_EQ(link.sampler.wrap_s, static_cast<std::uint8_t>(Wrap::repeat));
    EXPECT_EQ(link.sampler.wrap_t, static_cast<std::uint8_t>(Wrap::mirrored_repeat));
    ASSERT_EQ(link.images.size(), 1u);
    EXPECT_EQ(link.images[0].uri, "skin.png");
    EXPECT_TRUE(link.images[0].bytes.empty());
    EXPECT_FALSE(link.images[0].same.has_value());

    const ImageView& embedded = sample.document.textures[1].images.at(0);
    EXPECT_EQ(embedded.media, MediaType::webp);
    EXPECT_EQ(as_text(embedded.bytes), "RIFF?");
    EXPECT_FALSE(embedded.same.has_value());

    const ImageView& same = sample.document.textures[2].images.at(0);
    ASSERT_TRUE(same.same.has_value());
    EXPECT_EQ(same.same->texture, 1u);
    EXPECT_EQ(same.same->image, 0u);
}

TEST(Texture, KeepsItsImagesInOrder) {
    Node root = sample();
    Node& texture = at(root, "HEAD/TEXT");
    texture.children.push_back(child(at(root, "HEAD/TEXT[1]"), "IMAG"));
    texture.children.push_back(make_leaf(FourCC("LINK"), as_byte_span("skin.ktx2")));
    EXPECT_EQ(faults_in(root), Lines{});
    const Loaded loaded(root);
    const auto& images = loaded.document.textures.at(0).images;
    ASSERT_EQ(images.size(), 3u);
    EXPECT_EQ(images[0].uri, "skin.png");
    EXPECT_EQ(images[1].media, MediaType::webp);
    EXPECT_EQ(images[2].uri, "skin.ktx2");
}

TEST(Texture, TakesAnImageWithoutBytes) {
    Node root = sample();
    at(root, "HEAD/TEXT[1]/IMAG").payload.resize(sizeof(ImageRecord));
    EXPECT_EQ(faults_in(root), Lines{});
}

TEST(Texture, RefusesUnknownSamplerSettings) {
    const auto faults = [](std::size_t offset, std::uint8_t value) {
        return faults_with("HEAD/TEXT/SAMP", offset, value);
    };
    const Lines bad{"ENUM_RANGE HEAD/TEXT/SAMP"};
    EXPECT_EQ(faults(offsetof(SamplerRecord, mag_filter), 2), Lines{});
    EXPECT_EQ(faults(offsetof(SamplerRecord, mag_filter), 3), bad);
    EXPECT_EQ(faults(offsetof(SamplerRecord, min_filter), 6), Lines{});
    EXPECT_EQ(faults(offsetof(SamplerRecord, min_filter), 7), bad);
    for (const std::size_t wrap : {offsetof(SamplerRecord, wrap_s), offsetof(SamplerRecord, wrap_t)}) {
        EXPECT_EQ(faults(wrap, 2), Lines{});
        EXPECT_EQ(faults(wrap, 3), bad);
    }
}

TEST(Texture, RefusesUnknownMediaAndReservedBytes) {
    EXPECT_EQ(faults_with("HEAD/TEXT[1]/IMAG", 0, std::uint8_t{5}), Lines{});
    EXPECT_EQ(faults_with("HEAD/TEXT[1]/IMAG", 15, std::uint8_t{1}), Lines{"RESERVED_FIELD HEAD/TEXT[1]/IMAG"});
    // What refers to a faulty image has lost it.
    EXPECT_EQ(faults_with("HEAD/TEXT[1]/IMAG", 0, std::uint8_t{6}),
              (Lines{"ENUM_RANGE HEAD/TEXT[1]/IMAG", "INDEX_RANGE HEAD/TEXT[2]/SAME"}));
}

TEST(Texture, RefusesALinkThatIsNotTextOrIsEncoded) {
    Node root = sample();
    at(root, "HEAD/TEXT/LINK").payload = {std::byte{0xc0}, std::byte{0x80}};
    EXPECT_EQ(faults_in(root), Lines{"NOT_UTF8 HEAD/TEXT/LINK"});
    root = sample();
    at(root, "HEAD/TEXT/LINK").flags = 0xff00;
    EXPECT_EQ(faults_in(root), Lines{"UNSUPPORTED_CODEC HEAD/TEXT/LINK"});
}

TEST(Texture, ALinkWithAControlCharacterIsReadAndReported) {
    Node root = sample();
    constexpr std::string_view kUri = ".\t./secret.png";
    const Bytes uri = as_byte_span(kUri);
    at(root, "HEAD/TEXT/LINK").payload.assign(uri.begin(), uri.end());
    const Loaded loaded(root);
    EXPECT_EQ(loaded.lines(), Lines{});  // of what reading needs
    EXPECT_EQ(loaded.document.textures.at(0).images.at(0).uri, kUri);
    const Faults faults = validate(to_file(root));
    ASSERT_EQ(faults.list().size(), 1u);
    EXPECT_EQ(faults.list()[0].code, ErrorCode::kLinkControl);
    EXPECT_EQ(describe(faults.list()[0]), "byte 1 of the URI belongs to a control character; a URI has none");
}

TEST(Texture, RefusesTheImageOfATextureThatIsNotThere) {
    for (const std::uint32_t texture : {3u, 0x8000'0000u, kNone - 1, kNone}) {
        EXPECT_EQ(faults_with("HEAD/TEXT[2]/SAME", offsetof(SameRecord, texture), texture),
                  Lines{"TEXTURE_RANGE HEAD/TEXT[2]/SAME"})
            << texture;
    }
}

TEST(Texture, RefusesAnImageThatIsNotThereOrIsItselfAnothers) {
    const Lines bad{"INDEX_RANGE HEAD/TEXT[2]/SAME"};
    EXPECT_EQ(faults_with("HEAD/TEXT[2]/SAME", offsetof(SameRecord, image), 1u), bad);
    EXPECT_EQ(faults_with("HEAD/TEXT[2]/SAME", offsetof(SameRecord, image), kNone), bad);
    EXPECT_EQ(faults_with("HEAD/TEXT[2]/SAME", offsetof(SameRecord, texture), 2u), bad);  // its own
    EXPECT_EQ(faults_with("HEAD/TEXT[2]/SAME", offsetof(SameRecord, texture), 0u), Lines{});
}

}  // namespace
}  // namespace bendy::material_test
