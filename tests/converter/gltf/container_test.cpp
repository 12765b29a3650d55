#include "build_gltf.h"

#include <gtest/gtest.h>

namespace bendy::converter::container_test {
namespace {

using namespace test;

const std::string kJson = R"({"asset":{"version":"2.0"},"nodes":[{"name":"a"}]})";

std::string message_of(const Bytes& bytes) {
    const Import import = import_bytes(bytes);
    EXPECT_EQ(import.place(), "");
    return import.message();
}

TEST(GltfContainer, IsToldByContentNotByName) {
    EXPECT_EQ(import_file(write_file("asset.glb", bytes_of(kJson)))->joints.size(), 1u);
    EXPECT_EQ(import_file(write_file("asset.gltf", make_glb({{"JSON", bytes_of(kJson)}})))->joints.size(), 1u);
}

TEST(GltfContainer, UnknownChunksAreSkipped) {
    const Bytes junk(8);
    EXPECT_EQ(import_bytes(make_glb({{"JSON", bytes_of(kJson)}, {"ACME", junk}}))->joints.size(), 1u);
}

TEST(GltfContainer, BytesAfterTheGlbAreIgnored) {
    Bytes glb = make_glb({{"JSON", bytes_of(kJson)}});
    glb.resize(glb.size() + 5);
    EXPECT_EQ(import_bytes(glb)->joints.size(), 1u);
}

TEST(GltfContainer, JsonMayBePaddedWithZeros) {
    EXPECT_EQ(import_bytes(make_glb({{"JSON", bytes_of(kJson + std::string(3, '\0'))}}))->joints.size(), 1u);
}

TEST(GltfContainer, EveryPrefixIsRefused) {
    const Bytes glb = make_triangle().glb();
    for (std::size_t size = 0; size < glb.size(); ++size) {
        EXPECT_FALSE(import_bytes(Bytes(glb.begin(), glb.begin() + static_cast<std::ptrdiff_t>(size))).result) << size;
    }
}

TEST(GltfContainer, ErrorsSayWhatIsWrong) {
    EXPECT_EQ(message_of({}), "the file is empty");
    EXPECT_EQ(message_of(bytes_of("glTF")), "the GLB header is truncated: expected 12 bytes, found 4");

    Bytes old_version = make_glb({{"JSON", bytes_of(kJson)}});
    old_version[4] = std::byte{1};
    EXPECT_EQ(message_of(old_version), "GLB container version 1 is not supported, only version 2 (glTF 2.0)");

    Bytes truncated = make_glb({{"JSON", bytes_of(kJson)}});
    const auto whole = std::to_string(truncated.size());
    truncated.pop_back();
    EXPECT_EQ(message_of(truncated),
              "GLB truncated: its header says " + whole + " bytes, the file has " + std::to_string(truncated.size()));

    Bytes overrun = make_glb({{"JSON", bytes_of(kJson)}});
    overrun[15] = std::byte{0xff};
    EXPECT_NE(message_of(overrun).find("GLB chunk 0 at byte 12: it says "), std::string::npos);

    Bytes cut_header = make_glb({{"JSON", bytes_of(kJson)}});
    cut_header.resize(cut_header.size() + 4);
    cut_header[8] = static_cast<std::byte>(cut_header.size());
    EXPECT_EQ(message_of(cut_header),
              "GLB chunk 1 at byte " + std::to_string(cut_header.size() - 4) + ": its header is truncated");

    EXPECT_EQ(message_of(make_glb({{"ACME", Bytes(4)}})), "GLB chunk 0 at byte 12: the first chunk is not JSON");
    EXPECT_EQ(message_of(make_glb({})), "GLB without a JSON chunk");
    EXPECT_EQ(message_of(bytes_of("\x89PNG\r\n\x1a\n")),
              "not a glTF file: it starts with neither 'glTF' (GLB) nor a JSON object, but with "
              "'\x89PNG\\x0d\\x0a\\x1a\\x0a'");
}

TEST(GltfContainer, FilesThatCannotBeReadAreRefused) {
    EXPECT_EQ(import_file(test_folder() / "none.glb").message(), "file not found: 'none.glb'");
    EXPECT_EQ(import_file(test_folder()).message().substr(0, 18), "not a regular file");
}

}  // namespace
}  // namespace bendy::converter::container_test
