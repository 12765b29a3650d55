#include "md2/frame_cycles.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/import_md2.h>
#include <bendy/format/validate.h>

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace bendy::converter {
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
    const auto scene = import_md2(bytes, "man", report);
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
    auto scene = import_md2(Model(std::move(names)).bytes(), "man", report);
    EXPECT_TRUE(scene) << (scene ? "" : scene.error().place + ": " + scene.error().message);
    if (!scene) return {};
    Report unheard;
    EXPECT_TRUE(validate(build_chunks(*scene, "test", unheard)).empty());
    return *std::move(scene);
}

TEST(ImportMd2, FramesBecomeTargetsAndCycles) {
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
        for (const glm::vec3& moved : mesh.targets[target].positions)
            EXPECT_EQ(moved, glm::vec3(0.0f, static_cast<float>(target + 1) / 32.0f, 0.0f)) << "Z up is Y up here";
    }
    ASSERT_EQ(scene.cycles.size(), 2u);
    EXPECT_EQ(scene.cycles[0].name, "stand");
    const Track& track = scene.cycles[0].tracks.at(0);
    EXPECT_EQ(track.path, TrackPath::weights);
    EXPECT_EQ(track.times, (std::vector<float>{0.0f, 0.1f, 0.2f}));
    EXPECT_EQ(track.values, (std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}));
    EXPECT_EQ(scene.cycles[1].name, "run");
    EXPECT_EQ(scene.cycles[1].tracks.at(0).values, (std::vector<float>{0, 0, 1}));
}

TEST(ImportMd2, AxesWindingCoordinatesAndNormals) {
    Report report;
    const Scene scene = import_good({"stand01"}, report);
    const Mesh& mesh = scene.meshes.at(0);
    EXPECT_TRUE(scene.cycles.empty()) << "one frame is no cycle";
    // Vertex 0 of the file: X 1, Y -1 + 8/4 = 1, Z 0; Y is to the left, which is +X here, X the front, +Z.
    EXPECT_EQ(mesh.positions[0], glm::vec3(1.0f, 0.0f, 1.0f) / 32.0f);
    EXPECT_EQ(mesh.texture_coords.at(0).values[0], 0.0f);
    EXPECT_EQ(mesh.texture_coords.at(0).values[1], 1.0f) << "T grows downwards, as here";
    for (const glm::vec3& normal : mesh.normals) EXPECT_EQ(normal, glm::vec3(0, 0, 1)) << "outside is where it was";
    for (std::size_t i = 0; i < mesh.parts.at(0).indices.size(); i += 3) {
        const auto corner = [&](std::size_t k) { return mesh.positions[mesh.parts[0].indices[i + k]]; };
        const glm::vec3 a = corner(1) - corner(0);
        const glm::vec3 b = corner(2) - corner(0);
        EXPECT_GT(a.x * b.y - a.y * b.x, 0.0f) << "counter-clockwise from +Z";
    }
    EXPECT_EQ(scene.images.at(0).uri, "models/man.pcx");
    EXPECT_EQ(scene.materials.at(0).base_colour_texture.texture, 0u);
    EXPECT_EQ(mesh.parts.at(0).material, 0u);
    ASSERT_EQ(report.warnings().size(), 2u);
    EXPECT_EQ(report.warnings()[0].message, "units are taken as 1/32 of a metre");
}

TEST(ImportMd2, CyclesFollowTheFramesNames) {
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
    EXPECT_EQ(runs({"flip", "flip", "1", "2"}), "flip:0+1 flip:1+1 :2+2 ");
    EXPECT_EQ(runs({"a99999999999999999999999", "a1"}), "a999999999999999999999:0+1 a:1+1 ");
}

TEST(ImportMd2, FaultsNameTheByte) {
    EXPECT_EQ(fault_of({}), "byte 0: this is no Quake II model: it does not begin with 'IDP2'");
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
}  // namespace bendy::converter
