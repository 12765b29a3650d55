#include "build_gltf.h"

#include <gtest/gtest.h>

namespace bendy::converter::check_json_test {
namespace {

using namespace test;

/// "place: message" of the error that a file of this JSON gives.
std::string error_of(const std::string& members) {
    const Import import = import_text(R"({"asset":{"version":"2.0"},)" + members + "}");
    return import.place() + ": " + import.message();
}

TEST(GltfJson, SyntaxErrorsNameLineAndColumn) {
    const Import import = import_text("{\n  \"asset\": {\"version\" \"2.0\"}\n}");
    EXPECT_EQ(import.message().substr(0, 47), "invalid JSON at line 2, column 27 (byte 29): sy");
    EXPECT_EQ(import_text("{} x").message().substr(0, 23), "invalid JSON at line 1,");
}

TEST(GltfJson, OverlongTokensAreCutInTheMessage) {
    EXPECT_LT(import_text("{\"asset\": " + std::string(100'000, 'x') + "}").message().size(), 300u);
}

TEST(GltfJson, InvalidUtf8IsRefused) {
    EXPECT_NE(import_text("{\"asset\":{\"version\":\"\xff\"}}").message().find("UTF-8"), std::string::npos);
}

TEST(GltfJson, ByteOrderMarkIsAccepted) {
    EXPECT_EQ(import_text("\xef\xbb\xbf{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{}]}")->joints.size(), 1u);
}

TEST(GltfJson, DeepNestingIsRefusedBeforeItIsParsed) {
    const std::string deep(1'000'000, '[');
    EXPECT_EQ(import_text("{\"extras\":" + deep).message().substr(0, 31), "the JSON is nested deeper than ");
}

TEST(GltfJson, NumbersThatOverflowAreRefused) {
    EXPECT_NE(error_of(R"("nodes":[{"translation":[1e400,0,0]}])").find("number overflow parsing '1e400'"),
              std::string::npos);
    EXPECT_EQ(error_of(R"("nodes":[{"translation":[0,1e39,0]}])"),
              "nodes[0].translation[1]: 1e+39 does not fit a 32-bit float");
}

TEST(GltfJson, HalfSurrogatePairsAreReplacedAndCounted) {
    const Import import = import_text(
        R"({"asset":{"version":"2.0"},"nodes":[{"name":"a\ud83db\\ud83d"},{"name":"\ude00"},{"name":"\ud83d\ude00"}]})");
    ASSERT_EQ(import->joints.size(), 3u);
    EXPECT_EQ(import->joints[0].name,
              "a\xef\xbf\xbd"
              "b\\ud83d");
    EXPECT_EQ(import->joints[1].name, "\xef\xbf\xbd");
    EXPECT_EQ(import->joints[2].name, "\xf0\x9f\x98\x80");
    EXPECT_EQ(import.warned("surrogate"), 2u);
}

TEST(GltfJson, VersionsOtherThanTwoAreRefused) {
    const auto refused = [](const std::string& asset) {
        const Import import = import_text("{\"asset\":" + asset + ",\"nodes\":[{}]}");
        return import.place() + ": " + import.message();
    };
    EXPECT_EQ(refused(R"({"version":"1.0"})"), "asset.version: glTF version '1.0' is not supported, only 2.x");
    EXPECT_EQ(refused(R"({"version":"3.0"})"), "asset.version: glTF version '3.0' is not supported, only 2.x");
    EXPECT_EQ(refused(R"({"version":2.0})"), "asset.version: it must be a string, not 2.0");
    EXPECT_EQ(refused("{}"), "asset.version: it is required and missing");
    EXPECT_EQ(refused("[]"), "asset: it must be an object, not array");
    EXPECT_EQ(refused(R"({"version":"2.1","minVersion":"2.1"})"),
              "asset.minVersion: the file demands glTF version '2.1', only 2.0 is supported");
    EXPECT_EQ(import_text("{}").place(), "asset");
    EXPECT_EQ(import_text("[]").message(), "the JSON root must be an object, not array");
    EXPECT_TRUE(import_text(R"({"asset":{"version":"2.1"},"nodes":[{}]})").result);
}

TEST(GltfJson, WrongTypesAndRangesNameTheirPlace) {
    EXPECT_EQ(error_of(R"("nodes":{})"), "nodes: it must be an array, not object");
    EXPECT_EQ(error_of(R"("nodes":[3])"), "nodes[0]: it must be an object, not 3");
    EXPECT_EQ(error_of(R"("nodes":[{"name":42}])"), "nodes[0].name: it must be a string, not 42");
    EXPECT_EQ(error_of(R"("nodes":[{"children":[1]}])"), "nodes[0].children[0]: nodes[1] does not exist (there are 1)");
    EXPECT_EQ(error_of(R"("nodes":[{"children":[-1]}])"),
              "nodes[0].children[0]: nodes[-1] does not exist (there are 1)");
    EXPECT_EQ(error_of(R"("nodes":[{"children":["0"]}])"), "nodes[0].children[0]: it must be an index, not '0'");
    EXPECT_EQ(error_of(R"("nodes":[{"matrix":[1,2,3]}])"), "nodes[0].matrix: expected 16 numbers, found 3");
    EXPECT_EQ(error_of(R"("nodes":[{"scale":[1,null,1]}])"), "nodes[0].scale[1]: expected a number, found null");
    EXPECT_EQ(error_of(R"("scene":0,"nodes":[{}])"), "scene: scenes[0] does not exist (there are 0)");
    EXPECT_EQ(error_of(R"("nodes":[{}],"meshes":[{}])"), "meshes[0].primitives: it is required and missing");
    EXPECT_EQ(error_of(R"("nodes":[{}],"meshes":[{"primitives":[{"attributes":{"POSITION":1}}]}])"),
              "meshes[0].primitives[0].attributes.POSITION: accessors[1] does not exist (there are 0)");
    EXPECT_EQ(error_of(R"("accessors":[{"componentType":5124,"type":"SCALAR","count":1}])"),
              "accessors[0].componentType: 5124 is not one of 5120|5121|5122|5123|5125|5126");
    EXPECT_EQ(error_of(R"("accessors":[{"componentType":5126,"type":"SCALAR","count":0}])"),
              "accessors[0].count: 0 is out of range");
    EXPECT_EQ(error_of(R"("skins":[{"joints":[]}],"nodes":[{}])"), "skins[0].joints: it must not be empty");
    EXPECT_EQ(error_of(R"("animations":[{"samplers":[],"channels":[{"sampler":0,"target":{"path":"scale"}}]}])"),
              "animations[0].channels[0].sampler: sampler 0 does not exist (there are 0)");
}

TEST(GltfJson, OddNamesInPlacesStayOnOneLine) {
    EXPECT_EQ(error_of(R"("meshes":[{"primitives":[{"attributes":{"A\nB":7}}]}])"),
              R"(meshes[0].primitives[0].attributes.'A\x0aB': accessors[7] does not exist (there are 0))");
}

TEST(GltfJson, IntegersMayBeWrittenAsFloats) {
    const Import import = import_text(R"({"asset":{"version":"2.0"},"nodes":[{"children":[1.0]},{"name":"child"}]})");
    ASSERT_EQ(import->joints.size(), 2u);
    EXPECT_EQ(import->joints[1].parent, 0u);
    EXPECT_EQ(error_of(R"("nodes":[{"children":[0.5]}])"), "nodes[0].children[0]: it must be an index, not 0.5");
}

TEST(GltfJson, RequiredExtensionsMustBeKnown) {
    EXPECT_EQ(error_of(R"("extensionsRequired":["KHR_mesh_quantization","ACME_magic"],"nodes":[{}])"),
              "extensionsRequired[1]: the file requires extension 'ACME_magic', which is not supported");
    EXPECT_EQ(error_of(R"("extensionsRequired":"ACME_magic","nodes":[{}])"),
              "extensionsRequired: it must be an array, not 'ACME_magic'");
}

}  // namespace
}  // namespace bendy::converter::check_json_test
