#include "scene/source/named_files.h"

#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace bendy::converter::named_files_test {
namespace {

class Named : public testing::Test {
protected:
    Named() { std::ofstream(folder_.path() / "ten") << "0123456789"; }

    bendy::test::TemporaryFolder folder_;
    Budget budget_;
    Report report_;
    NamedFiles files_{ReadableFolders::of(folder_.path() / "source"), budget_, report_};
};

std::uint64_t left(const Budget& budget) {
    std::uint64_t low = 0;
    for (std::uint64_t bit = std::uint64_t{1} << 62; bit != 0; bit >>= 1) {
        Budget copy = budget;
        try {
            copy.take(low + bit, 1, {});
            low += bit;
        } catch (const Failure&) {
        }
    }
    return low;
}

TEST_F(Named, AFileIsReadOnceAndCountedOnce) {
    const std::uint64_t before = left(budget_);
    const auto once = files_.read("ten", "here");
    const std::uint64_t after = left(budget_);
    EXPECT_EQ(after - before, 10 * Budget::kPerSourceByte);
    std::filesystem::create_directory(folder_.path() / "sub");
    for (const char* uri : {"ten", "./ten", "%74en", "sub/../ten"})
        EXPECT_EQ(files_.read(uri, "here").data(), once.data()) << uri;
    EXPECT_EQ(left(budget_), after);
}

TEST_F(Named, WhatStandsInForAFileIsNamed) {
    std::ofstream(folder_.path() / "skin.png") << "version https://git-lfs.github.com/spec/v1\noid sha256:aa\nsize 1\n";
    std::ofstream(folder_.path() / "page.bin") << "<!DOCTYPE html>\n";
    const std::string is_pointer =
        "file 'skin.png' is a Git LFS pointer: fetch the file that it stands for: git lfs pull";
    try {
        files_.read("page.bin", "here");
        ADD_FAILURE() << "it was read";
    } catch (const Failure& failure) {
        EXPECT_EQ(failure.error.place, "here");
        EXPECT_TRUE(failure.error.message.starts_with("file 'page.bin' is an HTML page: ")) << failure.error.message;
    }
    Image image;
    image.uri = "skin.png";
    files_.embed(image, "images[0]");
    EXPECT_EQ(image.uri, "skin.png");
    ASSERT_EQ(report_.warnings().size(), 1u);
    EXPECT_EQ(report_.warnings()[0].message, "image could not be read (" + is_pointer + ')');
}

TEST_F(Named, WhatIsReadMayGrow) {
    const std::uint64_t before = left(budget_);
    const auto some = files_.read("ten", "here", 4);
    EXPECT_EQ(some.size(), 4u);
    EXPECT_EQ(left(budget_) - before, 4 * Budget::kPerSourceByte);
    EXPECT_EQ(files_.read("ten", "here", 3).data(), some.data());
    const auto more = files_.read("ten", "here", 7);
    EXPECT_EQ(more.size(), 7u);
    EXPECT_EQ(static_cast<char>(more[6]), '6');
    EXPECT_EQ(files_.read("ten", "here", 100).size(), 10u);
    EXPECT_EQ(files_.read("ten", "here", 100).data(), more.data());
    EXPECT_EQ(static_cast<char>(some[3]), '3');  // still there
    EXPECT_EQ(left(budget_) - before, 10 * Budget::kPerSourceByte);
}

}  // namespace
}  // namespace bendy::converter::named_files_test
