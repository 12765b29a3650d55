#include "build_gltf.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

namespace bendy::converter::buffers_test {
namespace {

using namespace test;

const std::string kMembers =
    R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":0}]}],)"
    R"("accessors":[{"bufferView":0,"componentType":5126,"count":1,"type":"VEC3"}],)"
    R"("bufferViews":[{"buffer":0,"byteLength":12}],)";

/// A .gltf of one point, whose buffer is described by `buffer`; the buffer holds the position 1 2 3.
Import import_buffer(const std::string& buffer) {
    const auto file = write_file(
        "asset.gltf", bytes_of(R"({"asset":{"version":"2.0"},)" + kMembers + "\"buffers\":[" + buffer + "]}"));
    return import_file(file);
}

const Bytes kPoint = bytes_of(std::vector<float>{1, 2, 3});

void expect_point(const Import& import) {
    ASSERT_EQ(import->meshes.size(), 1u);
    EXPECT_EQ(import->meshes[0].positions, (std::vector<glm::vec3>{{1, 2, 3}}));
}

TEST(GltfBuffers, DataUris) {
    const std::string base64 = "AACAPwAAAEAAAEBA";
    expect_point(import_buffer(R"({"byteLength":12,"uri":"data:application/octet-stream;base64,)" + base64 + "\"}"));
    expect_point(import_buffer(R"({"byteLength":12,"uri":"DATA:Application/Octet-Stream;Base64,)" + base64 + "\"}"));
    expect_point(import_buffer(R"({"byteLength":12,"uri":"data:;base64,AACAPwAA%41EAAAEBA"})"));
    expect_point(import_buffer(R"({"byteLength":12,"uri":"data:,%00%00%80%3f%00%00%00%40%00%00%40%40"})"));
    EXPECT_EQ(import_buffer(R"({"byteLength":12,"uri":"data:;base64,AA!A"})").message(),
              "data URI: character 2 of the base64 text is not in the base64 alphabet");
    EXPECT_EQ(import_buffer(R"({"byteLength":12,"uri":"data:nothing"})").message(), "data URI without a comma");
    EXPECT_EQ(import_buffer(R"({"byteLength":12,"uri":"data:,%4"})").message(),
              "data URI: '%' without two hexadecimal digits");
}

TEST(GltfBuffers, FilesBesideTheSource) {
    write_file("a b.bin", kPoint);
    write_file("sub/c.bin", kPoint);
    write_file(u8"\u2764.bin", kPoint);  // a heart
    write_file("100%.bin", kPoint);
    expect_point(import_buffer(R"({"byteLength":12,"uri":"a%20b.bin"})"));
    expect_point(import_buffer(R"({"byteLength":12,"uri":"a b.bin"})"));
    expect_point(import_buffer(R"({"byteLength":12,"uri":"sub/c.bin"})"));
    expect_point(import_buffer(R"({"byteLength":12,"uri":"sub/../sub/c.bin"})"));
    expect_point(import_buffer(R"({"byteLength":12,"uri":".\\sub\\c.bin"})"));
    expect_point(import_buffer("{\"byteLength\":12,\"uri\":\"\xe2\x9d\xa4.bin\"}"));
    expect_point(import_buffer(R"({"byteLength":12,"uri":"100%.bin"})"));
}

TEST(GltfBuffers, WhatIsNoFileBesideTheSourceIsRefused) {
    const auto refused = [](const std::string& uri) {
        const Import import = import_buffer(R"({"byteLength":12,"uri":")" + uri + "\"}");
        EXPECT_EQ(import.place(), "buffers[0].uri");
        return import.message();
    };
    EXPECT_EQ(refused("none.bin"), "file not found: 'none.bin'");
    const std::string too_long(300, 'a');
    EXPECT_EQ(refused(too_long).rfind("no file can have the name 'aaa", 0), 0u);
    EXPECT_EQ(refused("http://example.invalid/x.bin"),
              "only files beside the source and data URIs are read, not 'http://example.invalid/x.bin'");
    const auto is_outside = [&](const std::string& uri) {
        EXPECT_EQ(refused(uri),
                  "'" + uri + "' is outside the source's folder: --root FOLDER allows a folder that it is in");
    };
    for (const char* uri :
         {"file:///etc/hostname", "/etc/hostname", "../bendy_secret", "..%2fbendy_secret", "%2e%2e/x"})
        is_outside(uri);
    EXPECT_EQ(refused(""), "the URI is empty");
    std::filesystem::create_directories(test_folder() / "folder.bin");
    EXPECT_EQ(refused("folder.bin"), "not a regular file: 'folder.bin'");
}

TEST(GltfBuffers, MayBeInTheRoot) {
    const auto file = write_file("sub/asset.gltf", bytes_of(R"({"asset":{"version":"2.0"},)" + kMembers +
                                                            R"("buffers":[{"byteLength":12,"uri":"../point.bin"}]})"));
    write_file("point.bin", kPoint);
    EXPECT_EQ(import_file(file).place(), "buffers[0].uri");
    GltfOptions options;
    options.root = test_folder();
    expect_point(import_file(file, options));
    // Bytes have the folder that is in front of their name; without one, only the root.
    std::ifstream stream(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    Report report;
    EXPECT_TRUE(import_gltf(bytes_of(text), file, options, report));
    const auto piped = import_gltf(bytes_of(text), "asset.gltf", {}, report);
    ASSERT_FALSE(piped);
    EXPECT_EQ(piped.error().message,
              "the source has no folder in which to look for '../point.bin': --root FOLDER gives it one");
}

TEST(GltfBuffers, MustHoldTheirByteLength) {
    write_file("short.bin", Bytes(8));
    const Import import = import_buffer(R"({"byteLength":12,"uri":"short.bin"})");
    EXPECT_EQ(import.place(), "buffers[0].byteLength");
    EXPECT_EQ(import.message(), "expected 12 bytes, found only 8");
}

TEST(GltfBuffers, WithoutDataAreAnErrorOnlyWhenRead) {
    const Import import = import_buffer(R"({"byteLength":12})");
    EXPECT_EQ(import.place(), "buffers[0]");
    EXPECT_EQ(import.message(), "it has no data (read by bufferViews[0])");
    Gltf gltf = make_triangle();
    Json root = gltf.json;
    root["buffers"] = {{{"byteLength", gltf.buffer().size()}}, {{"byteLength", 100}}};
    EXPECT_TRUE(
        import_bytes(make_glb({{"JSON", bytes_of(root.dump())}, {std::string("BIN\0", 4), gltf.buffer()}})).result);
}

TEST(GltfBuffers, ViewsMustLieInTheirBuffer) {
    const auto place_of = [](const char* member, const Json& value) {
        Gltf gltf = make_triangle();
        gltf.json["bufferViews"][0][member] = value;
        const Import import = gltf.import();
        return import.place();
    };
    EXPECT_EQ(place_of("byteLength", 37), "bufferViews[0]");
    EXPECT_EQ(place_of("byteOffset", 4), "bufferViews[0]");
    EXPECT_EQ(place_of("byteOffset", 4294967292u), "bufferViews[0]");
    EXPECT_EQ(place_of("byteOffset", -4), "bufferViews[0].byteOffset");
    EXPECT_EQ(place_of("byteLength", 1e300), "bufferViews[0].byteLength");
    EXPECT_EQ(place_of("buffer", 1), "bufferViews[0].buffer");
}

}  // namespace
}  // namespace bendy::converter::buffers_test
