#include "build_gltf.h"

#include <gtest/gtest.h>

namespace bendy::converter::material_test {
namespace {

using namespace test;

const Bytes kPng = bytes_of(std::string_view("\x89PNG\r\n\x1a\n....", 12));
const Bytes kKtx2 = bytes_of(std::string_view("\xabKTX 20\xbb\r\n\x1a\n", 12));

TEST(GltfMaterial, CoreFieldsAndTheirDefaults) {
    Gltf gltf = make_triangle();
    gltf.json["images"] = {{{"bufferView", gltf.add_view(kPng)}, {"mimeType", "image/jpeg"}, {"name", "skin"}}};
    gltf.json["samplers"] = {{{"magFilter", 9728}, {"minFilter", 9985}, {"wrapS", 33071}, {"wrapT", 33648}}};
    gltf.json["textures"] = {{{"source", 0}, {"sampler", 0}, {"name", "t"}}, {{"source", 0}}};
    gltf.json["materials"] = {Json::object(),
                              {{"name", "m"},
                               {"alphaMode", "MASK"},
                               {"alphaCutoff", 0.25},
                               {"doubleSided", true},
                               {"emissiveFactor", {1, 0.5, 0}},
                               {"pbrMetallicRoughness",
                                {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
                                 {"metallicFactor", 0.5},
                                 {"roughnessFactor", 0},
                                 {"baseColorTexture", {{"index", 1}, {"texCoord", 2}}}}},
                               {"normalTexture", {{"index", 0}, {"scale", 2}}},
                               {"occlusionTexture", {{"index", 0}, {"strength", 0.5}}}}};
    const Import import = gltf.import();
    ASSERT_EQ(import->materials.size(), 2u);
    const Material& plain = import->materials[0];
    EXPECT_EQ(plain.base_colour, glm::vec4(1));
    EXPECT_EQ(plain.metallic, 1.0f);
    EXPECT_EQ(plain.roughness, 1.0f);
    EXPECT_EQ(plain.alpha_cutoff, 0.5f);
    EXPECT_EQ(plain.alpha_mode, AlphaMode::opaque);
    EXPECT_EQ(plain.base_colour_texture.texture, kNone);
    EXPECT_EQ(plain.normal_scale, 1.0f);
    const Material& full = import->materials[1];
    EXPECT_EQ(full.name, "m");
    EXPECT_EQ(full.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(full.alpha_cutoff, 0.25f);
    EXPECT_TRUE(full.double_sided);
    EXPECT_EQ(full.base_colour, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_EQ(full.emissive, glm::vec3(1, 0.5f, 0));
    EXPECT_EQ(full.metallic, 0.5f);
    EXPECT_EQ(full.roughness, 0.0f);
    EXPECT_EQ(full.base_colour_texture.texture, 1u);
    EXPECT_EQ(full.base_colour_texture.coords, 2u);
    EXPECT_EQ(full.normal_texture.texture, 0u);
    EXPECT_EQ(full.normal_scale, 2.0f);
    EXPECT_EQ(full.occlusion_strength, 0.5f);
    EXPECT_EQ(full.emissive_texture.texture, kNone);

    ASSERT_EQ(import->textures.size(), 2u);
    EXPECT_EQ(import->textures[0].mag_filter, Filter::nearest);
    EXPECT_EQ(import->textures[0].min_filter, Filter::linear_mipmap_nearest);
    EXPECT_EQ(import->textures[0].wrap_s, Wrap::clamp_to_edge);
    EXPECT_EQ(import->textures[0].wrap_t, Wrap::mirrored_repeat);
    EXPECT_EQ(import->textures[1].mag_filter, Filter::unspecified);
    EXPECT_EQ(import->textures[1].wrap_s, Wrap::repeat);

    ASSERT_EQ(import->images.size(), 1u);
    EXPECT_EQ(import->images[0].name, "skin");
    EXPECT_EQ(import->images[0].media_type, "image/png");  // the bytes know better
    EXPECT_EQ(import->images[0].bytes, kPng);
}

TEST(GltfMaterial, TextureTransform) {
    Gltf gltf = make_triangle();
    gltf.json["textures"] = Json::array({Json::object()});
    Json texture = {{"index", 0}, {"texCoord", 1}};
    texture["extensions"]["KHR_texture_transform"] = {
        {"offset", {0.5, 0.25}}, {"rotation", 1.5}, {"scale", {2, -1}}, {"texCoord", 3}};
    gltf.json["materials"] = {{{"emissiveTexture", texture}}};
    const Import import = gltf.import();
    const TextureUse& use = import->materials.at(0).emissive_texture;
    EXPECT_EQ(use.offset, glm::vec2(0.5f, 0.25f));
    EXPECT_EQ(use.rotation, 1.5f);
    EXPECT_EQ(use.scale, glm::vec2(2, -1));
    EXPECT_EQ(use.coords, 3u);

    gltf.json["materials"][0]["emissiveTexture"]["extensions"]["KHR_texture_transform"]["scale"] = {1};
    EXPECT_EQ(gltf.import().place(), "materials[0].emissiveTexture.extensions.KHR_texture_transform.scale");
}

TEST(GltfMaterial, UnlitIsAFieldOtherExtensionsStayAsJson) {
    Gltf gltf = make_triangle();
    gltf.json["materials"] = Json::array({Json::object()});
    gltf.json["materials"][0]["extensions"] = {{"KHR_materials_unlit", Json::object()},
                                               {"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}}};
    const Import import = gltf.import();
    EXPECT_TRUE(import->materials.at(0).unlit);
    EXPECT_EQ(import->materials[0].extensions, R"({"KHR_materials_clearcoat":{"clearcoatFactor":1}})");
    EXPECT_EQ(import.warned("kept as JSON, not interpreted: KHR_materials_clearcoat"), 1u);
    EXPECT_EQ(import.report.warnings().size(), 1u);
}

// A warning that most characters bring is a warning that nobody reads.
TEST(GltfMaterial, ExtensionsThatAreDrawnAreKeptWithoutAWarning) {
    Gltf gltf = make_triangle();
    Json& extensions = gltf.json["materials"][0]["extensions"];
    extensions = {{"KHR_materials_emissive_strength", {{"emissiveStrength", 3}}},
                  {"KHR_materials_ior", {{"ior", 1.25}}},
                  {"KHR_materials_specular", {{"specularFactor", 0.5}}}};
    const Import import = gltf.import();
    EXPECT_EQ(Json::parse(import->materials.at(0).extensions), extensions);
    EXPECT_TRUE(import.report.warnings().empty());
    extensions["KHR_materials_specular"] = "odd";
    EXPECT_TRUE(gltf.import().report.warnings().empty());

    // The renderer reads the factors only.
    for (const char* texture : {"specularTexture", "specularColorTexture"}) {
        extensions["KHR_materials_specular"] = {{texture, {{"index", 0}}}};
        EXPECT_EQ(gltf.import().warned("kept as JSON, not interpreted: KHR_materials_specular"), 1u);
    }
}

TEST(GltfMaterial, ExtensionsOfferThePreferredImageFirst) {
    Gltf gltf = make_triangle();
    gltf.json["images"] = {{{"bufferView", gltf.add_view(kPng)}}, {{"bufferView", gltf.add_view(kKtx2)}}};
    gltf.json["textures"] = {{{"source", 0}}};
    gltf.json["textures"][0]["extensions"]["KHR_texture_basisu"]["source"] = 1;
    const Import import = gltf.import();
    EXPECT_EQ(import->textures.at(0).images, (std::vector<std::uint32_t>{1, 0}));
    EXPECT_EQ(import->images.at(1).media_type, "image/ktx2");
}

Gltf make_specular_glossiness() {
    Gltf gltf = make_triangle();
    gltf.json["images"] = {{{"bufferView", gltf.add_view(kPng)}}};
    gltf.json["textures"] = {{{"source", 0}}};
    gltf.json["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"] = {
        {"diffuseFactor", {0.5, 0.25, 1, 0.75}},
        {"diffuseTexture",
         {{"index", 0}, {"texCoord", 1}, {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}}}}}}},
        {"glossinessFactor", 0.25}};
    return gltf;
}

TEST(GltfMaterial, TheDiffuseColourStandsInForTheBaseColour) {
    Gltf gltf = make_specular_glossiness();
    const Import import = gltf.import();
    const Material& material = import->materials.at(0);
    EXPECT_EQ(material.base_colour, glm::vec4(0.5f, 0.25f, 1.0f, 0.75f));
    EXPECT_EQ(material.base_colour_texture.texture, 0u);
    EXPECT_EQ(material.base_colour_texture.coords, 1u);
    EXPECT_EQ(material.base_colour_texture.offset, glm::vec2(0.5f, 0.0f));
    EXPECT_EQ(material.metallic, 0.0f);
    EXPECT_EQ(material.roughness, 0.75f);
    EXPECT_EQ(Json::parse(material.extensions), gltf.json["materials"][0]["extensions"]);
    EXPECT_EQ(import.warned("pbrSpecularGlossiness is approximated"), 1u);
    EXPECT_EQ(import.warned("not interpreted"), 0u);

    Json& extension = gltf.json["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"];
    extension["specularGlossinessTexture"] = {{"index", 0}};
    EXPECT_EQ(gltf.import()->materials.at(0).roughness, 1.0f);
    gltf.json["materials"][0]["pbrMetallicRoughness"] = {{"metallicFactor", 0.5}, {"roughnessFactor", 0.125}};
    const Import partly = gltf.import();
    EXPECT_EQ(partly->materials.at(0).base_colour.x, 0.5f);
    EXPECT_EQ(partly->materials.at(0).metallic, 0.5f);
    EXPECT_EQ(partly->materials.at(0).roughness, 0.125f);
}

TEST(GltfMaterial, ABaseColourGoesBeforeTheDiffuseColour) {
    Gltf gltf = make_specular_glossiness();
    gltf.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 0, 1};
    const Import import = gltf.import();
    EXPECT_EQ(import->materials.at(0).base_colour, glm::vec4(1, 1, 0, 1));
    EXPECT_EQ(import->materials.at(0).base_colour_texture.texture, kNone);
    EXPECT_EQ(import.warned("not interpreted: KHR_materials_pbrSpecularGlossiness"), 1u);
}

TEST(GltfMaterial, FaultyDiffuseColoursAreOnlyKept) {
    for (const auto& [member, value] : std::vector<std::pair<std::string, Json>>{
             {"diffuseFactor", 1},
             {"diffuseFactor", {1, 1, 1}},
             {"diffuseFactor", {1, 1, 1, "x"}},
             {"diffuseFactor", {1, 1, 1, 2}},
             {"diffuseTexture", 0},
             {"diffuseTexture", Json::object()},
             {"diffuseTexture", {{"index", 1}}},
             {"diffuseTexture", {{"index", -1}}},
             {"diffuseTexture", {{"index", 0}, {"texCoord", -1}}},
             {"diffuseTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", 1}}}}},
             {"glossinessFactor", Json::array()}}) {
        Gltf gltf = make_specular_glossiness();
        gltf.json["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"][member] = value;
        const Import import = gltf.import();
        EXPECT_EQ(import->materials.at(0).base_colour, glm::vec4(1.0f)) << member << value;
        EXPECT_EQ(import.warned("not interpreted: KHR_materials_pbrSpecularGlossiness"), 1u) << member << value;
    }
}

TEST(GltfMaterial, ImagesFromFilesAndDataUris) {
    Gltf gltf = make_triangle();
    gltf.json["images"] = {
        {{"uri", "skin image.png"}}, {{"uri", "data:image/x-own;base64,AAEC"}}, {{"uri", "none.png"}}};
    write_file("skin image.png", kPng);
    const Import embedded = gltf.import();
    ASSERT_EQ(embedded->images.size(), 3u);
    EXPECT_EQ(embedded->images[0].bytes, kPng);
    EXPECT_TRUE(embedded->images[0].uri.empty());
    EXPECT_EQ(embedded->images[1].media_type, "image/x-own");
    EXPECT_EQ(embedded->images[1].bytes.size(), 3u);
    EXPECT_EQ(embedded->images[2].uri, "none.png");
    EXPECT_EQ(embedded.warned("image could not be read (file not found: 'none.png')"), 1u);

    GltfOptions options;
    options.embed_images = false;
    const Import referred = gltf.import(options);
    EXPECT_EQ(referred->images.at(0).uri, "skin image.png");
    EXPECT_TRUE(referred->images[0].bytes.empty());
    EXPECT_EQ(referred->images[1].bytes.size(), 3u);
    EXPECT_TRUE(referred.report.warnings().empty());
}

TEST(GltfMaterial, ControlCharactersInAnImagesUriAreEncoded) {
    Gltf gltf = make_triangle();
    gltf.json["images"] = {{{"uri", "tab\there.png"}}, {{"uri", ".\t./\xc2\x85\n.png"}}};
    write_file("tab\there.png", kPng);
    GltfOptions options;
    options.embed_images = false;
    const Import linked = gltf.import(options);
    EXPECT_EQ(linked->images.at(0).uri, "tab%09here.png");
    EXPECT_EQ(linked->images.at(1).uri, ".%09./%C2%85%0A.png");
    EXPECT_EQ(linked.warned("control characters of a URI are percent-encoded: 'tab%09here.png'"), 1u);
    EXPECT_EQ(linked.warned("control characters of a URI are percent-encoded: '.%09./%C2%85%0A.png'"), 1u);

    const Import embedded = gltf.import();
    EXPECT_EQ(embedded->images.at(0).bytes, kPng);  // the name means the same file
    EXPECT_EQ(embedded->images.at(1).uri, ".%09./%C2%85%0A.png");
    EXPECT_TRUE(embedded->images.at(1).bytes.empty());
}

TEST(GltfMaterial, ImagesOutsideTheFolderStayLinks) {
    Gltf gltf = make_triangle();
    gltf.json["images"] = {{{"uri", "../bendy_secret.png"}}, {{"uri", ".\\in.png"}}, {{"uri", "..\\bendy_secret.png"}}};
    write_file("in.png", kPng);
    const Import import = gltf.import();
    ASSERT_EQ(import->images.size(), 3u);
    EXPECT_EQ(import->images[0].uri, "../bendy_secret.png");
    EXPECT_TRUE(import->images[2].bytes.empty());
    EXPECT_EQ(import.warned("image could not be read ('..\\bendy_secret.png' is outside the source's folder: --root "),
              1u);
    EXPECT_TRUE(import->images[0].bytes.empty());
    EXPECT_EQ(import.warned("image could not be read ('../bendy_secret.png' is outside the source's folder: --root "),
              1u);
    ASSERT_EQ(import.report.embedded().size(), 1u);  // what is in the result is named
    EXPECT_EQ(import.report.embedded()[0].file.filename(), "in.png");
    EXPECT_EQ(import.report.embedded()[0].size, kPng.size());
    EXPECT_EQ(import.report.embedded()[0].media_type, "image/png");
    EXPECT_EQ(import.report.sources().size(), 1u);
}

TEST(GltfMaterial, EmbeddedFilesThatAreNoImagesAreNamed) {
    Gltf gltf = make_triangle();
    gltf.json["images"] = {{{"uri", "notes.txt"}}};
    write_file("notes.txt", bytes_of("a key that nobody should see"));
    const Import import = gltf.import();
    EXPECT_FALSE(import->images.at(0).bytes.empty());
    EXPECT_EQ(import.warned("embedded file is not an image of a known kind: 'notes.txt'"), 1u);
}

TEST(GltfMaterial, OneFileForAThousandImagesIsBounded) {
    Gltf gltf = make_triangle();
    Bytes big = kPng;
    big.resize(std::size_t{1} << 20);
    write_file("big.png", big);
    for (int i = 0; i < 1000; ++i) gltf.json["images"].push_back({{"uri", "big.png"}});
    const Import import = gltf.import();
    std::size_t bytes = 0;
    for (const Image& image : import->images) bytes += image.bytes.size();
    EXPECT_GE(bytes, big.size());
    EXPECT_LE(bytes, std::size_t{100} * big.size() + (std::size_t{64} << 20));
    EXPECT_GT(import.warned("image could not be read (the decoded data would be implausibly large)"), 800u);
}

TEST(GltfMaterial, WrongReferencesNameTheirPlace) {
    Gltf gltf = make_triangle();
    gltf.json["materials"] = {{{"normalTexture", {{"index", 0}}}}};
    EXPECT_EQ(gltf.import().place(), "materials[0].normalTexture.index");
    gltf.json["textures"] = {{{"source", 5}}};
    EXPECT_EQ(gltf.import().place(), "textures[0].source");
    gltf.json["textures"] = {{{"sampler", 0}}};
    EXPECT_EQ(gltf.import().place(), "textures[0].sampler");
    gltf.json["textures"] = Json::array({Json::object()});
    EXPECT_TRUE(gltf.import().result);
    gltf.primitive()["material"] = 1;
    EXPECT_EQ(gltf.import().place(), "meshes[0].primitives[0].material");
}

}  // namespace
}  // namespace bendy::converter::material_test
