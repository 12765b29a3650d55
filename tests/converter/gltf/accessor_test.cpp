#include "build_gltf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace bendy::converter::accessor_test {
namespace {

using namespace test;

/// The values of a custom attribute `_A` as imported.
std::vector<float> attribute_values(const Gltf& gltf) {
    const Import import = gltf.import();
    if (import->meshes.empty() || import->meshes[0].attributes.empty()) return {};
    return import->meshes[0].attributes[0].values;
}

/// A triangle whose attribute `_A` has these values.
template <class T>
Gltf with_attribute(const std::vector<T>& values, const char* type, bool normalised) {
    Gltf gltf = make_triangle();
    gltf.primitive()["attributes"]["_A"] = gltf.add_accessor(values, type, normalised);
    return gltf;
}

TEST(GltfAccessor, ComponentTypesAsTheyAre) {
    EXPECT_EQ(attribute_values(with_attribute<std::int8_t>({-128, 0, 127}, "SCALAR", false)),
              (std::vector<float>{-128, 0, 127}));
    EXPECT_EQ(attribute_values(with_attribute<std::uint8_t>({0, 128, 255}, "SCALAR", false)),
              (std::vector<float>{0, 128, 255}));
    EXPECT_EQ(attribute_values(with_attribute<std::int16_t>({-32768, 0, 32767}, "SCALAR", false)),
              (std::vector<float>{-32768, 0, 32767}));
    EXPECT_EQ(attribute_values(with_attribute<std::uint16_t>({0, 1, 65535}, "SCALAR", false)),
              (std::vector<float>{0, 1, 65535}));
    EXPECT_EQ(attribute_values(with_attribute<std::uint32_t>({0, 1, 16777216}, "SCALAR", false)),
              (std::vector<float>{0, 1, 16777216}));
    EXPECT_EQ(attribute_values(with_attribute<float>({-0.1f, 1e-40f, 3e38f}, "SCALAR", false)),
              (std::vector<float>{-0.1f, 1e-40f, 3e38f}));
}

TEST(GltfAccessor, NormalisedIntegersAreClampedToMinusOne) {
    EXPECT_EQ(attribute_values(with_attribute<std::int8_t>({-128, -127, 127}, "SCALAR", true)),
              (std::vector<float>{-1, -1, 1}));
    EXPECT_EQ(attribute_values(with_attribute<std::uint8_t>({0, 51, 255}, "SCALAR", true)),
              (std::vector<float>{0, 0.2f, 1}));
    EXPECT_EQ(attribute_values(with_attribute<std::int16_t>({-32768, -32767, 32767}, "SCALAR", true)),
              (std::vector<float>{-1, -1, 1}));
    EXPECT_EQ(attribute_values(with_attribute<std::uint16_t>({0, 13107, 65535}, "SCALAR", true)),
              (std::vector<float>{0, 0.2f, 1}));
}

TEST(GltfAccessor, ColumnsOfMatricesStartOnFourBytes) {
    Gltf gltf = make_triangle();
    std::vector<std::uint8_t> bytes;
    for (std::uint8_t element = 0; element < 3; ++element) {
        for (std::uint8_t i = 0; i < 12; ++i)
            bytes.push_back(i % 4 == 3 ? 99 : static_cast<std::uint8_t>(element * 12 + i));
    }
    const std::size_t view = gltf.add_view(bytes_of(bytes));
    gltf.json["accessors"].push_back({{"bufferView", view}, {"componentType", 5121}, {"count", 3}, {"type", "MAT3"}});
    gltf.primitive()["attributes"]["_A"] = 1;
    const auto values = attribute_values(gltf);
    ASSERT_EQ(values.size(), 27u);
    EXPECT_EQ((std::vector<float>(values.begin() + 9, values.begin() + 18)),
              (std::vector<float>{12, 13, 14, 16, 17, 18, 20, 21, 22}));
}

TEST(GltfAccessor, InterleavedViewWithoutPaddingAtItsEnd) {
    Gltf gltf = make_triangle();
    const std::size_t view = gltf.add_view(bytes_of(std::vector<float>{9, 1, 9, 9, 2, 9, 9, 3}));
    gltf.json["bufferViews"][view]["byteStride"] = 12;
    gltf.json["accessors"].push_back(
        {{"bufferView", view}, {"byteOffset", 4}, {"componentType", 5126}, {"count", 3}, {"type", "SCALAR"}});
    gltf.primitive()["attributes"]["_A"] = 1;
    EXPECT_EQ(attribute_values(gltf), (std::vector<float>{1, 2, 3}));
    gltf.json["accessors"][1]["byteOffset"] = 8;
    const Import beyond = gltf.import();
    EXPECT_EQ(beyond.place(), "meshes[0].primitives[0].attributes._A");
    EXPECT_EQ(beyond.message(), "accessors[1]: 3 elements of 4 bytes from byte 8 on exceed bufferViews[1] of 32 bytes");
}

TEST(GltfAccessor, StrideSmallerThanAnElementIsRefused) {
    Gltf gltf = make_triangle();
    gltf.json["bufferViews"][0]["byteStride"] = 4;
    EXPECT_EQ(gltf.import().message(),
              "accessors[0]: the byteStride of bufferViews[0] is 4, smaller than an element of 12 bytes");
}

/// Makes an accessor sparse: element `index` becomes `value`.
void make_sparse(Gltf& gltf, std::size_t accessor, std::vector<std::uint16_t> indices,
                 const std::vector<float>& values) {
    const auto count = indices.size();
    const std::size_t index_view = gltf.add_view(bytes_of(indices));
    const std::size_t value_view = gltf.add_view(bytes_of(values));
    gltf.json["accessors"][accessor]["sparse"] = {{"count", count},
                                                  {"indices", {{"bufferView", index_view}, {"componentType", 5123}}},
                                                  {"values", {{"bufferView", value_view}}}};
}

TEST(GltfAccessor, SparseOverAStridedView) {
    Gltf gltf = make_triangle();
    const std::size_t view = gltf.add_view(bytes_of(std::vector<float>{1, 9, 2, 9, 3, 9}));
    gltf.json["bufferViews"][view]["byteStride"] = 8;
    gltf.json["accessors"].push_back({{"bufferView", view}, {"componentType", 5126}, {"count", 3}, {"type", "SCALAR"}});
    make_sparse(gltf, 1, {0, 2}, {10, 30});
    gltf.primitive()["attributes"]["_A"] = 1;
    EXPECT_EQ(attribute_values(gltf), (std::vector<float>{10, 2, 30}));
}

TEST(GltfAccessor, SparseOverNothingIsOverZeros) {
    Gltf gltf = make_triangle();
    gltf.json["accessors"].push_back({{"componentType", 5126}, {"count", 3}, {"type", "SCALAR"}});
    gltf.primitive()["attributes"]["_A"] = 1;
    EXPECT_EQ(attribute_values(gltf), (std::vector<float>{0, 0, 0}));
    make_sparse(gltf, 1, {1}, {7});
    EXPECT_EQ(attribute_values(gltf), (std::vector<float>{0, 7, 0}));
}

TEST(GltfAccessor, SparseFaultsAreRefused) {
    Gltf gltf = make_triangle();
    make_sparse(gltf, 0, {3}, {1, 2, 3});
    EXPECT_EQ(gltf.import().message(), "accessors[0].sparse.indices: index 3 is out of range (3 elements)");
    Gltf short_values = make_triangle();
    make_sparse(short_values, 0, {0, 1}, {1, 2, 3});
    EXPECT_NE(short_values.import().message().find("accessors[0].sparse.values: 2 elements of 12 bytes"),
              std::string::npos);
    Gltf many = make_triangle();
    make_sparse(many, 0, {0, 1, 2, 0}, std::vector<float>(12));
    EXPECT_EQ(many.import().message(), "accessors[0].sparse: more values than the accessor has elements");
}

TEST(GltfAccessor, LyingCountsAreRefusedBeforeAnythingIsAllocated) {
    for (const double count : {4.0, 100000.0, 4294967295.0, 9007199254740991.0}) {
        Gltf gltf = make_triangle();
        gltf.json["accessors"][0]["count"] = count;
        const Import import = gltf.import();
        EXPECT_EQ(import.place(), "meshes[0].primitives[0].attributes.POSITION");
        EXPECT_NE(import.message().find("exceed bufferViews[0] of 36 bytes"), std::string::npos);
    }
    Gltf implied = make_triangle();
    implied.json["accessors"][0].erase("bufferView");
    implied.json["accessors"][0]["count"] = 1'000'000;
    EXPECT_EQ(implied.import().message(),
              "accessors[0]: 1000000 elements without stored data, at most 262144 are accepted");
}

TEST(GltfAccessor, ZerosWithoutDataMayBeAsManyAsTheFileHasBytes) {
    constexpr std::size_t kVertices = 300'000;
    Gltf stored;  // with a target that moves nothing, as exporters write it
    stored.json["accessors"].push_back({{"componentType", 5126}, {"count", kVertices}, {"type", "VEC3"}});
    const std::size_t positions = stored.add_accessor<float>(std::vector<float>(kVertices * 3), "VEC3");
    stored.add_mesh({{"POSITION", positions}}, {{"mode", 0}, {"targets", Json::array({{{"POSITION", 0}}})}});
    stored.add_node({{"mesh", 0}});
    EXPECT_EQ(stored.import().message(), "no error");
    Gltf sparse = make_triangle();
    make_sparse(sparse, 0, {3}, {1, 2, 3});
    sparse.json["accessors"][0].erase("bufferView");
    sparse.json["accessors"][0]["count"] = 262'145;
    EXPECT_EQ(sparse.import().message(), "no error");
    sparse.json["accessors"][0]["count"] = 262'146;
    EXPECT_EQ(sparse.import().message(),
              "accessors[0]: 262145 elements without stored data, at most 262144 are accepted");
}

TEST(GltfAccessor, SmallFilesCannotDecodeToAnySize) {
    Gltf gltf = make_triangle();
    gltf.json["accessors"][0].erase("bufferView");
    gltf.json["accessors"][0]["count"] = 262144;
    for (int i = 0; i < 100; ++i) gltf.primitive()["attributes"]["_A" + std::to_string(i)] = 0;
    EXPECT_EQ(gltf.import().message(), "the decoded data would be implausibly large");
}

TEST(GltfAccessor, NumbersThatAreNotFiniteAreRefusedByPlace) {
    Gltf gltf;
    gltf.add_mesh({{"POSITION", gltf.add_accessor<float>({0, 0, 0, 1, std::nanf(""), 0}, "VEC3")}}, {{"mode", 0}});
    gltf.add_node({{"mesh", 0}});
    const Import import = gltf.import();
    EXPECT_EQ(import.place(), "meshes[0].primitives[0].attributes.POSITION");
    EXPECT_EQ(import.message(), "accessors[0], element 1: NaN is not a finite number");

    const auto infinite = with_attribute<float>({0, 0, -std::numeric_limits<float>::infinity()}, "SCALAR", false);
    EXPECT_EQ(infinite.import().message(), "accessors[1], element 2: infinity is not a finite number");
}

}  // namespace
}  // namespace bendy::converter::accessor_test
