#include "scene/source/source_file.h"

#include "temporary_folder.h"

#include <bendy/format/readable_folders.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace bendy::converter::move_links_test {
namespace {

class MoveLinks : public testing::Test {
protected:
    void make(const std::filesystem::path& name) const {
        std::filesystem::create_directories((folder_.path() / name).parent_path());
        std::ofstream(folder_.path() / name) << "image";
    }

    /// What becomes of a link of `from` in `to`.
    std::string moved(const std::string& uri, const std::string& from, const std::string& to) {
        Scene scene;
        scene.images.emplace_back().uri = uri;
        report_ = Report();
        const std::filesystem::path file = folder_.path() / from;
        std::filesystem::create_directories(file.parent_path());
        move_links(scene, file, folder_.path() / to, ReadableFolders::of(file, root_), report_);
        return scene.images[0].uri;
    }

    [[nodiscard]] bool warned(const std::string& words) const {
        const auto& warnings = report_.warnings();
        return std::any_of(warnings.begin(), warnings.end(),
                           [&](const Warning& warning) { return warning.message.find(words) != std::string::npos; });
    }

    bendy::test::TemporaryFolder folder_;
    std::filesystem::path root_;
    Report report_;
};

TEST_F(MoveLinks, AreRelativeToTheOutputsFolder) {
    make("lk/axe.jpg");
    EXPECT_EQ(moved("axe.jpg", "lk/a.x", "a.bendy"), "lk/axe.jpg");
    EXPECT_TRUE(report_.warnings().empty());
    EXPECT_EQ(moved("axe.jpg", "lk/a.x", "out/deep/a.bendy"), "../../lk/axe.jpg");
    EXPECT_TRUE(warned("leads out of the output's folder"));
    EXPECT_EQ(moved("../lk/axe.jpg", "other/a.gltf", "lk/a.bendy"), "axe.jpg");
}

TEST_F(MoveLinks, AreEncoded) {
    make("a b/\xc3\xa9 100%.png");
    EXPECT_EQ(moved("\xc3\xa9%20100%25.png", "a b/m.gltf", "m.bendy"), "a%20b/%C3%A9%20100%25.png");
    EXPECT_TRUE(report_.warnings().empty());
}

TEST_F(MoveLinks, InOneFolderStayAsTheyAre) {
    make("a b.png");
    EXPECT_EQ(moved("./a b.png", "m.gltf", "m.bendy"), "./a b.png");
    EXPECT_EQ(moved("gone.png", "m.gltf", "m.bendy"), "gone.png");
    EXPECT_TRUE(warned("linked image does not exist: 'gone.png'"));
}

TEST_F(MoveLinks, HaveForwardSlashes) {
    make("textures/a b.png");
    EXPECT_EQ(moved("textures\\a b.png", "m.gltf", "m.bendy"), "textures/a%20b.png");
    EXPECT_TRUE(report_.warnings().empty());
    EXPECT_EQ(moved("..\\gone.png", "in/m.gltf", "in/m.bendy"), "../gone.png");
    EXPECT_TRUE(warned("leads out of the output's folder"));
    EXPECT_EQ(moved("\\nowhere\\at\\all.png", "m.gltf", "m.bendy"), "\\nowhere\\at\\all.png");
}

TEST_F(MoveLinks, OfOtherKindsStayAsTheyAre) {
    for (const char* uri : {"https://example.org/a.png", "http://example.org/a.png", "/nowhere/at/all.png",
                            "file:///nowhere/at/all.png"}) {
        EXPECT_EQ(moved(uri, "lk/a.x", "a.bendy"), uri);
        EXPECT_FALSE(warned("does not exist")) << uri;
    }
    for (const char* uri : {"file:///C:/all.png", "FILE:///C:/all.png"})
        EXPECT_EQ(moved(uri, "lk/a.x", "a.bendy"), uri);
}

TEST_F(MoveLinks, AreLookedForOnlyWhereFilesMayBeRead) {
    EXPECT_EQ(moved("../gone.png", "in/a.x", "in/a.bendy"), "../gone.png");
    EXPECT_FALSE(warned("does not exist"));
    EXPECT_TRUE(warned("leads out of the output's folder"));
    root_ = folder_.path();
    EXPECT_EQ(moved("../gone.png", "in/a.x", "in/a.bendy"), "../gone.png");
    EXPECT_TRUE(warned("does not exist"));
}

TEST_F(MoveLinks, ThatLeadOutAreNamedHoweverTheyAreWritten) {
    for (const char* uri : {"../a.png", "./../a.png", "sub/../../a.png", "%2e%2e/a.png", "..%2fa.png", "/nowhere/a.png",
                            "file:///nowhere/a.png"}) {
        EXPECT_EQ(moved(uri, "in/m.gltf", "in/m.bendy"), uri);
        EXPECT_TRUE(warned("leads out of the output's folder")) << uri;
    }
    for (const char* uri : {"sub/../a.png", "..a.png", "%2e%2ea.png", ".../a.png"}) {
        moved(uri, "in/m.gltf", "in/m.bendy");
        EXPECT_FALSE(warned("leads out of the output's folder")) << uri;
    }
}

TEST_F(MoveLinks, FollowASymbolicLinkToTheFolder) {
    make("real/deep/here/x");
    make("lk/axe.jpg");
    std::error_code problem;
    std::filesystem::create_directory_symlink(folder_.path() / "real/deep/here", folder_.path() / "short", problem);
    if (problem) GTEST_SKIP() << "no symbolic links here";
    EXPECT_EQ(moved("axe.jpg", "lk/a.x", "short/a.bendy"), "../../../lk/axe.jpg");
}

TEST_F(MoveLinks, EmbeddedImagesHaveNone) {
    Scene scene;
    scene.images.emplace_back().bytes.resize(4);
    scene.images.emplace_back();
    Report report;
    move_links(scene, "a/b", "c/d", ReadableFolders::of("a/b"), report);
    EXPECT_EQ(scene.images[0].uri, "");
    EXPECT_EQ(scene.images[1].uri, "");
    EXPECT_TRUE(report.warnings().empty());
}

}  // namespace
}  // namespace bendy::converter::move_links_test
