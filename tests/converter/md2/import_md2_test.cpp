#include "formats/md2/quake2.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/import.h>
#include <bendy/format/document.h>

#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bendy::converter::import_md2_test {
namespace {

/// Makes a model: a square of two triangles that lies in front, seen from +X; each frame one unit further up.
class Model {
public:
    explicit Model(std::vector<std::string> names) : names_(std::move(names)) {}

    std::vector<std::byte> bytes() {
        const std::uint32_t frame_size = 40 + 4 * 4;
        const auto frames = static_cast<std::uint32_t>(names_.size());
        const std::uint32_t coords_at = 68 + 64;
        const std::uint32_t triangles_at = coords_at + 4 * 4;
        const std::uint32_t frames_at = triangles_at + 2 * 12;
        const std::uint32_t commands_at = frames_at + frames * frame_size;
        for (const std::uint32_t field : {0x32504449u, 8u, 64u, 32u, frame_size, 1u, 4u, 4u, 2u, 1u, frames, 68u,
                                          coords_at, triangles_at, frames_at, commands_at, commands_at + 4})
            put(field, 4);
        text("models/man.pcx", 64);
        for (const std::array<std::uint32_t, 2> st : {std::array{0u, 32u}, {32u, 32u}, {32u, 0u}, {0u, 0u}}) {
            put(st[0], 2);
            put(st[1], 2);
        }
        // Clockwise for who looks at it from +X, where Y points to the right and Z up.
        for (const std::uint32_t index : {0u, 1u, 2u, 0u, 1u, 2u, 0u, 2u, 3u, 0u, 2u, 3u}) put(index, 2);
        for (std::uint32_t frame = 0; frame < frames; ++frame) {
            for (const float number : {0.5f, 0.25f, 2.0f, 1.0f, -1.0f, static_cast<float>(frame)})
                put(std::bit_cast<std::uint32_t>(number), 4);
            text(names_[frame], 16);
            // Below at Y = 1 and -1, above at Y = -1 and 1.
            for (const std::array<std::uint32_t, 4> vertex :
                 {std::array{0u, 8u, 0u, 5u}, {0u, 0u, 0u, 5u}, {0u, 0u, 1u, 5u}, {0u, 8u, 1u, 5u}}) {
                for (const std::uint32_t byte : vertex) put(byte, 1);
            }
        }
        put(0, 4);
        return std::move(bytes_);
    }

private:
    void put(std::uint32_t number, int size) {
        for (int i = 0; i < size; ++i) bytes_.push_back(static_cast<std::byte>(number >> (8 * i)));
    }
    void text(const std::string& text, std::size_t size) {
        for (std::size_t i = 0; i < size; ++i)
            bytes_.push_back(i < text.size() ? static_cast<std::byte>(text[i]) : std::byte{0});
    }

    std::vector<std::string> names_;
    std::vector<std::byte> bytes_;
};

std::string fault_of(const std::vector<std::byte>& bytes) {
    Report report;
    const auto scene = import_md2(bytes, "man.md2", {}, report);
    if (scene) return "";
    return scene.error().place + ": " + scene.error().message;
}

/// A good model with one field of its bytes changed.
std::string fault_with(std::size_t at, std::uint32_t value, std::size_t size = 4) {
    std::vector<std::byte> bytes = Model({"stand01", "stand02"}).bytes();
    for (std::size_t i = 0; i < size; ++i) bytes.at(at + i) = static_cast<std::byte>(value >> (8 * i));
    return fault_of(bytes);
}

Scene import_good(std::vector<std::string> names, Report& report) {
    auto scene = import_md2(Model(std::move(names)).bytes(), "man.md2", {}, report);
    EXPECT_TRUE(scene) << (scene ? "" : scene.error().place + ": " + scene.error().message);
    if (!scene) return {};
    Report unheard;
    EXPECT_TRUE(validate(build_chunks(*scene, "test", unheard)).empty());
    return *std::move(scene);
}

TEST(ImportMd2, FramesBecomeTargetsAndClips) {
    Report report;
    const Scene scene = import_good({"stand01", "stand02", "stand03", "run1"}, report);
    ASSERT_EQ(scene.joints.size(), 1u);
    EXPECT_EQ(scene.joints[0].name, "man");
    ASSERT_EQ(scene.meshes.size(), 1u);
    const Mesh& mesh = scene.meshes[0];
    ASSERT_EQ(mesh.positions.size(), 4u);
    ASSERT_EQ(mesh.targets.size(), 3u);
    EXPECT_EQ(mesh.targets[0].name, "stand02");
    EXPECT_EQ(mesh.targets[2].name, "run1");
    for (std::size_t target = 0; target < 3; ++target) {
        EXPECT_TRUE(mesh.targets[target].is_frame);
        for (std::size_t v = 0; v < 4; ++v) {
            EXPECT_EQ(mesh.targets[target].positions[v],
                      mesh.positions[v] + glm::vec3(0.0f, static_cast<float>(target + 1) / 32.0f, 0.0f))
                << "Z up is Y up here";
        }
    }
    ASSERT_EQ(scene.clips.size(), 2u);
    EXPECT_EQ(scene.clips[0].name, "stand");
    EXPECT_TRUE(scene.clips[0].loop);
    EXPECT_TRUE(scene.clips[0].tracks.empty());
    EXPECT_EQ(scene.clips[0].frame_rate, 10.0f);
    const Play& stand = scene.clips[0].plays.at(0);
    EXPECT_EQ(stand.first, 0u);
    EXPECT_EQ(stand.frames, 3u);
    EXPECT_TRUE(stand.closed);
    EXPECT_EQ(scene.clips[1].name, "run");
    EXPECT_EQ(scene.clips[1].plays.at(0).first, 3u);
}

TEST(ImportMd2, WhatIsStoredComesBackToTheBit) {
    Report report;
    const Scene scene = import_good({"stand01", "stand02", "stand03", "death101"}, report);
    const std::vector<std::byte> bytes = build_chunks(scene, "test", report);
    const auto again = import_bendy(bytes, report);
    ASSERT_TRUE(again);
    const Mesh& here = scene.meshes[0];
    const Mesh& there = again->meshes.at(0);
    EXPECT_EQ(here.positions, there.positions);
    EXPECT_EQ(here.normals, there.normals);
    ASSERT_EQ(there.targets.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(here.targets[k].positions, there.targets[k].positions) << k;
        EXPECT_EQ(here.targets[k].normals, there.targets[k].normals) << k;
        EXPECT_EQ(here.targets[k].name, there.targets[k].name) << k;
    }
    EXPECT_FALSE(again->clips.at(1).plays.at(0).closed) << "one dies once";
    EXPECT_EQ(build_chunks(*again, "test", report), bytes);
}

TEST(ImportMd2, TheTableOfNormals) {
    const std::vector<glm::vec3> normals = md2::quake_normals();
    ASSERT_EQ(normals.size(), md2::kNormals);
    // Some of those that Quake II's sources list, to their six digits.
    const std::vector<std::pair<std::size_t, glm::vec3>> known{{0, {-0.525731f, 0.0f, 0.850651f}},
                                                               {1, {-0.442863f, 0.238856f, 0.864188f}},
                                                               {2, {-0.295242f, 0.0f, 0.955423f}},
                                                               {5, {0.0f, 0.0f, 1.0f}},
                                                               {9, {0.0f, 0.525731f, 0.850651f}},
                                                               {32, {0.0f, 1.0f, 0.0f}},
                                                               {52, {1.0f, 0.0f, 0.0f}},
                                                               {84, {0.0f, 0.0f, -1.0f}},
                                                               {100, {0.716567f, -0.681718f, -0.147621f}},
                                                               {104, {0.0f, -1.0f, 0.0f}},
                                                               {126, {-0.681718f, -0.147621f, 0.716567f}},
                                                               {143, {-1.0f, 0.0f, 0.0f}},
                                                               {150, {-0.864188f, -0.442863f, -0.238856f}},
                                                               {161, {-0.688191f, -0.587785f, -0.425325f}}};
    for (const auto& [number, normal] : known) EXPECT_LT(glm::distance(normals[number], normal), 1e-6f) << number;
}

TEST(ImportMd2, NormalsAreTheFiles) {
    std::vector<std::byte> bytes = Model({"stand01", "stand02"}).bytes();
    const std::size_t first = 172 + 40 + 3;  // the normal of the first frame's first vertex
    bytes.at(first) = std::byte{52};
    bytes.at(first + 4) = std::byte{200};
    Report report;
    const auto scene = import_md2(bytes, "man.md2", {}, report);
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->meshes[0].normals[0], glm::vec3(0, 0, 1)) << "Quake's X is the front, +Z";
    EXPECT_EQ(scene->meshes[0].targets[0].normals[0], glm::vec3(0, 1, 0)) << "its Z is up";
    ASSERT_EQ(report.warnings().size(), 3u);
    EXPECT_EQ(report.warnings()[2].message, "number of a normal is past the table's 162, it points up");
}

TEST(ImportMd2, AxesWindingCoordinatesAndNormals) {
    Report report;
    const Scene scene = import_good({"stand01"}, report);
    const Mesh& mesh = scene.meshes.at(0);
    EXPECT_TRUE(scene.clips.empty()) << "one frame is no clip";
    // Vertex 0 of the file: X 1, Y -1 + 8/4 = 1, Z 0; Y is to the left, which is +X here, X the front, +Z.
    EXPECT_EQ(mesh.positions[0], glm::vec3(1.0f, 0.0f, 1.0f) / 32.0f);
    EXPECT_EQ(mesh.texture_coords.at(0).values[0], 0.0f);
    EXPECT_EQ(mesh.texture_coords.at(0).values[1], 1.0f) << "T grows downwards, as here";
    for (const glm::vec3& normal : mesh.normals) EXPECT_EQ(normal, glm::vec3(0, 0, 1)) << "outside is where it was";
    for (std::size_t i = 0; i < mesh.submeshes.at(0).indices.size(); i += 3) {
        const auto corner = [&](std::size_t k) { return mesh.positions[mesh.submeshes[0].indices[i + k]]; };
        const glm::vec3 a = corner(1) - corner(0);
        const glm::vec3 b = corner(2) - corner(0);
        EXPECT_GT(a.x * b.y - a.y * b.x, 0.0f) << "counter-clockwise from +Z";
    }
    EXPECT_EQ(scene.images.at(0).uri, "models/man.pcx");
    EXPECT_EQ(scene.materials.at(0).base_colour_texture.texture, 0u);
    EXPECT_EQ(mesh.submeshes.at(0).material, 0u);
    ASSERT_EQ(report.warnings().size(), 3u);
    EXPECT_EQ(report.warnings()[0].message,
              "image could not be read (the source has no folder in which to look for 'models/man.pcx': --root FOLDER "
              "gives it one)");
    EXPECT_EQ(report.warnings()[0].first_place, "byte 68");
    EXPECT_EQ(report.warnings()[1].message, "units are taken as 1/32 of a metre");
}

/// A folder with a model whose skin is called `models/man.pcx`, and files of the given names beside it.
class Md2Skins : public testing::Test {
protected:
    void make(const std::filesystem::path& name, std::string_view content) const {
        std::filesystem::create_directories((folder_.path() / name).parent_path());
        std::ofstream(folder_.path() / name, std::ios::binary) << content;
    }
    Image skin(const Md2Options& options = {}) {
        const std::vector<std::byte> bytes = Model({"stand01"}).bytes();
        make("in/man.md2", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        report_ = Report();
        const auto scene = import_md2(folder_.path() / "in/man.md2", options, report_);
        EXPECT_TRUE(scene);
        return scene ? scene->images.at(0) : Image();
    }
    [[nodiscard]] std::string first_warning() const { return report_.warnings().front().message; }

    static constexpr std::string_view kPng = "\x89PNG\r\n\x1a\n, and so on";
    bendy::test::TemporaryFolder folder_;
    Report report_;
};

TEST_F(Md2Skins, AreFoundWhereTheModelIs) {
    EXPECT_EQ(skin().uri, "models/man.pcx");
    EXPECT_EQ(first_warning(), "image could not be read (file not found: 'man.pcx')");
    make("in/man.pcx", "no image that is known");
    EXPECT_EQ(skin().bytes.size(), 22u);
    EXPECT_EQ(first_warning(), "embedded file is not an image of a known kind: 'man.pcx'");
    make("in/man.png", kPng);
    const Image found = skin();
    EXPECT_EQ(found.bytes.size(), kPng.size());
    EXPECT_EQ(found.media_type, "image/png");
    EXPECT_EQ(found.uri, "");
    ASSERT_EQ(report_.embedded().size(), 1u);
    EXPECT_EQ(report_.embedded()[0].file.filename(), "man.png");
    make("in/models/man.jpg", "\xff\xd8\xff, a JPEG image");
    EXPECT_EQ(skin().media_type, "image/jpeg") << "the folder that the model names goes before";
    Md2Options link;
    link.embed_images = false;
    EXPECT_EQ(skin(link).uri, "models/man.jpg");
    EXPECT_TRUE(skin(link).bytes.empty());
}

TEST_F(Md2Skins, OutsideAreNotRead) {
    make("models/man.png", kPng);
    make("man.png", kPng);
    EXPECT_TRUE(skin().bytes.empty());
    Md2Options options;
    options.root = folder_.path();
    EXPECT_TRUE(skin(options).bytes.empty()) << "names start in the model's folder";
}

TEST_F(Md2Skins, AreTheUsersTexture) {
    make("in/man.png", kPng);
    make("other.png", "\x89PNG\r\n\x1a\n");
    Md2Options options;
    options.texture = folder_.path() / "other.png";
    EXPECT_EQ(skin(options).bytes.size(), 8u);
    EXPECT_EQ(report_.embedded().size(), 1u);
    options.embed_images = false;
    EXPECT_EQ(skin(options).uri, "../other.png");
    options.texture = folder_.path() / "none.png";
    for (const bool embed : {true, false}) {
        options.embed_images = embed;
        const auto failed = import_md2(folder_.path() / "in/man.md2", options, report_);
        ASSERT_FALSE(failed);
        EXPECT_EQ(failed.error().message, "file not found: 'none.png'");
        EXPECT_EQ(failed.error().file, options.texture);
    }
}

TEST_F(Md2Skins, OfModelsWithoutANameAreTheUsersTexture) {
    std::vector<std::byte> bytes = Model({"stand01"}).bytes();
    make("other.png", kPng);
    Md2Options options;
    options.texture = folder_.path() / "other.png";
    const auto without = [&](std::size_t at) {  // a byte that makes it so
        bytes.at(at) = std::byte{0};
        return *import_md2(bytes, "man.md2", options, report_);
    };
    for (const std::size_t at : {std::size_t{68}, std::size_t{20}}) {  // no name, then no skin
        const Scene scene = without(at);
        EXPECT_EQ(scene.images.at(0).bytes.size(), kPng.size());
        EXPECT_EQ(scene.meshes.at(0).submeshes.at(0).material, 0u);
        EXPECT_EQ(scene.materials.at(0).base_colour_texture.texture, 0u);
    }
    options.texture.clear();
    const auto plain = import_md2(bytes, "man.md2", options, report_);
    ASSERT_TRUE(plain);
    EXPECT_TRUE(plain->materials.empty());
}

TEST(ImportMd2, ClipsFollowTheFramesNames) {
    const auto runs = [](const std::vector<std::string>& names) {
        std::string text;
        for (const md2::FrameRun& run : md2::find_runs(names))
            text += run.name + ':' + std::to_string(run.first) + '+' + std::to_string(run.count) + ' ';
        return text;
    };
    EXPECT_EQ(runs({"stand01", "stand02", "run1", "run2", "run3"}), "stand:0+2 run:2+3 ");
    EXPECT_EQ(runs({"pain101", "pain102", "pain201", "pain202"}), "pain1:0+2 pain2:2+2 ");
    EXPECT_EQ(runs({"attack8", "attack9", "attack10"}), "attack:0+3 ");
    EXPECT_EQ(runs({"walk099", "walk100", "walk101"}), "walk:0+3 ");
    EXPECT_EQ(runs({"crattack1", "crattak2", "CRattack3", "attak1", "attack2"}), "crattack:0+3 attak:3+2 ");
    EXPECT_EQ(runs({"crattak8", "crattack10"}), "crattak:0+1 crattack:1+1 ");
    EXPECT_EQ(runs({"crdeth1", "crdeath2"}), "crdeth:0+2 ");
    EXPECT_EQ(runs({"flip", "flip", "1", "2"}), "flip:0+1 flip:1+1 :2+2 ");
    EXPECT_EQ(runs({"a99999999999999999999999", "a1"}), "a999999999999999999999:0+1 a:1+1 ");
}

TEST(ImportMd2, DeathsOfPlayersAreToldApartByTheirFrames) {
    const auto players = [](std::size_t more) {
        std::vector<std::string> names;
        for (const auto& [letters, count] :
             {std::pair("stand", 54), {"pain", 12}, {"jump", 112}, {"death", 20}, {"more", static_cast<int>(more)}}) {
            for (int k = 1; k <= count; ++k) names.push_back(letters + std::to_string(k));
        }
        std::string text;
        for (const md2::FrameRun& run : md2::find_runs(names))
            text += run.name + ':' + std::to_string(run.first) + '+' + std::to_string(run.count) + ' ';
        return text;
    };
    EXPECT_EQ(players(0),
              "stand:0+54 pain1:54+4 pain2:58+4 pain3:62+4 jump:66+112 death1:178+6 death2:184+6 death3:190+8 ");
    EXPECT_EQ(players(1), "stand:0+54 pain:54+12 jump:66+112 death:178+20 more:198+1 ") << "another kind of model";
}

TEST(ImportMd2, WhatIsDoneOnceDoesNotRepeat) {
    for (const char* once : {"attack", "pain2", "jump", "flip", "salute", "taunt", "wave", "point", "crattak",
                             "crattack", "attak2", "crpain", "crdeth", "death1", "Death3", "deathfall"})
        EXPECT_FALSE(md2::is_repeated(once)) << once;
    for (const char* again : {"stand", "run", "crstnd", "crwalk", "glide", "walk", "", "cr"})
        EXPECT_TRUE(md2::is_repeated(again)) << again;
}

TEST(ImportMd2, FaultsNameTheByte) {
    EXPECT_EQ(fault_of({}), "byte 0: this is not a Quake II model: it does not begin with 'IDP2'");
    EXPECT_EQ(fault_with(4, 7), "byte 4: version 7 is not known, only version 8 (Quake II)");
    EXPECT_EQ(fault_with(8, 0), "byte 8: the skin has no size: texture coordinates mean nothing");
    EXPECT_EQ(fault_with(12, 0), "byte 12: the skin has no size: texture coordinates mean nothing");
    EXPECT_EQ(fault_with(16, 55), "byte 16: a frame of 4 vertices takes 56 bytes, the header says 55");
    EXPECT_EQ(fault_with(20, 5), "byte 20: number of skins: 5 do not fit between byte 68 and the end of the file");
    EXPECT_EQ(fault_with(24, 0xffffffff),
              "byte 16: a frame of 4294967295 vertices takes 17179869220 bytes, the header says 56");
    EXPECT_EQ(fault_with(28, 0x40000000),
              "byte 28: number of texture coordinates: 1073741824 do not fit between byte 132 and the end of the file");
    EXPECT_EQ(fault_with(32, 0), "byte 32: there are no triangles");
    EXPECT_EQ(fault_with(40, 0), "byte 40: there are no frames");
    EXPECT_EQ(fault_with(40, 3), "byte 40: number of frames: 3 do not fit between byte 172 and the end of the file");
    EXPECT_EQ(fault_with(52, 1000), "byte 52: offset of triangles: 1000 is past the end of the file");
    EXPECT_EQ(fault_with(64, 1000), "byte 64: the file is truncated: its header says 1000 bytes, it has 288");
    EXPECT_EQ(fault_with(148, 4, 2), "byte 148: index 4 of a triangle is out of range: there are 4 vertices");
    EXPECT_EQ(fault_with(154, 4, 2),
              "byte 154: index 4 of a triangle is out of range: there are 4 texture coordinates");
    EXPECT_EQ(fault_with(172, 0x7f800000), "byte 172: the number is not finite");
    EXPECT_EQ(fault_with(172, 0x7f000000), "byte 172: the frame's scale or origin is implausibly large");
}

TEST(ImportMd2, EveryPrefixIsRefused) {
    const std::vector<std::byte> bytes = Model({"stand01", "stand02"}).bytes();
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_NE(fault_of({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}), "") << size;
    EXPECT_EQ(fault_of(bytes), "");
}

}  // namespace
}  // namespace bendy::converter::import_md2_test
