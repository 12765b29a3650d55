#include "build_gltf.h"
#include "source_folder.h"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace bendy::converter::draco_test {
namespace {

using namespace test;

/// Two triangles of a square with normalised 8-bit colours, as Draco encodes them without quantisation.
struct Encoded {
    Bytes bytes;
    std::uint32_t position_id = 0;
    std::uint32_t colour_id = 0;
};
Encoded encode_square(draco::MeshEncoderMethod method) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2);
    const int positions = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const int colours = builder.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8);
    const std::array<std::array<float, 3>, 4> corners = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
    const std::array<std::array<std::uint8_t, 4>, 4> shades = {
        {{0, 0, 0, 255}, {51, 0, 0, 255}, {102, 0, 0, 255}, {255, 0, 0, 255}}};
    const std::array<std::array<std::size_t, 3>, 2> faces = {{{0, 1, 2}, {0, 2, 3}}};
    for (std::uint32_t f = 0; f < 2; ++f) {
        const auto& [a, b, c] = faces[f];
        const draco::FaceIndex face(f);
        builder.SetAttributeValuesForFace(positions, face, corners[a].data(), corners[b].data(), corners[c].data());
        builder.SetAttributeValuesForFace(colours, face, shades[a].data(), shades[b].data(), shades[c].data());
    }
    const auto mesh = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetEncodingMethod(method);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    return {bytes_of(std::string_view(buffer.data(), buffer.size())), mesh->attribute(positions)->unique_id(),
            mesh->attribute(colours)->unique_id()};
}

Gltf make_draco(draco::MeshEncoderMethod method = draco::MESH_EDGEBREAKER_ENCODING) {
    const Encoded encoded = encode_square(method);
    Gltf gltf;
    const std::size_t view = gltf.add_view(encoded.bytes);
    gltf.json["accessors"] = {{{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
                              {{"componentType", 5121}, {"count", 4}, {"type", "VEC4"}, {"normalized", true}},
                              {{"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}}};
    gltf.add_mesh({{"POSITION", 0}, {"COLOR_0", 1}}, {{"indices", 2}});
    gltf.primitive()["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", view}, {"attributes", {{"POSITION", encoded.position_id}, {"COLOR_0", encoded.colour_id}}}};
    gltf.json["extensionsRequired"] = gltf.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    gltf.add_node({{"mesh", 0}});
    return gltf;
}

void expect_square(const Import& import) {
    ASSERT_EQ(import->meshes.size(), 1u);
    const Mesh& mesh = import->meshes[0];
    ASSERT_EQ(mesh.positions.size(), 4u);
    ASSERT_EQ(mesh.colours.size(), 1u);
    ASSERT_EQ(mesh.submeshes.at(0).indices.size(), 6u);
    // Draco orders the vertices as it likes; the colour tells which one it is.
    const std::array<std::pair<float, glm::vec3>, 4> due = {
        {{0.0f, {0, 0, 0}}, {0.2f, {1, 0, 0}}, {0.4f, {1, 1, 0}}, {1.0f, {0, 1, 0}}}};
    for (const auto& [red, position] : due) {
        bool found = false;
        for (std::size_t v = 0; v < 4; ++v) {
            found = found || (mesh.positions[v] == position && mesh.colours[0].values[v * 4] == red);
        }
        EXPECT_TRUE(found) << red;
    }
    double area = 0;
    for (std::size_t i = 0; i < 6; i += 3) {
        const auto corner = [&](std::size_t k) { return mesh.positions[mesh.submeshes[0].indices[i + k]]; };
        const glm::vec3 u = corner(1) - corner(0);
        const glm::vec3 v = corner(2) - corner(0);
        area += static_cast<double>(u.x * v.y - u.y * v.x) / 2;
    }
    EXPECT_EQ(area, 1.0);
    EXPECT_TRUE(import.report.warnings().empty());
}

TEST(GltfDraco, BothConnectivityMethodsAreDecoded) {
    expect_square(make_draco(draco::MESH_EDGEBREAKER_ENCODING).import());
    expect_square(make_draco(draco::MESH_SEQUENTIAL_ENCODING).import());
}

TEST(GltfDraco, AttributesBesideTheExtensionComeFromAccessors) {
    Gltf gltf = make_draco();
    gltf.primitive()["attributes"]["_ID"] = gltf.add_accessor<float>({1, 2, 3, 4}, "SCALAR");
    const Import import = gltf.import();
    EXPECT_EQ(import->meshes.at(0).attributes.at(0).values, (std::vector<float>{1, 2, 3, 4}));
}

TEST(GltfDraco, PrimitivesOfOneStreamShareItsVertices) {
    Gltf gltf = make_draco();
    gltf.json["meshes"][0]["primitives"].push_back(gltf.primitive());
    const Import import = gltf.import();
    EXPECT_EQ(import->meshes.at(0).positions.size(), 4u);
    EXPECT_EQ(import->meshes[0].submeshes.size(), 2u);
}

TEST(GltfDraco, FaultsNameThePrimitive) {
    Gltf missing = make_draco();
    missing.primitive()["extensions"]["KHR_draco_mesh_compression"]["attributes"]["COLOR_0"] = 77;
    EXPECT_EQ(missing.import().place(),
              "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression.attributes.COLOR_0");
    Gltf counted = make_draco();
    counted.json["accessors"][0]["count"] = 5;
    EXPECT_EQ(counted.import().message(), "the accessor has 5 elements, the Draco data 4");
    Gltf no_header = make_draco();
    no_header.json["bufferViews"][0]["byteOffset"] = 1;
    no_header.json["bufferViews"][0]["byteLength"] = no_header.buffer().size() - 1;
    EXPECT_EQ(no_header.import().message(), "Draco: the data does not start with the header of a triangle mesh");
    Gltf cut = make_draco();
    cut.json["bufferViews"][0]["byteLength"] = cut.buffer().size() - 8;
    EXPECT_EQ(cut.import().place(), "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression");
}

TEST(GltfDraco, CountsAreHeldAgainstTheData) {
    // Header, edgebreaker, traversal, then 2^31 vertices, 2^31 faces, and no attribute with seams.
    Bytes hostile =
        bytes_of(std::string_view("DRACO\x02\x02\x01\x01\x00\x00\x00"
                                  "\x80\x80\x80\x80\x08\x80\x80\x80\x80\x08\x00",
                                  23));
    Gltf gltf = make_draco();
    gltf.primitive()["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = gltf.add_view(hostile);
    EXPECT_EQ(gltf.import().message(), "Draco: 23 bytes cannot hold 2147483648 faces and 2147483648 vertices");
}

/// 587 bytes that ask for more than a thousand million orientations of texture coordinates: Draco 1.5.5 decodes each.
TEST(GltfDraco, CountsBeyondTheMeshAreRefused) {
    const Import import = import_file(source_folder() / "tests/converter/gltf/draco_orientations.gltf");
    EXPECT_EQ(import.message(), "Draco: a count goes beyond what the data describes");
}

}  // namespace
}  // namespace bendy::converter::draco_test
