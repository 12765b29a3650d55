#include <bendy/converter/build_chunks.h>
#include <bendy/converter/import.h>
#include <bendy/format/document.h>

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace bendy::converter::import_x_test {
namespace {

const std::string kHeader = "xof 0303txt 0032\n";

struct Read {
    Scene scene;
    Report report;
    std::string fault;  ///< place: message
};

Read read(const std::string& file) {
    Read read;
    auto scene = import_x(file, "nowhere/file.x", {.embed_images = false}, read.report);
    if (scene) {
        read.scene = *std::move(scene);
    } else {
        read.fault = scene.error().place + ": " + scene.error().message;
    }
    return read;
}

Read read_good(const std::string& file) {
    Read result = read(file);
    EXPECT_EQ(result.fault, "");
    if (result.fault.empty()) {
        Report unheard;
        EXPECT_TRUE(validate(build_chunks(result.scene, "test", unheard)).empty());
    }
    return result;
}

std::string fault_of(const std::string& body) {
    return read(kHeader + body).fault;
}

std::vector<std::string> warnings_of(const Read& read) {
    std::vector<std::string> lines;
    for (const Warning& warning : read.report.warnings()) lines.push_back(warning.first_place + ": " + warning.message);
    return lines;
}

const std::string kSquare = R"(Mesh Square {
 4; 0;0;1;, 1;0;1;, 1;1;1;, 0;1;1;;
 1; 4;0,3,2,1;;
)";

TEST(ImportX, FramesBecomeJointsMirroredAlongZ) {
    const Read file = read_good(kHeader + R"(
Frame Root { FrameTransformMatrix { 1,0,0,0, 0,1,0,0, 0,0,1,0, 1,2,3,1;; }
  Frame Arm { FrameTransformMatrix { 2,0,0,0, 0,3,0,0, 0,0,4,0, 0,0,-5,1;; } }
  Frame { }
}
Frame Second { })");
    ASSERT_EQ(file.scene.joints.size(), 4u);
    EXPECT_EQ(file.scene.joints[0].name, "Root");
    EXPECT_EQ(file.scene.joints[0].parent, kNone);
    EXPECT_EQ(file.scene.joints[0].rest.translation, glm::vec3(1, 2, -3));
    EXPECT_EQ(file.scene.joints[1].parent, 0u);
    EXPECT_EQ(file.scene.joints[1].rest.translation, glm::vec3(0, 0, 5));
    EXPECT_EQ(file.scene.joints[1].rest.scale, glm::vec3(2, 3, 4));
    EXPECT_EQ(file.scene.joints[2].name, "");
    EXPECT_EQ(file.scene.joints[2].parent, 0u);
    EXPECT_EQ(file.scene.joints[3].parent, kNone);
}

/// Seen by Direct3D, clockwise from its front at smaller Z: here its front is at larger Z, and counter-clockwise.
TEST(ImportX, FacesBecomeTrianglesThatShowTheSameSide) {
    const Read file = read_good(kHeader + "Frame F {" + kSquare + "} }");
    ASSERT_EQ(file.scene.meshes.size(), 1u);
    const Mesh& mesh = file.scene.meshes[0];
    EXPECT_EQ(mesh.joint, 0u);
    EXPECT_EQ(mesh.positions[2], glm::vec3(1, 1, -1));
    ASSERT_EQ(mesh.submeshes.size(), 1u);
    EXPECT_EQ(mesh.submeshes[0].indices, (std::vector<std::uint32_t>{0, 2, 3, 0, 1, 2}));
    for (std::size_t i = 0; i < 6; i += 3) {
        const auto corner = [&](std::size_t k) { return mesh.positions[mesh.submeshes[0].indices[i + k]]; };
        const glm::vec3 a = corner(1) - corner(0);
        const glm::vec3 b = corner(2) - corner(0);
        EXPECT_GT(a.x * b.y - a.y * b.x, 0.0f) << "its front shows to +Z";
    }
}

TEST(ImportX, CornersWithOtherNormalsBecomeVerticesOfTheirOwn) {
    const Read file = read_good(kHeader + R"(Mesh {
 4; 0;0;0;, 1;0;0;, 1;1;0;, 0;1;0;;
 2; 3;0,1,2;, 3;0,2,3;;
 MeshNormals { 2; 0;0;1;, 0;1;0;; 2; 3;0,0,0;, 3;1,1,1;; }
 MeshTextureCoords { 4; 0;0;, 1;0;, 1;1;, 0;1;; }
 MeshVertexColors { 1; 2; 0.5;0.25;0;1;;; }
})");
    const Mesh& mesh = file.scene.meshes.at(0);
    ASSERT_EQ(mesh.positions.size(), 6u);
    EXPECT_EQ(mesh.submeshes[0].indices, (std::vector<std::uint32_t>{0, 2, 1, 3, 5, 4}));
    EXPECT_EQ(mesh.normals[0], glm::vec3(0, 0, -1));
    EXPECT_EQ(mesh.normals[3], glm::vec3(0, 1, 0));
    EXPECT_EQ(mesh.positions[4], mesh.positions[2]);  // position 2 with each normal
    EXPECT_EQ(mesh.texture_coords[0].values, (std::vector<float>{0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1}));
    EXPECT_FLOAT_EQ(mesh.colours[0].values[4 * 2 + 1], 0.050876088f);  // sRGB 0.25
    EXPECT_EQ(mesh.colours[0].values[4 * 1 + 1], 1.0f) << "a vertex of which nothing is said is white";
    EXPECT_EQ(mesh.joint, 0u) << "a mesh outside of all frames gets a joint";
    EXPECT_EQ(file.scene.joints.size(), 1u);
}

TEST(ImportX, SkinWeightsFindTheirFramesLaterInTheFile) {
    const Read file = read_good(kHeader + kSquare + R"(
 XSkinMeshHeader { 2; 2; 2; }
 SkinWeights { "Tip"; 2; 2,3; 1.0,0.25; 1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,7,1;; }
 SkinWeights { "Root"; 3; 0,1,3; 1.0,1.0,0.75; 1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1;; }
}
Frame Root { Frame Tip { } })");
    const Mesh& mesh = file.scene.meshes.at(0);
    EXPECT_EQ(mesh.palette.joints, (std::vector<std::uint32_t>{1, 0}));
    EXPECT_EQ(mesh.palette.inverse_bind[0][3], glm::vec4(0, 0, -7, 1));
    EXPECT_EQ(mesh.influences, 2u);
    EXPECT_EQ(mesh.bones, (std::vector<std::uint32_t>{1, 0, 1, 0, 0, 0, 0, 1}));
    EXPECT_EQ(mesh.weights, (std::vector<float>{1, 0, 1, 0, 1, 0, 0.25f, 0.75f}));
}

TEST(ImportX, ColoursStayFinite) {
    const Read file =
        read_good(kHeader + R"(Material Bright { 2e38;1;-3e38;1;; 0; 0;0;0;; 3.4e38;0;0;; })" + kSquare + R"(
 MeshMaterialList { 1; 1; 0; { Bright } } })");
    const Material& bright = file.scene.materials.at(0);
    EXPECT_EQ(bright.base_colour, glm::vec4(std::numeric_limits<float>::max(), 1, -3e38f, 1));
    EXPECT_EQ(bright.emissive.x, std::numeric_limits<float>::max());
    EXPECT_EQ(file.report.warnings().at(0).message, "a colour of a material is too large, the largest number is taken");
}

TEST(ImportX, MaterialsByReferenceAndInPlace) {
    const Read file = read_good(kHeader + R"(Material Red { 1;0;0;1;; 0; 0;0;0;; 0;0;0;; })" + kSquare + R"(
 MeshMaterialList { 2; 1; 1; { Red } Material { 0;1;0;0.5;; 30.0; 0;0;0;; 0.1;0.2;0.3;;
   TextureFilename { "C:\\art\\skin one.bmp"; } } } })");
    ASSERT_EQ(file.scene.materials.size(), 2u);
    EXPECT_EQ(file.scene.materials[0].name, "Red");
    const Material& green = file.scene.materials[1];
    EXPECT_EQ(green.base_colour, glm::vec4(0, 1, 0, 0.5f));
    EXPECT_FLOAT_EQ(green.emissive.x, 0.010022825f);  // sRGB 0.1, 0.2, 0.3
    EXPECT_FLOAT_EQ(green.emissive.y, 0.033104767f);
    EXPECT_FLOAT_EQ(green.emissive.z, 0.073238956f);
    EXPECT_EQ(green.emissive_texture.texture, 0u) << "Direct3D multiplies a surface's own light with its texture";
    EXPECT_EQ(file.scene.materials[0].emissive_texture.texture, kNone);
    EXPECT_EQ(green.alpha_mode, AlphaMode::blend);
    EXPECT_FLOAT_EQ(green.roughness, 0.5f);  // 2 / 0.5^4 - 2 = 30
    EXPECT_EQ(file.scene.meshes[0].submeshes[0].material, 1u);
    EXPECT_EQ(file.scene.images.at(0).uri, "skin%20one.bmp");
}

const std::string kGreen = "MeshMaterialList { 1; 1; 0; Material Green { 0;1;0;1;; 0; 0;0;0;; 0;0;0;; } } }";

TEST(ImportX, AMaterialInAMeshIsItsJointsOwn) {
    const Read file =
        read_good(kHeader + "Frame Hand { " + kSquare + kGreen + " }\nFrame Foot { " + kSquare + kGreen + " }");
    ASSERT_EQ(file.scene.materials.size(), 2u);
    EXPECT_EQ(file.scene.materials[0].joint, 0u);
    EXPECT_EQ(file.scene.materials[1].joint, 1u);
}

TEST(ImportX, AMaterialThatSeveralJointsUseIsTheFiles) {
    const std::string again = "MeshMaterialList { 1; 1; 0; { Green } } }";
    const Read two = read_good(kHeader + "Frame Hand { " + kSquare + kGreen + kSquare + again + " }");
    EXPECT_EQ(two.scene.materials.at(0).joint, 0u) << "two meshes of one joint";
    const Read other =
        read_good(kHeader + "Frame Hand { " + kSquare + kGreen + " }\nFrame Foot { " + kSquare + again + " }");
    EXPECT_EQ(other.scene.materials.at(0).joint, kNone) << "meshes of two joints";
    const Read skinned =
        read_good(kHeader + "Frame Hand { " + kSquare +
                  "SkinWeights { \"Hand\"; 4; 0,1,2,3; 1,1,1,1; 1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1;; }" + kGreen + " }");
    ASSERT_EQ(skinned.scene.meshes.at(0).influences, 1u);
    EXPECT_EQ(skinned.scene.materials.at(0).joint, kNone) << "a skin";
    const Read top = read_good(kHeader + "Material Red { 1;0;0;1;; 0; 0;0;0;; 0;0;0;; }\nFrame Hand { " + kSquare +
                               "MeshMaterialList { 1; 1; 0; { Red } } } }");
    EXPECT_EQ(top.scene.materials.at(0).joint, kNone) << "a material outside of meshes";
}

/// D3DXMatrixRotationY(90 degrees) as a matrix key, and as what D3DX puts into a file for it: w negated.
TEST(ImportX, RotationKeysTurnAsMatrixKeysDo) {
    const Read file = read_good(kHeader + R"(AnimTicksPerSecond { 100; }
Frame A { } Frame B { }
AnimationSet Turn {
 Animation { { A } AnimationKey { 0; 2; 0;4;-1,0,0,0;;, 50;4;-0.70710678,0,0.70710678,0;;; } }
 Animation { { B } AnimationKey { 4; 2; 0;16; 1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1;;, 50;16; 0,0,-1,0, 0,1,0,0, 1,0,0,0, 2,3,4,1;;; } }
})");
    ASSERT_EQ(file.scene.clips.size(), 1u);
    const Clip& clip = file.scene.clips[0];
    EXPECT_EQ(clip.name, "Turn");
    EXPECT_FALSE(clip.loop);
    const auto track = [&](std::uint32_t target, TrackPath path) -> const Track& {
        for (const Track& each : clip.tracks) {
            if (each.target == target && each.path == path) return each;
        }
        ADD_FAILURE() << "no such track";
        return clip.tracks.front();
    };
    const Track& by_quaternion = track(0, TrackPath::rotation);
    const Track& by_matrix = track(1, TrackPath::rotation);
    EXPECT_EQ(by_quaternion.times, (std::vector<float>{0.0f, 0.5f}));
    double dot = 0.0;
    for (std::size_t i = 4; i < 8; ++i) dot += double{by_quaternion.values[i]} * by_matrix.values[i];
    EXPECT_NEAR(std::abs(dot), 1.0, 1e-6);
    EXPECT_NEAR(std::abs(by_quaternion.values[5]), std::sqrt(0.5), 1e-6) << "about Y";
    const Track& moved = track(1, TrackPath::translation);
    EXPECT_EQ(std::vector<float>(moved.values.begin() + 3, moved.values.end()), (std::vector<float>{2, 3, -4}));
}

TEST(ImportX, OptionsSayThatAClipRepeats) {
    const Read file = read_good(kHeader + R"(Frame A { } AnimationSet Walk { Animation { { A }
 AnimationOptions { 0; 1; } AnimationKey { 2; 2; 0;3;0,0,0;;, 4800;3;1,2,3;;; } AnimationKey { 1; 1; 0;3;1,1,1;;; } } })");
    ASSERT_EQ(file.scene.clips.size(), 1u);
    EXPECT_TRUE(file.scene.clips[0].loop);
    ASSERT_EQ(file.scene.clips[0].tracks.size(), 1u) << "a scale that only rests is no track";
    EXPECT_EQ(file.scene.clips[0].tracks[0].times[1], 1.0f) << "4800 ticks in a second if nothing is said";
}

TEST(ImportX, QuirksOfWritersAreRead) {
    const Read file = read_good("xof 0302txt 0064\r\n// a remark { \"\r\n# another }\r\n" + std::string(R"(
template Odd { <00000000-0000-0000-0000-000000000000> array Vector a[n]; [ Binary <11> ] }
Header { 1; 0; 1; }
Unknown thing { 1; { Inner } "}"; }
Frame F:1-2.b { <22222222-2222-2222-2222-222222222222>
 Mesh m { +3; 0;0;0,, 1.5e0;0;-1.#IND00; .5;1.;0 ;; 1 3 0 1 2 } }
)"));
    ASSERT_EQ(file.scene.meshes.size(), 1u);
    EXPECT_EQ(file.scene.joints[0].name, "F:1-2.b");
    EXPECT_EQ(file.scene.meshes[0].positions[1], glm::vec3(1.5f, 0, 0));
    EXPECT_EQ(warnings_of(file),
              (std::vector<std::string>{"line 7, column 1: data object of type 'Unknown' left out",
                                        "line 9, column 31: a value that is not a number is taken as 0"}));
}

TEST(ImportX, NamesThatAreNotUtf8AreTakenForLatin1) {
    const Read file = read_good(kHeader + "Frame K\xf6rper { }");
    EXPECT_EQ(file.scene.joints[0].name, "K\xc3\xb6rper");
    EXPECT_EQ(warnings_of(file),
              (std::vector<std::string>{"line 2, column 1: a name is not UTF-8: its bytes are taken for Latin-1"}));
}

TEST(ImportX, FaultsHaveTheirPlaces) {
    EXPECT_EQ(fault_of(""), ": there is nothing to convert: the file has neither frames nor meshes");
    EXPECT_EQ(fault_of("Frame A {"), "line 2, column 10: the file ends inside a Frame");
    EXPECT_EQ(fault_of("}"), "line 2, column 1: there is a '}' without a '{'");
    EXPECT_EQ(fault_of("Frame A ; B"), "line 2, column 11: expected '{', found 'B'");
    EXPECT_EQ(fault_of("Frame A {\n FrameTransformMatrix { 1,0,x"), "line 3, column 29: expected a number, found 'x'");
    EXPECT_EQ(fault_of("Frame A { FrameTransformMatrix { 1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1;; } }"),
              "line 2, column 1: the last column of its matrix is not 0 0 0 1: not an affine transform");
    EXPECT_EQ(fault_of("Mesh { 4000000000; 1;2;3;"),
              "line 2, column 8: 4000000000 vertices do not fit into what remains of the file");
    EXPECT_EQ(fault_of("Mesh { -1;"), "line 2, column 8: expected a whole number of 32 bits, found '-1'");
    EXPECT_EQ(fault_of("Mesh { 1; 1e39;0;0;; 0; }"), "line 2, column 11: the number is not finite");
    EXPECT_EQ(fault_of("Mesh { 1; 0;0;0;; 1; 3;0,1,0;; }"),
              "line 2, column 26: index 1 is out of range: there are 1 vertices");
    EXPECT_EQ(fault_of(kSquare + "MeshNormals { 1; 0;0;1;; 2; 3;0,0,0;; } }"),
              "line 5, column 26: expected 1 faces of normals, found 2");
    EXPECT_EQ(fault_of(kSquare + "MeshMaterialList { 2; 1; 0; } }"),
              "line 5, column 29: the list that begins at line 5, column 1 has 0 materials, but says 2");
    EXPECT_EQ(fault_of("AnimationSet { Animation { AnimationKey { 7;"), "line 2, column 43: unknown key type 7");
    EXPECT_EQ(
        fault_of("Frame A { } AnimationSet { Animation { {A} AnimationKey { 2; 2; 5;3;0,0,0;;, 4;3;0,0,0;;; } } }"),
        "line 2, column 28: key 1: key times must increase");
    for (const char* rate : {"0", "-30", "4294967266"}) {  // the last is -30 without a sign
        EXPECT_EQ(fault_of("AnimTicksPerSecond { " + std::string(rate) + "; } Frame A { }"),
                  "line 2, column 22: AnimTicksPerSecond must be above 0; --ticks-per-second sets the rate in place of "
                  "the file's");
    }
    EXPECT_EQ(fault_of("Frame A { \"open"), "line 2, column 11: a string is not ended");
    EXPECT_EQ(fault_of("Odd {{{"), "line 2, column 1: the file ends inside this data object");
}

TEST(ImportX, OtherVariantsAreRefusedByName) {
    EXPECT_EQ(read("<xml>").fault, ": this is not an X-file: it does not begin with 'xof ', but with '<xml'");
    EXPECT_EQ(read("xof 03").fault, ": the X-file's header is truncated: expected 16 bytes, found 6");
    EXPECT_EQ(read("xof 0303txt 0016abc").fault,
              ": the X-file's floats have an unknown size '0016': 0032 and 0064 are read");
    EXPECT_EQ(read("xof 0303foo 0032abc").fault,
              ": the X-file is of an unknown variant 'foo ': txt, bin, tzip and bzip are read");
}

/// As MSZIP: blocks that each know what the one before has, behind the whole file's size.
std::string compressed(const std::string& file, const std::string& variant, std::size_t block_size = 32'768) {
    std::string packed = file.substr(0, 8) + variant + file.substr(12, 4);
    const auto put = [&](std::size_t number, int bytes) {
        for (int i = 0; i < bytes; ++i) packed += static_cast<char>(number >> (8 * i) & 255u);
    };
    put(file.size(), 4);
    for (std::size_t at = 16; at < file.size(); at += block_size) {
        std::string block = file.substr(at, block_size);
        std::string before = file.substr(16, at - 16);
        before.erase(0, before.size() - std::min<std::size_t>(before.size(), 32'768));
        z_stream stream{};
        deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 9, Z_DEFAULT_STRATEGY);
        deflateSetDictionary(&stream, reinterpret_cast<Bytef*>(before.data()), static_cast<uInt>(before.size()));
        std::string out(block.size() + 1000, '\0');
        stream.next_in = reinterpret_cast<Bytef*>(block.data());
        stream.avail_in = static_cast<uInt>(block.size());
        stream.next_out = reinterpret_cast<Bytef*>(out.data());
        stream.avail_out = static_cast<uInt>(out.size());
        EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
        out.resize(out.size() - stream.avail_out);
        deflateEnd(&stream);
        put(block.size(), 2);
        put(out.size() + 2, 2);
        packed += "CK" + out;
    }
    return packed;
}

std::string long_file() {
    std::string file = "xof 0303txt 0032\n";
    for (int i = 0; i < 5000; ++i)
        file += "Frame Joint" + std::to_string(i * 7919 % 5003) + " { " + std::string(i % 3 == 0 ? "Frame { } " : "") +
                "}\n";
    return file;
}

TEST(ImportX, CompressedFilesAreThePlainOnes) {
    const std::string file = long_file();
    ASSERT_GT(file.size(), 3u * 32'768);
    const Read plain = read_good(file);
    for (const std::size_t block_size : {32'768u, 10'000u}) {
        const Read packed = read_good(compressed(file, "tzip", block_size));
        ASSERT_EQ(packed.scene.joints.size(), plain.scene.joints.size());
        for (std::size_t joint = 0; joint < plain.scene.joints.size(); ++joint)
            ASSERT_EQ(packed.scene.joints[joint].name, plain.scene.joints[joint].name);
    }
}

TEST(ImportX, DamagedCompressedFilesAreRefusedWithTheirPlace) {
    const std::string file = compressed(kHeader + "Frame A { }", "tzip");
    EXPECT_EQ(read(file).fault, "");
    for (std::size_t size = 16; size < file.size(); ++size)
        EXPECT_TRUE(read(file.substr(0, size)).fault.starts_with("byte ")) << size;
    for (std::size_t at = 20; at < file.size(); ++at) {
        for (unsigned bit = 0; bit < 8; ++bit) {
            std::string damaged = file;
            damaged[at] = static_cast<char>(damaged[at] ^ (1 << bit));
            read(damaged);  // neither a crash nor a sanitizer's report
        }
    }
    EXPECT_EQ(read("xof 0303tzip0032abc").fault, "byte 16: expected the size of the data, found the end of the file");
    std::string broken = file;
    broken[24] = 'X';
    EXPECT_EQ(read(broken).fault, "byte 20: expected a compressed block that begins with CK");
    // What it says is much more than it holds.
    std::string greedy = file;
    greedy.replace(16, 4, "\xff\xff\xff\xff");
    EXPECT_NE(read(greedy).fault.find("expected a compressed block, found the end of the file"), std::string::npos);
}

std::string word(float number) {
    return std::to_string(std::bit_cast<std::uint32_t>(number)) + ", ";
}

/// Normals, coordinates and colours of four vertices, as Direct3D 9 exporters write them.
std::string declared(const std::string& more_elements = "", const std::string& more_words = "", int elements = 3) {
    std::string data;
    for (int vertex = 0; vertex < 4; ++vertex) {
        data += word(0) + word(0.6f) + word(-0.8f) + word(0.25f * static_cast<float>(vertex)) + word(1.5f);
        data += std::to_string(0x80ff4000u) + ", " + more_words;
    }
    data.resize(data.size() - 2);
    const int words = 4 * (6 + static_cast<int>(std::count(more_words.begin(), more_words.end(), ',')));
    return "DeclData { " + std::to_string(elements) + "; 2;0;3;0;, 1;0;5;0;, 4;0;10;0;" + more_elements + "; " +
           std::to_string(words) + "; " + data + ";; }";
}

TEST(ImportX, DeclDataHoldsNormalsCoordinatesAndColours) {
    const Read file = read_good(kHeader + kSquare + declared() + " }");
    ASSERT_EQ(file.scene.meshes.size(), 1u);
    const Mesh& mesh = file.scene.meshes[0];
    ASSERT_EQ(mesh.normals.size(), 4u);
    EXPECT_EQ(mesh.normals[2], glm::vec3(0.0f, 0.6f, 0.8f));
    ASSERT_EQ(mesh.texture_coords.size(), 1u);
    EXPECT_EQ(mesh.texture_coords[0].values, (std::vector<float>{0, 1.5f, 0.25f, 1.5f, 0.5f, 1.5f, 0.75f, 1.5f}));
    ASSERT_EQ(mesh.colours.size(), 1u);
    EXPECT_FLOAT_EQ(mesh.colours[0].values[3], 128.0f / 255.0f);
    EXPECT_FLOAT_EQ(mesh.colours[0].values[1], 0.051269463f);  // sRGB 64 / 255
    EXPECT_EQ(mesh.colours[0].values[2], 0.0f);
    EXPECT_TRUE(file.report.warnings().empty());
}

TEST(ImportX, WhatElseADeclDataHasIsNamed) {
    const Read file = read_good(kHeader + kSquare + declared(", 2;0;6;0;", word(1) + word(0) + word(0), 4) + " }");
    EXPECT_EQ(file.scene.meshes.at(0).normals.size(), 4u);
    EXPECT_EQ(warnings_of(file),
              (std::vector<std::string>{"line 5, column 1: tangents of a DeclData left out (usage 6, set 0)"}));
    const Read twice = read_good(kHeader + kSquare + declared(", 2;0;3;0;", word(1) + word(0) + word(0), 4) + " }");
    EXPECT_EQ(twice.scene.meshes.at(0).normals.at(0), glm::vec3(0.0f, 0.6f, 0.8f));
    EXPECT_EQ(twice.report.warnings().size(), 1u);
}

TEST(ImportX, ADeclDataOfAnotherSizeIsRefused) {
    EXPECT_EQ(fault_of(kSquare + "DeclData { 1; 2;0;3;0;; 3; 0,0,0;; } }"),
              "line 5, column 25: expected 3 words for each of 4 vertices, found 3");
    EXPECT_EQ(fault_of(kSquare + "DeclData { 1; 99;0;3;0;; 3; 0,0,0;; } }"),
              "line 5, column 15: unknown vertex element type 99");
    EXPECT_EQ(fault_of(kSquare + "DeclData { 1; 2;0;3;0;; 12; 2143289344,0,0,0,0,0,0,0,0,0,0,0;; } }"),
              "line 5, column 60: a number of a vertex is not finite");
}

const std::string kWalk = R"(Frame A { } AnimationSet Walk { Animation { { A }
 AnimationKey { 2; 2; 0;3;0,0,0;;, 480;3;1,2,3;;; } } })";

TEST(ImportX, AMissingRateIsNamedAndCanBeSet) {
    const Read assumed = read_good(kHeader + kWalk);
    EXPECT_EQ(assumed.scene.clips.at(0).tracks.at(0).times.at(1), 0.1f);
    EXPECT_EQ(warnings_of(assumed),
              (std::vector<std::string>{
                  ": AnimTicksPerSecond is missing: 4,800 ticks a second are assumed, as DirectX does, so that the "
                  "last key is at 0.1 s; --ticks-per-second sets another rate"}));
    for (const char* rate :
         {"", "AnimTicksPerSecond { 4800; }\n", "AnimTicksPerSecond { 0; }\n", "AnimTicksPerSecond { -25; }\n"}) {
        Report report;
        const auto set = import_x(kHeader + rate + kWalk, "walk.x", {.ticks_per_second = 24.0}, report);
        ASSERT_TRUE(set);
        EXPECT_EQ(set->clips.at(0).tracks.at(0).times.at(1), 20.0f);
        EXPECT_TRUE(report.warnings().empty());
    }
    EXPECT_TRUE(read_good(kHeader + "AnimTicksPerSecond { 4800; }" + kWalk).report.warnings().empty());
    EXPECT_TRUE(read_good(kHeader + kSquare + "}").report.warnings().empty());
}

TEST(ImportX, KeysThatWouldEndAtOnceAreFrames) {
    std::string walk = kWalk;
    walk.replace(walk.find("480"), 3, "479");
    const Read counted = read_good(kHeader + walk);
    EXPECT_EQ(counted.scene.clips.at(0).tracks.at(0).times.at(1), 479.0f / 30.0f);
    EXPECT_EQ(warnings_of(counted),
              (std::vector<std::string>{
                  ": AnimTicksPerSecond is missing, and with DirectX's 4,800 ticks a second the last key would be at "
                  "0.0998 s: keys are taken as frames, 30 a second; --ticks-per-second sets another rate"}));
}

/// A file whose frame A, of that matrix, turns and stays the same.
std::string turning(const std::string& matrix) {
    return kHeader + "Frame A { FrameTransformMatrix { " + matrix + ";; } }\n" +
           "AnimTicksPerSecond { 30; } AnimationSet { Animation { { A } AnimationKey { 4; 2; 0;16;" + matrix +
           ";;, 30;16;" + matrix + ";;; } } }";
}

TEST(ImportX, RotationsOfSixDigitsHaveNoShear) {
    const Read turned =
        read_good(turning("0.813019,0.511292,-0.278534,0.000000,-0.453759,0.856168,0.247141,0.000000,"
                          "0.364833,-0.074543,0.928084,0.000000,0.000000,1.000000,0.000000,1.000000"));
    EXPECT_EQ(turned.scene.joints.at(0).rest.shear, glm::vec3(0));
    EXPECT_TRUE(turned.report.warnings().empty());
    const Read sheared = read_good(turning("1,0,0,0, 0.001,1,0,0, 0,0,1,0, 0,1,0,1"));
    EXPECT_EQ(sheared.scene.joints.at(0).rest.shear, glm::vec3(0.001f, 0, 0));
    EXPECT_EQ(warnings_of(sheared).size(), 1u);
}

TEST(ImportX, WhatNamesNothingIsLeftOutAndNamed) {
    const Read file = read_good(kHeader + "Frame Here { }\n" + kSquare + R"(
MeshMaterialList { 1; 1; 0; { None } }
SkinWeights { "Gone"; 1; 0; 1; 1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1;; }
SkinWeights { "Here"; 4; 0,1,2,3; 1,1,1,1; 1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1;; } }
AnimTicksPerSecond { 10; }
AnimationSet { Animation { { Away } AnimationKey { 2; 1; 5;3;0,0,0;;; } } })");
    ASSERT_EQ(file.scene.meshes.size(), 1u);
    EXPECT_EQ(file.scene.meshes[0].palette.joints, (std::vector<std::uint32_t>{0}));
    EXPECT_EQ(file.scene.meshes[0].submeshes.at(0).material, kNone);
    EXPECT_EQ(warnings_of(file),
              (std::vector<std::string>{"line 11, column 16: animation left out: its frame 'Away' does not exist",
                                        "line 7, column 29: faces are left without a material: 'None' does not exist",
                                        "line 8, column 1: SkinWeights left out: their frame 'Gone' does not exist"}));
}

/// Writes the binary variant's tokens.
class Binary {
public:
    explicit Binary(bool is_double)
        : is_double_(is_double), bytes_(is_double ? "xof 0303bin 0064" : "xof 0303bin 0032") {}
    Binary& name(const std::string& text) { return put(1, 2).put(text.size(), 4).append(text); }
    Binary& string(const std::string& text) { return put(2, 2).put(text.size(), 4).append(text).put(20, 2); }
    Binary& open() { return put(10, 2); }
    Binary& close() { return put(11, 2); }
    Binary& integer(std::uint32_t number) { return put(3, 2).put(number, 4); }
    Binary& integers(const std::vector<std::uint32_t>& numbers) {
        put(6, 2).put(numbers.size(), 4);
        for (const std::uint32_t number : numbers) put(number, 4);
        return *this;
    }
    Binary& floats(const std::vector<double>& numbers) {
        put(7, 2).put(numbers.size(), 4);
        for (const double number : numbers) {
            if (is_double_) {
                put(std::bit_cast<std::uint64_t>(number), 8);
            } else {
                put(std::bit_cast<std::uint32_t>(static_cast<float>(number)), 4);
            }
        }
        return *this;
    }
    [[nodiscard]] const std::string& bytes() const { return bytes_; }

private:
    Binary& put(std::uint64_t number, int size) {
        for (int i = 0; i < size; ++i) bytes_ += static_cast<char>(number >> (8 * i));
        return *this;
    }
    Binary& append(const std::string& text) {
        bytes_ += text;
        return *this;
    }

    bool is_double_;
    std::string bytes_;
};

TEST(ImportX, BinaryFilesSayTheSame) {
    for (const bool is_double : {false, true}) {
        Binary file(is_double);
        file.name("Frame").name("F").open();
        file.name("FrameTransformMatrix").open();
        file.floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1}).close();
        file.name("Mesh").open().integer(3).floats({0, 0, 0, 1, 0, 0, 0, 1, 0.5}).integers({1, 3, 0, 1, 2});
        file.name("MeshMaterialList").open().integers({1, 1, 0}).name("Material").name("M").open();
        file.floats({1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0});
        file.name("TextureFilename").open().string("a.png").close().close().close().close().close();
        const Read scene = read_good(file.bytes());
        ASSERT_EQ(scene.scene.meshes.size(), 1u);
        EXPECT_EQ(scene.scene.joints[0].rest.translation, glm::vec3(1, 2, -3));
        EXPECT_EQ(scene.scene.meshes[0].positions[2], glm::vec3(0, 1, -0.5f));
        EXPECT_EQ(scene.scene.images.at(0).uri, "a.png");
    }
    Binary cut(false);
    cut.name("Mesh").open().integers({1, 2, 3});
    EXPECT_EQ(read(cut.bytes().substr(0, cut.bytes().size() - 4)).fault,
              "byte 28: a list of 3 numbers does not fit into the file");
    EXPECT_EQ(read(std::string("xof 0303bin 0032\x63\0", 18)).fault, "byte 16: unknown token number 99");
}

TEST(ImportX, DeepAndWideFilesTakeTimeLinearInTheirSize) {
    std::string deep = kHeader;
    for (int i = 0; i < 60'000; ++i) deep += "Frame f{";
    deep += std::string(60'000, '}');
    EXPECT_EQ(read(deep).scene.joints.size(), 60'000u);
    std::string wide = kHeader;
    for (int i = 0; i < 65'001; ++i) wide += "Frame f{}";
    EXPECT_NE(read(wide).fault.find("there are more than 65000 frames"), std::string::npos);
    EXPECT_NE(read(kHeader + "Odd " + std::string(200'000, '{')).fault, "");
}

TEST(ImportX, EveryPrefixIsAnErrorOrAFile) {
    const std::string file = kHeader + R"(Frame A { FrameTransformMatrix { 1,0,0,0,0,1,0,0,0,0,1,0,1,2,3,1;; } )" +
                             kSquare +
                             R"(SkinWeights { "A"; 1; 0; 1; 1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1;; } } }
AnimationSet S { Animation { {A} AnimationKey { 0; 1; 0;4;-1,0,0,0;;; } } })";
    for (std::size_t size = 0; size < file.size(); ++size) {
        const Read part = read(file.substr(0, size));
        EXPECT_TRUE(!part.fault.empty() || !part.scene.joints.empty()) << size;
    }
}

}  // namespace
}  // namespace bendy::converter::import_x_test
