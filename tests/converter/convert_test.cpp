#include <bendy/converter/convert.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>
#include <bendy/runtime.h>

#include "source_folder.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <span>
#include <string>
#include <vector>

namespace bendy::converter::convert_test {
namespace {

using Buffer = std::vector<std::byte>;

std::filesystem::path example(const std::string& name) {
    return source_folder() / "examples" / name;
}

Buffer convert_good(const std::filesystem::path& file, const ConvertOptions& options = {}) {
    Report report;
    Result<Buffer, ImportError> bytes = convert(file, options, report);
    if (!bytes) {
        ADD_FAILURE() << file << ": " << bytes.error().place << ": " << bytes.error().message;
        return {};
    }
    return *std::move(bytes);
}

/// What the glTF files say of themselves.
struct Example {
    const char* file;
    std::size_t joints;  ///< nodes of the scene
    std::vector<std::string> clips;
    std::vector<std::string> targets;  ///< of all meshes together
    std::uint64_t triangles;
    std::size_t materials;
};

void PrintTo(const Example& example, std::ostream* out) {
    *out << example.file;
}

class ConvertExample : public testing::TestWithParam<Example> {};

TEST_P(ConvertExample, HoldsWhatTheSourceHolds) {
    const Example& expected = GetParam();
    const Buffer bytes = convert_good(example(expected.file));
    const Faults faults = validate(bytes);
    for (const Error& fault : faults.list()) ADD_FAILURE() << describe_with_place(fault, bytes);
    const Result<Model> model = Model::from_memory(bytes);
    ASSERT_TRUE(model.has_value());
    EXPECT_EQ(model->joints().size(), expected.joints);
    std::vector<std::string> clips;
    for (const bendy::Clip& clip : model->clips()) {
        clips.emplace_back(clip.name);
        EXPECT_GT(clip.end, clip.start);
    }
    EXPECT_EQ(clips, expected.clips);
    std::vector<std::string> targets;
    for (const bendy::Mesh& mesh : model->meshes()) {
        for (const MorphTargetView& target : mesh.targets) targets.emplace_back(target.name);
    }
    EXPECT_EQ(targets, expected.targets);
    std::uint64_t triangles = 0;
    for (const bendy::Submesh& submesh : model->submeshes()) triangles += submesh.count / 3;
    EXPECT_EQ(triangles, expected.triangles);
    EXPECT_EQ(model->materials().size(), expected.materials);
    ASSERT_EQ(model->textures().size(), 1u);
    ASSERT_EQ(model->textures()[0].images.size(), 1u);
    constexpr std::string_view kPng = "\x89PNG\r\n\x1a\n";
    EXPECT_TRUE(as_text(model->textures()[0].images[0].bytes).starts_with(kPng));
}

TEST_P(ConvertExample, TwiceTheSameBytes) {
    const Buffer once = convert_good(example(GetParam().file));
    EXPECT_FALSE(once.empty());
    EXPECT_EQ(once, convert_good(example(GetParam().file)));
}

TEST_P(ConvertExample, EveryPrefixIsRefused) {
    const Buffer whole = convert_good(example(GetParam().file));
    ASSERT_FALSE(whole.empty());
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const Result<Model> model = Model::from_memory(std::span(whole).first(size));
        ASSERT_FALSE(model.has_value()) << size << " of " << whole.size() << " bytes";
        const ErrorCode expected = size < kChunkHeaderSize ? ErrorCode::kNotABendyFile : ErrorCode::kTruncated;
        ASSERT_EQ(model.error().code, expected) << size << " of " << whole.size() << " bytes";
    }
}

TEST_P(ConvertExample, MovesInEveryClip) {
    const Buffer bytes = convert_good(example(GetParam().file));
    const Result<Model> model = Model::from_memory(bytes);
    ASSERT_TRUE(model.has_value());
    Pose pose(*model);
    std::vector<glm::vec3> rest(model->vertex_count());
    std::vector<glm::vec3> moved(model->vertex_count());
    ASSERT_TRUE(skin(pose, {.out = {.positions = rest}}));
    for (const bendy::Clip& clip : model->clips()) {
        ASSERT_TRUE(sample(pose, &clip, 0.5f * (clip.start + clip.end)));
        ASSERT_TRUE(skin(pose, {.out = {.positions = moved}}));
        float farthest = 0.0f;
        for (std::size_t v = 0; v < rest.size(); ++v) {
            const glm::vec3 by = moved[v] - rest[v];
            farthest = std::max({farthest, std::abs(by.x), std::abs(by.y), std::abs(by.z)});
        }
        EXPECT_GT(farthest, 0.01f) << clip.name;
        EXPECT_LT(farthest, 3.0f) << clip.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Examples, ConvertExample,
                         testing::Values(Example{"mannequin.glb",
                                                 65,
                                                 {"Idle", "Walk"},
                                                 {"Blink", "Smile"},
                                                 (18972 + 2880 + 864 + 1080 + 216 + 144) / 3,
                                                 5},
                                         Example{"tentacle.glb", 15, {"Reach", "Wave"}, {}, (3936 + 4992) / 3, 2}),
                         [](const auto& one) {
                             const std::string file = one.param.file;
                             return file.substr(0, file.find('.'));
                         });

/// A folder of its own for each test, removed at the end.
class ConvertFile : public testing::Test {
protected:
    std::filesystem::path write(const std::string& name, std::string_view content) const {
        std::ofstream(folder_ / name, std::ios::binary) << content;
        return folder_ / name;
    }
    static ImportError error_of(const std::filesystem::path& file, const ConvertOptions& options = {}) {
        Report report;
        const auto bytes = convert(file, options, report);
        if (!bytes) return bytes.error();
        ADD_FAILURE() << file << " was converted";
        return {};
    }

    bendy::test::TemporaryFolder temporary_;
    std::filesystem::path folder_ = temporary_.path();
};

constexpr std::string_view kTwoScenes = R"({"asset":{"version":"2.0"},"scene":1,
    "scenes":[{"name":"one","nodes":[0]},{"name":"two","nodes":[1,2]}],
    "nodes":[{"name":"a"},{"name":"b"},{"name":"c"}]})";

TEST_F(ConvertFile, TakesTheSceneThatIsAskedFor) {
    const auto file = write("scenes.gltf", kTwoScenes);
    const auto names = [&](const ConvertOptions& options) {
        const Buffer bytes = convert_good(file, options);
        std::string list;
        const auto model = Model::from_memory(bytes);
        for (const bendy::Joint& joint : model->joints()) list += joint.name;
        return list;
    };
    ConvertOptions options;
    EXPECT_EQ(names(options), "bc");  // the file's default
    options.gltf.scene = "one";
    EXPECT_EQ(names(options), "a");
    options.gltf.scene = "0";
    EXPECT_EQ(names(options), "a");
    options.gltf.scene = "three";
    EXPECT_NE(error_of(file, options).message.find("three"), std::string::npos);
}

TEST_F(ConvertFile, LinksOrEmbedsImagesBesideTheSource) {
    write("skin.png", "\x89PNG\r\n\x1a\n.");
    const auto file = write("image.gltf", R"({"asset":{"version":"2.0"},"nodes":[{}],"scenes":[{"nodes":[0]}],
        "images":[{"uri":"skin.png"}],"textures":[{"source":0}]})");
    ConvertOptions options;
    const Buffer embedded = convert_good(file, options);
    const auto with_bytes = Model::from_memory(embedded);
    ASSERT_TRUE(with_bytes.has_value());
    EXPECT_EQ(as_text(with_bytes->textures()[0].images[0].bytes), "\x89PNG\r\n\x1a\n.");
    options.gltf.embed_images = false;
    const Buffer linked = convert_good(file, options);
    const auto with_link = Model::from_memory(linked);
    ASSERT_TRUE(with_link.has_value());
    EXPECT_EQ(with_link->textures()[0].images[0].uri, "skin.png");
    EXPECT_TRUE(with_link->textures()[0].images[0].bytes.empty());
}

TEST_F(ConvertFile, SaysInOneLineWhatIsWrong) {
    for (const auto& file : {folder_ / "missing.glb", folder_, write("empty.glb", ""), write("text.gltf", "hello"),
                             write("cut.glb", "glTF\x02"), write("brace.gltf", "{"),
                             write("asset.gltf", R"({"asset":{"version":"3.0"}})")}) {
        const ImportError error = error_of(file);
        EXPECT_FALSE(error.message.empty()) << file;
        EXPECT_EQ(error.message.find('\n'), std::string::npos) << file << ": " << error.message;
    }
}

TEST(Convert, LevelsOfDetailSayWhatTheyCostInAll) {
    for (const char* name : {"mannequin.glb", "tentacle.glb"}) {
        ConvertOptions options;
        options.compact = ErrorBound();
        const std::size_t without = convert_good(example(name), options).size();
        options.lod = true;
        Report report;
        const Result<Buffer, ImportError> bytes = convert(example(name), options, report);
        ASSERT_TRUE(bytes.has_value());
        ASSERT_TRUE(report.compact.has_value());
        ASSERT_TRUE(report.compact->lod_bytes.has_value());
        EXPECT_EQ(*report.compact->lod_bytes, static_cast<std::int64_t>(bytes->size() - without));
        EXPECT_GT(*report.compact->lod_bytes, 0);
    }
}

TEST(Convert, CompactSourceThatGrowsIsNotedAndKeptIfAsked) {
    ConvertOptions options;
    options.compact = ErrorBound();
    const Buffer compact = convert_good(example("tentacle.glb"), options);
    const auto suggestions = [&](Buffer source, const ConvertOptions& with) {
        Report report;
        EXPECT_TRUE(convert(std::move(source), "tentacle.bendy", with, report).has_value());
        return report.suggestions();
    };
    ASSERT_EQ(suggestions(compact, {}).size(), 1U);
    EXPECT_NE(suggestions(compact, {}).front().find("--compact"), std::string::npos);
    EXPECT_TRUE(suggestions(compact, options).empty());
    ConvertOptions exact;
    exact.exact = true;
    EXPECT_TRUE(suggestions(compact, exact).empty());
    EXPECT_TRUE(suggestions(convert_good(example("tentacle.glb")), {}).empty());
}

}  // namespace
}  // namespace bendy::converter::convert_test
