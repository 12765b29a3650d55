#include "build_gltf.h"

#include "formats/gltf/meshopt.h"

#include <meshoptimizer.h>

#include <gtest/gtest.h>

#include <cstring>

namespace bendy::converter::meshopt_test {
namespace {

using namespace test;
using test::Json;  // not that of the converter
using namespace gltf;

template <class T>
std::vector<T> values_of(const Bytes& bytes) {
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

/// Elements of 12 bytes: a float ramp, two 16-bit ramps, four bytes.
Bytes sample_elements() {
    Bytes bytes;
    for (std::uint32_t i = 0; i < 20; ++i) {
        const float ramp = 1.0f + static_cast<float>(i) * 0.125f;
        std::uint32_t bits = 0;
        std::memcpy(&bits, &ramp, sizeof bits);
        append_u32(bytes, bits);
        append_u32(bytes, (1000 + i * 300) | (60000 - i * 700) << 16);
        append_u32(bytes, i | (255 - i) << 8 | 7u << 16 | (i * 37 & 255u) << 24);
    }
    return bytes;
}

/// sample_elements as meshoptimizer 1.3.0 encodes them in version 1: channel modes 2 (XOR, rotated by 5), 1 and 0.
const std::vector<std::uint8_t> kVersionOne = {
    0xa1, 0x68, 0x77, 0xe5, 0x01, 0x00, 0x01, 0x0f, 0x02, 0x02, 0x62, 0xe2, 0x62, 0xf1, 0x31, 0x71, 0x31, 0xfe, 0x0f,
    0x00, 0x0f, 0x01, 0x03, 0x01, 0x00, 0x58, 0x58, 0x58, 0x58, 0x58, 0x58, 0x58, 0x58, 0x58, 0x58, 0x58, 0x58, 0x58,
    0x58, 0x58, 0x58, 0x58, 0x58, 0x58, 0x05, 0x2a, 0xaa, 0xaa, 0xaa, 0xaa, 0x00, 0x00, 0x00, 0x00, 0x77, 0x77, 0x77,
    0x77, 0x77, 0x77, 0x77, 0x77, 0x77, 0x77, 0x77, 0x77, 0x77, 0x77, 0x77, 0x77, 0x77, 0x77, 0x77, 0x02, 0x05, 0x55,
    0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x0f, 0x00, 0x05, 0x05, 0x05, 0x05, 0x05, 0x2a, 0xaa, 0xaa, 0xaa, 0xaa, 0x00,
    0x00, 0x00, 0x05, 0x15, 0x55, 0x55, 0x55, 0x55, 0x00, 0x00, 0x00, 0x00, 0x4a, 0x4a, 0x4a, 0x4a, 0x4a, 0x4a, 0x4a,
    0x4a, 0x4a, 0x4a, 0x4a, 0x4a, 0x4a, 0x4a, 0x4a, 0x4a, 0x4a, 0x4a, 0x4a, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x00, 0x80, 0x3f, 0xe8, 0x03, 0x60, 0xea, 0x00, 0xff, 0x07, 0x00, 0x52, 0x01, 0x00};

TEST(GltfMeshopt, VerticesOfVersionOne) {
    Bytes decoded(240);
    ASSERT_TRUE(decode_meshopt_vertices(bytes_of(kVersionOne), 12, decoded));
    EXPECT_EQ(decoded, sample_elements());
}

TEST(GltfMeshopt, PrefixesOfVersionOneAreMalformed) {
    const Bytes whole = bytes_of(kVersionOne);
    Bytes decoded(240);
    for (std::size_t size = 0; size < whole.size(); ++size) {
        EXPECT_FALSE(decode_meshopt_vertices(std::span(whole).first(size), 12, decoded)) << size;
    }
}

/// As the library encodes it, which writes version 0.
Bytes encode_vertices(const Bytes& elements, std::size_t stride) {
    const std::size_t count = elements.size() / stride;
    std::vector<std::uint8_t> encoded(meshopt_encodeVertexBufferBound(count, stride));
    meshopt_encodeVertexVersion(0);
    encoded.resize(meshopt_encodeVertexBuffer(encoded.data(), encoded.size(), elements.data(), count, stride));
    return bytes_of(encoded);
}

TEST(GltfMeshopt, VerticesOfVersionZeroAgreeWithTheLibrary) {
    std::uint32_t state = 1;
    for (const std::size_t stride : {4u, 12u, 20u, 64u, 256u}) {
        for (const std::size_t count : {1u, 15u, 16u, 17u, 255u, 256u, 300u}) {
            Bytes elements(count * stride);
            for (auto& byte : elements) {
                state = state * 1664525 + 1013904223;
                byte = static_cast<std::byte>(state >> 24 & (state >> 16 & 1 ? 0xffu : 0x03u));
            }
            const Bytes encoded = encode_vertices(elements, stride);
            Bytes decoded(elements.size());
            ASSERT_TRUE(decode_meshopt_vertices(encoded, stride, decoded)) << stride << ' ' << count;
            EXPECT_EQ(decoded, elements) << stride << ' ' << count;
        }
    }
}

TEST(GltfMeshopt, FlippedBitsAreHandledAsTheLibraryDoes) {
    const Bytes elements = sample_elements();
    const Bytes encoded = encode_vertices(elements, 12);
    Bytes ours(elements.size());
    Bytes theirs(elements.size());
    for (std::size_t bit = 8; bit < encoded.size() * 8; ++bit) {
        Bytes damaged = encoded;
        damaged[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
        const bool accepted = decode_meshopt_vertices(damaged, 12, ours);
        const bool expected =
            meshopt_decodeVertexBuffer(theirs.data(), 20, 12, reinterpret_cast<const unsigned char*>(damaged.data()),
                                       damaged.size()) == 0;
        ASSERT_EQ(accepted, expected) << bit;
        if (accepted) {
            EXPECT_EQ(ours, theirs) << bit;
        }
    }
}

// The expected values of the filters are meshoptimizer 1.3.0's; both round to nearest.

TEST(GltfMeshopt, QuaternionFilter) {
    Bytes bytes = bytes_of(std::vector<std::int16_t>{0, 0, 0, 2047, 1447, 1447, 1447, 2044, 579, 1963, -289, 2045});
    decode_quaternion(bytes);
    EXPECT_EQ(values_of<std::int16_t>(bytes),
              (std::vector<std::int16_t>{0, 0, 0, 32767, 16399, 16378, 16378, 16378, -3271, 22942, 6554, 22219}));
}

TEST(GltfMeshopt, OctahedralFilter) {
    Bytes small = bytes_of(std::vector<std::int8_t>{0, 0, 127, 127, 127, 73, 127, -127, -42, 42, 127, 0});
    decode_octahedral(small, 4);
    EXPECT_EQ(values_of<std::int8_t>(small),
              (std::vector<std::int8_t>{0, 0, 127, 127, 76, 0, -102, -127, -73, 73, 74, 0}));
    Bytes large = bytes_of(std::vector<std::int16_t>{0, 0, 2047, 32767, 2047, 1170, 2047, -32767, -682, 682, 2047, 0});
    decode_octahedral(large, 8);
    EXPECT_EQ(values_of<std::int16_t>(large),
              (std::vector<std::int16_t>{0, 0, 32767, 32767, 19653, 0, -26219, -32767, -18909, 18909, 18937, 0}));
}

TEST(GltfMeshopt, ColourFilter) {
    Bytes small = bytes_of(std::vector<std::int8_t>{64, 127, -63, -1, -128, -63, 0, -64, -1, 0, 0, -128});
    decode_colour(small, 4);
    EXPECT_EQ(values_of<std::uint8_t>(small),
              (std::vector<std::uint8_t>{254, 1, 0, 255, 65, 128, 191, 128, 255, 255, 255, 0}));
    Bytes large = bytes_of(std::vector<std::int16_t>{1024, 2047, -1023, 4095, 2048, -1023, 0, 3072, 4095, 0, 0, 2048});
    decode_colour(large, 8);
    EXPECT_EQ(values_of<std::uint16_t>(large),
              (std::vector<std::uint16_t>{65519, 16, 0, 65535, 16404, 32776, 49147, 32776, 65535, 65535, 65535, 0}));
}

TEST(GltfMeshopt, ExponentialFilter) {
    Bytes bytes = bytes_of(std::vector<std::uint32_t>{0x00000003, 0xff000003, 0x02fffffd, 0x9c000001});
    decode_exponential(bytes);
    EXPECT_EQ(values_of<float>(bytes), (std::vector<float>{3.0f, 1.5f, -12.0f, 0x1p-100f}));
}

TEST(GltfMeshopt, FiltersSurviveNonsense) {
    for (const int value : {0, -1, 1, 127, -128}) {
        Bytes bytes(16, static_cast<std::byte>(value));
        decode_octahedral(bytes, 4);
        decode_octahedral(bytes, 8);
        decode_quaternion(bytes);
        decode_colour(bytes, 4);
        decode_colour(bytes, 8);
        decode_exponential(bytes);
    }
}

/// A triangle whose positions and indices are compressed.
Gltf make_compressed() {
    Gltf gltf;
    const Bytes positions = bytes_of(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
    const Bytes vertices = encode_vertices(positions, 12);
    const std::vector<std::uint32_t> indices{2, 1, 0};
    std::vector<std::uint8_t> triangles(meshopt_encodeIndexBufferBound(3, 3));
    triangles.resize(meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), indices.data(), 3));
    const std::size_t vertex_view = gltf.add_view(vertices);
    const std::size_t index_view = gltf.add_view(bytes_of(triangles));
    const auto compress = [&](std::size_t view, std::size_t stride, const char* mode) {
        Json& json = gltf.json["bufferViews"][view];
        json["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},          {"byteOffset", json["byteOffset"]},
                                                         {"count", 3},           {"byteLength", json["byteLength"]},
                                                         {"byteStride", stride}, {"mode", mode}};
        json["buffer"] = 1;
        json["byteOffset"] = 0;
        json["byteLength"] = 3 * stride;
    };
    compress(vertex_view, 12, "ATTRIBUTES");
    compress(index_view, 2, "TRIANGLES");
    gltf.json["accessors"] = {{{"bufferView", vertex_view}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}},
                              {{"bufferView", index_view}, {"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}}};
    gltf.add_mesh({{"POSITION", 0}}, {{"indices", 1}});
    gltf.add_node({{"mesh", 0}});
    return gltf;
}

/// With the fallback buffer that holds nothing.
Import import_compressed(const Gltf& gltf) {
    Json root = gltf.json;
    root["buffers"] = {{{"byteLength", gltf.buffer().size()}}, {{"byteLength", 36}}};
    return import_bytes(make_glb({{"JSON", bytes_of(root.dump())}, {std::string("BIN\0", 4), gltf.buffer()}}));
}

TEST(GltfMeshopt, CompressedViewsAreDecoded) {
    const Import import = import_compressed(make_compressed());
    ASSERT_EQ(import->meshes.size(), 1u);
    EXPECT_EQ(import->meshes[0].positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    // The codec may turn a triangle, never over.
    const auto& indices = import->meshes[0].submeshes.at(0).indices;
    ASSERT_EQ(indices.size(), 3u);
    EXPECT_EQ((indices[0] + 2) % 3, indices[1]);
    EXPECT_EQ((indices[1] + 2) % 3, indices[2]);
}

TEST(GltfMeshopt, FaultsNameTheView) {
    const auto error_of = [](const char* member, const Json& value) {
        Gltf gltf = make_compressed();
        gltf.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][member] = value;
        const Import import = import_compressed(gltf);
        EXPECT_EQ(import.place().substr(0, 49), "bufferViews[0].extensions.EXT_meshopt_compression") << member;
        return import.message();
    };
    EXPECT_EQ(error_of("byteLength", 20), "the compressed attribute data is malformed");
    EXPECT_EQ(error_of("byteLength", 100000).substr(0, 18), "it exceeds buffer ");
    EXPECT_EQ(error_of("count", 4), "count * byteStride is 48 bytes, the view's byteLength 36");
    EXPECT_EQ(error_of("byteStride", 13), "count * byteStride is 39 bytes, the view's byteLength 36");
    EXPECT_EQ(error_of("mode", "MAGIC"), "'MAGIC' is not one of ATTRIBUTES|TRIANGLES|INDICES");
    EXPECT_EQ(error_of("filter", "QUATERNION"), "filter QUATERNION demands a byteStride of 8");
    EXPECT_EQ(error_of("filter", "COLOR"), "'COLOR' is not one of NONE|OCTAHEDRAL|QUATERNION|EXPONENTIAL");
}

}  // namespace
}  // namespace bendy::converter::meshopt_test
