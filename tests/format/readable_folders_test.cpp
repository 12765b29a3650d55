#include <bendy/format/readable_folders.h>

#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace bendy::readable_folders_test {
namespace {

namespace fs = std::filesystem;

class Folders : public testing::Test {
protected:
    void make(const fs::path& name) const {
        fs::create_directories((folder_.path() / name).parent_path());
        std::ofstream(folder_.path() / name) << "content";
    }
    /// False where there are no symbolic links.
    [[nodiscard]] bool link(const fs::path& name, const fs::path& to) const {
        fs::create_directories((folder_.path() / name).parent_path());
        std::error_code problem;
        fs::create_symlink(to, folder_.path() / name, problem);
        return !problem;
    }

    [[nodiscard]] fs::path at(const fs::path& name) const { return folder_.path() / name; }

    /// What is wrong with a URI; nothing if it leads to a file that exists.
    static std::optional<LinkProblem> problem(const ReadableFolders& folders, std::string_view uri) {
        const auto file = folders.find(uri);
        if (!file) return file.error();
        EXPECT_TRUE(fs::exists(*file)) << uri;
        return std::nullopt;
    }

    test::TemporaryFolder folder_;
};

TEST_F(Folders, HoldTheFilesBesideTheSourceAndBelow) {
    make("in/a.gltf");
    make("in/a b.bin");
    make("in/sub/deep/c.bin");
    make("in/100%.bin");
    make("in/real%20name.bin");
    const ReadableFolders folders = ReadableFolders::of(at("in/a.gltf"));
    for (const char* uri : {"a b.bin", "a%20b.bin", "./sub/deep/c.bin", "sub/../a%20b.bin", "sub/../../in/a b.bin",
                            "100%.bin", "real%20name.bin", ".\\sub\\deep/c.bin", "sub\\..\\a%20b.bin"}) {
        EXPECT_EQ(problem(folders, uri), std::nullopt) << uri;
    }
    EXPECT_EQ(problem(folders, "FILE:\\\\" + at("in/sub/deep/c.bin").generic_string()), std::nullopt);
    EXPECT_EQ(problem(folders, "file://" + at("in/sub/deep/c.bin").generic_string()), std::nullopt);
    EXPECT_EQ(problem(folders, at("in/sub/deep/c.bin").generic_string()), std::nullopt);
    EXPECT_EQ(*folders.find("a%20b.bin"), at("in/a b.bin"));
    EXPECT_EQ(*folders.find("none.bin"), at("in/none.bin"));  // it need not exist
}

TEST_F(Folders, HoldNothingElse) {
    make("in/a.gltf");
    make("in/sub/b.bin");
    make("secret");
    make("in2/secret");  // a folder whose name begins in the same way
    const ReadableFolders folders = ReadableFolders::of(at("in/a.gltf"));
    for (const char* uri : {"../secret",
                            "..%2fsecret",
                            "%2e%2e/secret",
                            "..%2Fin2/secret",
                            "sub/../../secret",
                            "./.././secret",
                            "../in2/secret",
                            "..\\secret",
                            "..\\in2\\secret",
                            "sub\\..\\..\\secret",
                            "..%2f\\secret",
                            "\\etc\\hostname",
                            "\\\\server\\share\\file",
                            "FILE:///etc/hostname",
                            "file:\\\\\\etc\\hostname",
                            "..",
                            "/etc/hostname",
                            "file:///etc/hostname",
                            "//server/share/file",
                            "../none"}) {
        EXPECT_EQ(problem(folders, uri), LinkProblem::outside) << uri;
    }
    EXPECT_EQ(problem(folders, at("secret").generic_string()), LinkProblem::outside);
    EXPECT_EQ(problem(folders, ""), LinkProblem::empty);
    EXPECT_EQ(problem(folders, "http://example.invalid/a.bin"), LinkProblem::scheme);
    EXPECT_EQ(problem(folders, "data:,abc"), LinkProblem::scheme);
    EXPECT_EQ(problem(folders, "a%00.bin"), LinkProblem::no_name);
    EXPECT_EQ(problem(folders, "DATA:,a\\b"), LinkProblem::scheme);
    EXPECT_EQ(problem(folders, " http://example.invalid/a.bin"), LinkProblem::scheme);
    EXPECT_EQ(problem(folders, std::string_view("a\0.bin", 6)), LinkProblem::control);
    for (const char* uri :
         {".\t./secret", "sub/b.bin\n", "\rsub/b.bin", "sub/\x7f", "sub/\xc2\x85", "\thttp://example.invalid"})
        EXPECT_EQ(problem(folders, uri), LinkProblem::control) << uri;
    EXPECT_TRUE(folders.find(".%09./secret"));  // a folder has this name
    EXPECT_EQ(problem(folders, "HTTP:\\\\example.invalid\\a.bin"), LinkProblem::scheme);
#ifdef _WIN32
    EXPECT_EQ(problem(folders, "..%5csecret"), LinkProblem::outside);
#endif
}

TEST_F(Folders, ALinkCountsAsWhatItLeadsTo) {
    make("in/a.gltf");
    make("secret");
    make("out/b.bin");
    if (!link("in/link", "../secret")) GTEST_SKIP() << "no symbolic links here";
    ASSERT_TRUE(link("in/folder", "../out"));
    ASSERT_TRUE(link("in/inside", "a.gltf"));
    ASSERT_TRUE(link("in/chain", "link"));
    const ReadableFolders folders = ReadableFolders::of(at("in/a.gltf"));
    EXPECT_EQ(problem(folders, "inside"), std::nullopt);
    for (const char* uri : {"link", "chain", "folder/b.bin", "folder/../secret", "sub/../link"})
        EXPECT_EQ(problem(folders, uri), LinkProblem::outside) << uri;
}

TEST_F(Folders, AFolderOfLinksIsAsGoodAsTheOneThatTheyLeadTo) {
    make("real/a.gltf");
    make("real/b.bin");
    make("real/sub/c.bin");
    make("elsewhere/d.bin");
    if (!link("box/a.gltf", at("real/a.gltf"))) GTEST_SKIP() << "no symbolic links here";
    ASSERT_TRUE(link("box/b.bin", at("real/b.bin")));
    ASSERT_TRUE(link("box/sub/c.bin", at("real/sub/c.bin")));
    ASSERT_TRUE(link("box/d.bin", at("elsewhere/d.bin")));
    ASSERT_TRUE(link("short", at("real")));
    const ReadableFolders folders = ReadableFolders::of(at("box/a.gltf"));
    EXPECT_EQ(problem(folders, "b.bin"), std::nullopt);
    EXPECT_EQ(problem(folders, "sub/c.bin"), std::nullopt);
    EXPECT_EQ(problem(folders, "d.bin"), LinkProblem::outside);
    EXPECT_EQ(problem(ReadableFolders::of(at("short/a.gltf")), "b.bin"), std::nullopt);
    EXPECT_EQ(problem(ReadableFolders::of(at("box/a.gltf"), at("box")), "d.bin"), std::nullopt);
}

TEST_F(Folders, ARootIsReadToo) {
    make("models/fox/a.gltf");
    make("models/shared/b.bin");
    make("secret");
    const ReadableFolders folders = ReadableFolders::of(at("models/fox/a.gltf"), at("models/shared/.."));
    EXPECT_EQ(problem(folders, "../shared/b.bin"), std::nullopt);
    EXPECT_EQ(problem(folders, at("models/shared/b.bin").generic_string()), std::nullopt);
    EXPECT_EQ(problem(folders, "../../secret"), LinkProblem::outside);
    EXPECT_EQ(problem(folders, "../../models/../secret"), LinkProblem::outside);
    if (!link("models/away", "../elsewhere/deep")) GTEST_SKIP() << "no symbolic links here";
    make("elsewhere/deep/c.bin");
    make("elsewhere/secret");
    EXPECT_EQ(problem(folders, "../away/c.bin"), std::nullopt);  // links in it are followed
    EXPECT_EQ(problem(folders, "../away/../secret"), LinkProblem::outside);
}

TEST_F(Folders, AreNoneWithoutASource) {
    make("in/b.bin");
    EXPECT_EQ(problem(ReadableFolders(), "b.bin"), LinkProblem::outside);
    EXPECT_EQ(problem(ReadableFolders(), at("in/b.bin").generic_string()), LinkProblem::outside);
    EXPECT_TRUE(ReadableFolders().start().empty());
    EXPECT_EQ(problem(ReadableFolders(at("in")), "b.bin"), std::nullopt);
    EXPECT_EQ(problem(ReadableFolders(at("in")), "../in/b.bin"), std::nullopt);
    EXPECT_EQ(problem(ReadableFolders(at("in")), "../b.bin"), LinkProblem::outside);
}

#ifndef _WIN32
TEST_F(Folders, MayHoldNamesWithABackslash) {
    make("in/a\\b.bin");
    const ReadableFolders folders = ReadableFolders::of(at("in/a.gltf"));
    EXPECT_EQ(*folders.find("a\\b.bin"), at("in/a\\b.bin"));
    EXPECT_EQ(*folders.find("a%5Cb.bin"), at("in/a\\b.bin"));
    make("in/a/b.bin");
    EXPECT_EQ(*folders.find("a\\b.bin"), at("in/a/b.bin"));
}
#endif

TEST(LinkedFile, IsWhatTheUriMeans) {
    const fs::path folder = "models";
    EXPECT_EQ(*linked_file("a%20b.png", folder), folder / "a b.png");
    EXPECT_EQ(*linked_file("100%.png", folder), folder / "100%.png");
    EXPECT_EQ(*linked_file("a.png", "."), fs::path("a.png"));
    EXPECT_EQ(*linked_file("/pictures/a%20b.png", folder), fs::path("/pictures/a b.png"));
    EXPECT_EQ(*linked_file("file:///pictures/a.png", folder), fs::path("/pictures/a.png"));
    EXPECT_EQ(*linked_file("file:///C:/a.png", "."), fs::path("C:/a.png"));
    EXPECT_EQ(*linked_file("textures\\a%20b.png", folder), folder / "textures/a b.png");
    EXPECT_EQ(*linked_file("textures\\a:b.png", folder), folder / "textures/a:b.png");
    EXPECT_EQ(linked_file("Data:,", folder).error(), LinkProblem::scheme);
    EXPECT_EQ(linked_file("data:image/png;base64,AAAA", folder).error(), LinkProblem::scheme);
    EXPECT_EQ(linked_file("https://example.org/a.png", folder).error(), LinkProblem::scheme);
    EXPECT_EQ(linked_file("", folder).error(), LinkProblem::empty);
}

}  // namespace
}  // namespace bendy::readable_folders_test
