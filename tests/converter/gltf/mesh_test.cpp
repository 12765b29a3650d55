#include "build_gltf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace bendy::converter::mesh_test {
namespace {

using namespace test;
using Indices = std::vector<std::uint32_t>;

// ---------------------------------------------------------------------------------------------- topology

/// The part that `vertices` vertices make in a mode, without indices.
Submesh part_of(int mode, std::size_t vertices, std::uint64_t* unused = nullptr) {
    Gltf gltf;
    gltf.add_mesh({{"POSITION", gltf.add_positions(vertices)}}, {{"mode", mode}});
    gltf.add_node({{"mesh", 0}});
    const Import import = gltf.import();
    if (unused != nullptr) *unused = import.warned("no whole primitive");
    return import->meshes.at(0).submeshes.at(0);
}

TEST(GltfMesh, ModesBecomeLists) {
    EXPECT_EQ(part_of(0, 3).indices, (Indices{0, 1, 2}));
    EXPECT_EQ(part_of(0, 3).topology, Topology::points);
    EXPECT_EQ(part_of(1, 4).indices, (Indices{0, 1, 2, 3}));
    EXPECT_EQ(part_of(1, 4).topology, Topology::lines);
    EXPECT_EQ(part_of(2, 3).indices, (Indices{0, 1, 1, 2, 2, 0}));
    EXPECT_EQ(part_of(3, 3).indices, (Indices{0, 1, 1, 2}));
    EXPECT_EQ(part_of(4, 3).indices, (Indices{0, 1, 2}));
    EXPECT_EQ(part_of(5, 5).indices, (Indices{0, 1, 2, 1, 3, 2, 2, 3, 4}));
    EXPECT_EQ(part_of(6, 5).indices, (Indices{1, 2, 0, 2, 3, 0, 3, 4, 0}));
    EXPECT_EQ(part_of(6, 5).topology, Topology::triangles);
}

TEST(GltfMesh, IncompletePrimitivesAreDroppedAndCounted) {
    std::uint64_t unused = 0;
    EXPECT_EQ(part_of(4, 5, &unused).indices, (Indices{0, 1, 2}));
    EXPECT_EQ(unused, 2u);
    EXPECT_EQ(part_of(1, 3, &unused).indices, (Indices{0, 1}));
    EXPECT_EQ(unused, 1u);
    for (const int mode : {2, 3}) EXPECT_TRUE(part_of(mode, 1, &unused).indices.empty());
    for (const int mode : {4, 5, 6}) EXPECT_TRUE(part_of(mode, 2, &unused).indices.empty());
    EXPECT_EQ(unused, 2u);
}

template <class T>
Import import_indices(const std::vector<T>& indices, int mode = 4, std::size_t vertices = 4) {
    Gltf gltf;
    gltf.add_mesh({{"POSITION", gltf.add_positions(vertices)}}, {{"mode", mode}});
    gltf.primitive()["indices"] = gltf.add_accessor(indices, "SCALAR");
    gltf.add_node({{"mesh", 0}});
    return gltf.import();
}

TEST(GltfMesh, IndicesOfEveryType) {
    EXPECT_EQ(import_indices<std::uint8_t>({0, 3, 1})->meshes.at(0).submeshes.at(0).indices, (Indices{0, 3, 1}));
    EXPECT_EQ(import_indices<std::uint16_t>({0, 3, 1})->meshes.at(0).submeshes.at(0).indices, (Indices{0, 3, 1}));
    EXPECT_EQ(import_indices<std::uint32_t>({0, 3, 1})->meshes.at(0).submeshes.at(0).indices, (Indices{0, 3, 1}));
    EXPECT_EQ(import_indices<float>({0, 3, 1}).message(), "accessors[1] must hold unsigned scalars");
    EXPECT_EQ(import_indices<std::int16_t>({0, 3, 1}).message(), "accessors[1] must hold unsigned scalars");
}

TEST(GltfMesh, IndicesMustBeInRange) {
    const Import import = import_indices<std::uint16_t>({0, 1, 4});
    EXPECT_EQ(import.place(), "meshes[0].primitives[0].indices");
    EXPECT_EQ(import.message(), "element 2: index 4 is out of range (there are 4 vertices)");
}

TEST(GltfMesh, PrimitiveRestartIsRefused) {
    EXPECT_EQ(import_indices<std::uint8_t>({0, 1, 2, 255, 3, 2, 1}, 5, 256).message(),
              "element 3: 255 would restart the primitive, which glTF forbids");
    EXPECT_TRUE(import_indices<std::uint8_t>({0, 1, 255}, 4, 256).result);
}

// ---------------------------------------------------------------------------------------------- merging

TEST(GltfMesh, PrimitivesOfOneLayoutBecomePartsOfOneMesh) {
    Gltf gltf = make_triangle();
    gltf.json["materials"] = {Json::object(), Json::object()};
    gltf.primitive()["material"] = 1;
    gltf.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", gltf.add_positions(6)}}}});
    gltf.json["meshes"][0]["name"] = "body";
    const Import import = gltf.import();
    ASSERT_EQ(import->meshes.size(), 1u);
    const Mesh& mesh = import->meshes[0];
    EXPECT_EQ(mesh.name, "body");
    EXPECT_EQ(mesh.positions.size(), 9u);
    ASSERT_EQ(mesh.submeshes.size(), 2u);
    EXPECT_EQ(mesh.submeshes[0].material, 1u);
    EXPECT_EQ(mesh.submeshes[1].material, kNone);
    EXPECT_EQ(mesh.submeshes[1].indices, (Indices{3, 4, 5, 6, 7, 8}));
}

TEST(GltfMesh, PrimitivesOfTheSameAccessorsShareTheirVertices) {
    Gltf gltf = make_triangle();
    const std::size_t indices = gltf.add_accessor<std::uint8_t>({2, 1, 0}, "SCALAR");
    gltf.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"indices", indices}});
    const Import import = gltf.import();
    ASSERT_EQ(import->meshes.size(), 1u);
    EXPECT_EQ(import->meshes[0].positions.size(), 3u);
    EXPECT_EQ(import->meshes[0].submeshes.at(1).indices, (Indices{2, 1, 0}));
}

TEST(GltfMesh, OtherLayoutsBecomeMeshesOfTheirOwn) {
    Gltf gltf = make_triangle();
    const std::size_t normals = gltf.add_accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    gltf.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}, {"NORMAL", normals}}}});
    const Import import = gltf.import();
    ASSERT_EQ(import->meshes.size(), 2u);
    EXPECT_TRUE(import->meshes[0].normals.empty());
    EXPECT_EQ(import->meshes[1].normals.size(), 3u);
    EXPECT_EQ(import->meshes[1].joint, 0u);
}

TEST(GltfMesh, AMeshOfTwoNodesIsMadeTwice) {
    Gltf gltf = make_triangle();
    gltf.add_node({{"mesh", 0}});
    const Import import = gltf.import();
    ASSERT_EQ(import->meshes.size(), 2u);
    EXPECT_EQ(import->meshes[0].positions, import->meshes[1].positions);
    EXPECT_EQ(import->meshes[1].joint, 1u);
}

TEST(GltfMesh, InstancesCannotGrowWithoutBound) {
    Gltf gltf;
    gltf.add_mesh({{"POSITION", gltf.add_positions(30'000)}}, {{"mode", 0}});
    for (int i = 0; i < 20'000; ++i) gltf.add_node({{"mesh", 0}});
    EXPECT_EQ(gltf.import().message(), "the decoded data would be implausibly large");
}

TEST(GltfMesh, PrimitivesWithoutPositionsAreLeftOut) {
    Gltf gltf = make_triangle();
    gltf.primitive()["attributes"] = {{"NORMAL", 0}};
    const Import import = gltf.import();
    EXPECT_TRUE(import->meshes.empty());
    EXPECT_EQ(import.warned("without POSITION"), 1u);
}

// ---------------------------------------------------------------------------------------------- streams

TEST(GltfMesh, StreamsKeepTheirSetNumbersAndNames) {
    Gltf gltf = make_triangle();
    Json& attributes = gltf.primitive()["attributes"];
    attributes["TEXCOORD_1"] = gltf.add_accessor<float>({0, 1, 2, 3, 4, 5}, "VEC2");
    attributes["TEXCOORD_10"] = attributes["TEXCOORD_1"];
    attributes["TEXCOORD_2"] = gltf.add_accessor<std::uint8_t>({0, 255, 0, 255, 0, 255}, "VEC2", true);
    attributes["COLOR_0"] = gltf.add_accessor<std::uint16_t>({65535, 0, 0, 0, 65535, 0, 0, 0, 65535}, "VEC3", true);
    attributes["TANGENT"] = gltf.add_accessor<float>({1, 0, 0, 1, 1, 0, 0, -1, 1, 0, 0, 1}, "VEC4");
    attributes["_HEAT"] = gltf.add_accessor<float>({7, 8, 9}, "SCALAR");
    const Import import = gltf.import();
    const Mesh& mesh = import->meshes.at(0);
    ASSERT_EQ(mesh.texture_coords.size(), 3u);
    EXPECT_EQ(mesh.texture_coords[0].set, 1u);
    EXPECT_EQ(mesh.texture_coords[1].set, 2u);
    EXPECT_EQ(mesh.texture_coords[1].values, (std::vector<float>{0, 1, 0, 1, 0, 1}));
    EXPECT_EQ(mesh.texture_coords[2].set, 10u);
    ASSERT_EQ(mesh.colours.size(), 1u);
    EXPECT_EQ(mesh.colours[0].components, 3u);
    EXPECT_EQ(mesh.colours[0].values[4], 1.0f);
    EXPECT_EQ(mesh.tangents.at(1), glm::vec4(1, 0, 0, -1));
    ASSERT_EQ(mesh.attributes.size(), 1u);
    EXPECT_EQ(mesh.attributes[0].name, "_HEAT");
    EXPECT_EQ(mesh.attributes[0].values, (std::vector<float>{7, 8, 9}));
}

TEST(GltfMesh, AttributesMustFitThePositions) {
    const auto error_of = [](const char* name, std::size_t elements, const char* type) {
        Gltf gltf = make_triangle();
        gltf.primitive()["attributes"][name] =
            gltf.add_accessor(std::vector<float>(elements * components_of(type)), type);
        const Import import = gltf.import();
        return import.place() + ": " + import.message();
    };
    EXPECT_EQ(error_of("NORMAL", 2, "VEC3"),
              "meshes[0].primitives[0].attributes.NORMAL: 2 elements, but POSITION has 3");
    EXPECT_EQ(error_of("NORMAL", 3, "VEC2"),
              "meshes[0].primitives[0].attributes.NORMAL: expected elements of 3 components, found 2");
    EXPECT_EQ(error_of("COLOR_0", 3, "VEC2"),
              "meshes[0].primitives[0].attributes.COLOR_0: expected elements of 3 to 4 components, found 2");
    EXPECT_EQ(error_of("TEXCOORD_0", 3, "VEC3"),
              "meshes[0].primitives[0].attributes.TEXCOORD_0: expected elements of 2 components, found 3");
    EXPECT_EQ(error_of("POSITION", 3, "VEC4"),
              "meshes[0].primitives[0].attributes.POSITION: expected elements of 3 components, found 4");
}

// ---------------------------------------------------------------------------------------------- influences

TEST(GltfMesh, InfluencesWithoutWeightGoAndTheOthersStayInOrder) {
    const Import import = make_skinned(4, {{{3, 1, 2, 0, 0, 0, 0, 0}, {0, 0.25f, 0, 0.75f, 1, 0, 0, 0}}}).import();
    const Mesh& mesh = import->meshes.at(0);
    EXPECT_EQ(mesh.influences, 2u);
    EXPECT_EQ(mesh.bones, (std::vector<std::uint32_t>{1, 0, 0, 0}));
    EXPECT_EQ(mesh.weights, (std::vector<float>{0.25f, 0.75f, 1, 0}));
    EXPECT_TRUE(import.report.warnings().empty());
}

TEST(GltfMesh, AllSetsOfInfluencesAreKept) {
    const std::vector<float> weights(4, 0.0625f);
    const Import import =
        make_skinned(
            16,
            {{{0, 1, 2, 3}, weights}, {{4, 5, 6, 7}, weights}, {{8, 9, 10, 11}, weights}, {{12, 13, 14, 15}, weights}})
            .import();
    EXPECT_EQ(import->meshes.at(0).influences, 16u);
    EXPECT_TRUE(import.report.warnings().empty());
}

TEST(GltfMesh, InfluencesOfOneJointBecomeOne) {
    const Import import = make_skinned(3, {{{2, 1, 2, 0, 0, 1, 0, 0}, {0.25f, 0.125f, 0.25f, 0.125f, 1, 0, 0, 0}},
                                           {{1, 2, 0, 0, 0, 0, 0, 0}, {0.125f, 0.125f, 0, 0, 0, 0, 0, 0}}})
                              .import();
    const Mesh& mesh = import->meshes.at(0);
    EXPECT_EQ(mesh.influences, 3u);
    EXPECT_EQ(mesh.bones, (std::vector<std::uint32_t>{2, 1, 0, 0, 0, 0}));
    EXPECT_EQ(mesh.weights, (std::vector<float>{0.625f, 0.25f, 0.125f, 1, 0, 0}));
    EXPECT_EQ(import.warned("influences of a vertex by the same joint merged into one"), 1u);
}

TEST(GltfMesh, WeightsAreNormalisedOverAllSets) {
    const Import import = make_skinned(2, {{{0, 0, 0, 0, 1, 0, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0}},
                                           {{1, 0, 0, 0, 0, 0, 0, 0}, {3, 0, 0, 0, 0, 0, 0, 0}}})
                              .import();
    EXPECT_EQ(import->meshes.at(0).weights, (std::vector<float>{0.25f, 0.75f, 1, 0}));
    EXPECT_EQ(import.warned("did not sum to 1"), 1u);
}

TEST(GltfMesh, WeightsThatSumToOneButForRoundingKeepTheirBits) {
    const std::vector<float> weights{0.1f, 0.2f, 0.3f, 0.4f};
    const Import import = make_skinned(4, {{{0, 1, 2, 3}, weights}}).import();
    EXPECT_EQ(import->meshes.at(0).weights, weights);
    EXPECT_TRUE(import.report.warnings().empty());
}

TEST(GltfMesh, VerticesWithoutWeightFollowTheirFirstJoint) {
    const Import import = make_skinned(4, {{{3, 1, 2, 0}, {0, 0, 0, 0}}}).import();
    EXPECT_EQ(import->meshes.at(0).bones, (std::vector<std::uint32_t>{3}));
    EXPECT_EQ(import->meshes.at(0).weights, (std::vector<float>{1}));
    EXPECT_EQ(import.warned("vertex without weights"), 1u);
}

TEST(GltfMesh, WeightsThatAreNanAreZero) {
    const float nan = std::nanf("");
    const Import import = make_skinned(4, {{{3, 1, 2, 0, 0, 2, 0, 0}, {nan, nan, nan, nan, nan, 0.5f, 0, 0}}}).import();
    EXPECT_EQ(import->meshes.at(0).bones, (std::vector<std::uint32_t>{3, 2}));
    EXPECT_EQ(import->meshes.at(0).weights, (std::vector<float>{1, 1}));
    EXPECT_EQ(import.warned("NaN replaced by 0"), 5u);
    EXPECT_EQ(import.warned("vertex without weights"), 1u);
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(make_skinned(2, {{{0, 1, 0, 0}, {infinity, 0, 0, 0}}}).import().place(),
              "meshes[0].primitives[0].attributes.WEIGHTS_0");
}

TEST(GltfMesh, NormalsAndTangentsThatAreNanAreZero) {
    const float nan = std::nanf("");
    Gltf gltf;
    gltf.add_mesh({{"POSITION", gltf.add_accessor<float>({0, 0, 0, 1, 0, 0}, "VEC3")},
                   {"NORMAL", gltf.add_accessor<float>({0, 0, 1, nan, nan, nan}, "VEC3")},
                   {"TANGENT", gltf.add_accessor<float>({1, 0, 0, 1, nan, nan, nan, -1}, "VEC4")}},
                  {{"mode", 0}});
    gltf.add_node({{"mesh", 0}});
    const Import import = gltf.import();
    EXPECT_EQ(import->meshes.at(0).normals, (std::vector<glm::vec3>{{0, 0, 1}, {0, 0, 0}}));
    EXPECT_EQ(import->meshes.at(0).tangents, (std::vector<glm::vec4>{{1, 0, 0, 1}, {0, 0, 0, -1}}));
    EXPECT_EQ(import.warned("NaN replaced by 0"), 6u);
}

TEST(GltfMesh, NegativeWeights) {
    const Import import = make_skinned(2, {{{0, 1, 0, 0}, {1, -0.5f, 0, 0}}}).import();
    EXPECT_EQ(import.place(), "meshes[0].primitives[0].attributes.WEIGHTS_0");
    EXPECT_EQ(import.message(), "vertex 0: weight -0.500000 is negative");
    const Import rounding = make_skinned(2, {{{0, 1, 0, 0}, {1, -1e-6f, 0, 0}}}).import();
    EXPECT_EQ(rounding->meshes.at(0).weights, (std::vector<float>{1}));
    EXPECT_EQ(rounding.warned("a little below zero"), 1u);
}

TEST(GltfMesh, JointsMustBeInTheSkinWhereTheyHaveWeight) {
    const Import import = make_skinned(2, {{{0, 0, 0, 0, 1, 2, 0, 0}, {1, 0, 0, 0, 0.5f, 0.5f, 0, 0}}}).import();
    EXPECT_EQ(import.place(), "meshes[0].primitives[0].attributes.JOINTS_0");
    EXPECT_EQ(import.message(), "vertex 1: joint index 2 is out of range (skins[0] has 2 joints)");
    EXPECT_TRUE(make_skinned(2, {{{0, 200, 0, 0}, {1, 0, 0, 0}}}).import().result);
}

TEST(GltfMesh, JointsWithoutASkinAreLeftOut) {
    Gltf gltf = make_skinned(2, {{{0, 1, 0, 0}, {0.5f, 0.5f, 0, 0}}});
    gltf.json["nodes"][2].erase("skin");
    const Import import = gltf.import();
    EXPECT_EQ(import->meshes.at(0).influences, 0u);
    EXPECT_EQ(import->meshes.at(0).joint, 2u);
    EXPECT_EQ(import.warned("joints and weights of a primitive left out"), 1u);
}

TEST(GltfMesh, SkinnedNodesWithoutJointsAreRigid) {
    Gltf gltf = make_skinned(1, {{{0, 0, 0, 0}, {1, 0, 0, 0}}});
    gltf.primitive()["attributes"].erase("WEIGHTS_0");
    const Import import = gltf.import();
    EXPECT_EQ(import->meshes.at(0).influences, 0u);
    EXPECT_EQ(import.warned("in a skinned mesh"), 1u);
    EXPECT_EQ(import.warned("'JOINTS_0' without its counterpart"), 1u);
}

TEST(GltfMesh, SkinsOverOneSkeletonHavePalettesOfTheirOwn) {
    Gltf gltf = make_skinned(2, {{{0, 1, 0, 0}, {0.5f, 0.5f, 0, 0}}});
    const std::vector<float> matrices = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1,
                                         1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -2, 0, 1};
    gltf.json["skins"].push_back({{"joints", {1, 0}}, {"inverseBindMatrices", gltf.add_accessor(matrices, "MAT4")}});
    gltf.add_node({{"mesh", 0}, {"skin", 1}});
    const Import import = gltf.import();
    ASSERT_EQ(import->meshes.size(), 2u);
    EXPECT_EQ(import->meshes[0].palette.joints, (std::vector<std::uint32_t>{0, 1}));
    EXPECT_EQ(import->meshes[0].palette.inverse_bind[1], glm::mat4(1.0f));
    EXPECT_EQ(import->meshes[1].palette.joints, (std::vector<std::uint32_t>{1, 0}));
    EXPECT_EQ(import->meshes[1].palette.inverse_bind[1][3], glm::vec4(0, -2, 0, 1));
}

TEST(GltfMesh, InverseBindMatricesMustBeEnoughAndAffine) {
    Gltf gltf = make_skinned(2, {{{0, 1, 0, 0}, {0.5f, 0.5f, 0, 0}}});
    gltf.json["skins"][0]["inverseBindMatrices"] = gltf.add_accessor(std::vector<float>(16), "MAT4");
    const Import few = gltf.import();
    EXPECT_EQ(few.place(), "skins[0].inverseBindMatrices");
    EXPECT_EQ(few.message(), "1 matrices for 2 joints");
    gltf.json["skins"][0]["inverseBindMatrices"] = gltf.add_accessor(std::vector<float>(32), "MAT4");
    const Import flat = gltf.import();
    EXPECT_EQ(flat->meshes.at(0).palette.inverse_bind[0][3], glm::vec4(0, 0, 0, 1));
    EXPECT_EQ(flat.warned("last row of an inverse bind matrix"), 2u);
}

// ---------------------------------------------------------------------------------------------- morph targets

Gltf make_morph() {
    Gltf gltf = make_triangle();
    const std::size_t moved = gltf.add_accessor<float>({1, 0, 0, 2, 0, 0, 3, 0, 0}, "VEC3");
    gltf.primitive()["targets"] = {{{"POSITION", moved}}, Json::object()};
    return gltf;
}

TEST(GltfMesh, MorphTargetsWithNamesAndRestWeights) {
    Gltf gltf = make_morph();
    gltf.json["meshes"][0]["extras"]["targetNames"] = {"smile", "blink"};
    gltf.json["meshes"][0]["weights"] = {0.25, 0.5};
    gltf.add_node({{"mesh", 0}, {"weights", {1, 2}}});
    const Import import = gltf.import();
    const auto& targets = import->meshes.at(0).targets;
    ASSERT_EQ(targets.size(), 2u);
    EXPECT_EQ(targets[0].name, "smile");
    EXPECT_EQ(targets[0].positions, (std::vector<glm::vec3>{{1, 0, 0}, {2, 0, 0}, {3, 0, 0}}));
    EXPECT_TRUE(targets[0].normals.empty());
    EXPECT_TRUE(targets[1].positions.empty());
    EXPECT_EQ(targets[1].rest_weight, 0.5f);
    EXPECT_EQ(import->meshes.at(1).targets[1].rest_weight, 2.0f);
}

/// As UniVRM and UnityGLTF write them.
TEST(GltfMesh, NamesOfTargetsInPrimitives) {
    Gltf gltf = make_morph();
    gltf.json["meshes"][0]["primitives"].push_back(gltf.primitive());
    gltf.primitive(0, 0)["extras"]["targetNames"] = {"Smile", "Blink"};
    gltf.primitive(0, 1)["extras"]["targetNames"] = {"Smile", "Blink"};
    const Import import = gltf.import();
    const auto& targets = import->meshes.at(0).targets;
    ASSERT_EQ(targets.size(), 2u);
    EXPECT_EQ(targets[0].name, "Smile");
    EXPECT_EQ(targets[1].name, "Blink");
    EXPECT_TRUE(import.report.warnings().empty());
}

/// As exporters of VRM 0 wrote them.
TEST(GltfMesh, NamesOfTargetsInTargets) {
    Gltf gltf = make_morph();
    Json& targets = gltf.primitive()["targets"];
    targets[0]["extra"] = {{"name", "Smile"}};
    targets[1]["extras"] = {{"name", "Blink"}};
    const Import import = gltf.import();
    ASSERT_EQ(import->meshes.at(0).targets.size(), 2u);
    EXPECT_EQ(import->meshes.at(0).targets[0].name, "Smile");
    EXPECT_EQ(import->meshes.at(0).targets[0].positions.size(), 3u);
    EXPECT_EQ(import->meshes.at(0).targets[1].name, "Blink");
    EXPECT_TRUE(import.report.warnings().empty());
    targets[0]["extra"] = {{"name", "Smile"}, {"group", 2}};
    targets[1] = {{"name", "Wink"}, {"extras", 5.5}, {"extensions", {{"ACME", 1}}}};
    const Import more = gltf.import();
    ASSERT_FALSE(more.result.has_value());
    EXPECT_EQ(more.result.error().place, "meshes[0].primitives[0].targets[1].extras") << "a number is an accessor's";
    targets[1].erase("extras");
    const Import rest = gltf.import();
    EXPECT_EQ(rest->meshes.at(0).targets.at(0).name, "Smile");
    EXPECT_EQ(rest->meshes.at(0).targets.at(1).name, "Wink");
    EXPECT_EQ(rest.warned("members of a morph target that are neither accessors nor its name are left out"), 2u);
}

TEST(GltfMesh, NamesOfTargetsThatDifferAreSaid) {
    Gltf gltf = make_morph();
    gltf.json["meshes"][0]["primitives"].push_back(gltf.primitive());
    gltf.json["meshes"][0]["extras"]["targetNames"] = {"Smile"};
    gltf.primitive(0, 0)["extras"]["targetNames"] = {"Grin", "Blink"};
    gltf.primitive(0, 1)["extras"]["targetNames"] = {"Smile", "Wink"};
    const Import import = gltf.import();
    const auto& targets = import->meshes.at(0).targets;
    ASSERT_EQ(targets.size(), 2u);
    EXPECT_EQ(targets[0].name, "Smile");
    EXPECT_EQ(targets[1].name, "Blink");
    EXPECT_EQ(import.warned("name of a morph target left out: the mesh or an earlier primitive gives another one"), 2u);
}

TEST(GltfMesh, NamesOfTargetsThatAreNoStringsAreLeftOut) {
    Gltf gltf = make_morph();
    gltf.primitive()["extras"] = {{"targetNames", {"Smile", 5, "Blink"}}};
    const Import import = gltf.import();
    EXPECT_EQ(import->meshes.at(0).targets.at(0).name, "Smile");
    EXPECT_EQ(import->meshes.at(0).targets.at(1).name, "");
    EXPECT_EQ(import.warned("extras of primitives left out"), 1u);
    gltf.primitive()["extras"] = {{"targetNames", {"Smile"}}, {"tool", "own"}};
    EXPECT_EQ(gltf.import().warned("extras of primitives left out"), 1u);
    gltf.primitive()["extras"] = {{"targetNames", "Smile"}};
    EXPECT_EQ(gltf.import()->meshes.at(0).targets.at(0).name, "");
}

TEST(GltfMesh, MergedPrimitivesFillMissingDisplacementsWithZeros) {
    Gltf gltf = make_morph();
    Json second = {{"attributes", {{"POSITION", gltf.add_positions(3)}}},
                   {"targets", {Json::object(), {{"POSITION", 1}}}}};
    gltf.json["meshes"][0]["primitives"].push_back(second);
    const Import import = gltf.import();
    ASSERT_EQ(import->meshes.size(), 1u);
    const auto& targets = import->meshes[0].targets;
    EXPECT_EQ(targets.at(0).positions.size(), 6u);
    EXPECT_EQ(targets.at(0).positions[5], glm::vec3(0));
    EXPECT_EQ(targets.at(1).positions[2], glm::vec3(0));
    EXPECT_EQ(targets.at(1).positions[5], glm::vec3(3, 0, 0));
}

TEST(GltfMesh, PrimitivesWithFewerTargetsArePadded) {
    Gltf gltf = make_morph();
    gltf.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", gltf.add_positions(3)}}}});
    const Import import = gltf.import();
    ASSERT_EQ(import->meshes.size(), 2u);
    EXPECT_EQ(import->meshes[1].targets.size(), 2u);
    EXPECT_TRUE(import->meshes[1].targets[0].positions.empty());
}

TEST(GltfMesh, OtherMorphedAttributesAreNamed) {
    Gltf gltf = make_morph();
    gltf.primitive()["targets"][0]["TEXCOORD_0"] = gltf.add_accessor(std::vector<float>(6), "VEC2");
    EXPECT_EQ(gltf.import().warned("'TEXCOORD_0' left out"), 1u);
}

TEST(GltfMesh, MorphTargetsMustFitThePositions) {
    Gltf gltf = make_morph();
    gltf.primitive()["targets"][1]["POSITION"] = gltf.add_positions(2);
    const Import import = gltf.import();
    EXPECT_EQ(import.place(), "meshes[0].primitives[0].targets[1].POSITION");
    EXPECT_EQ(import.message(), "2 elements, but POSITION has 3");
}

}  // namespace
}  // namespace bendy::converter::mesh_test
