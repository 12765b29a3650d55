#include "format/file_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

// What holds on all systems; file_posix_test.cpp and file_windows_test.cpp have the rest.
namespace bendy::file_test {
namespace {

namespace fs = std::filesystem;
using test::expect_error;
using MappedFileTest = test::FileTest;
using WriteFileTest = test::FileTest;

TEST_F(MappedFileTest, GivesTheBytesOnAPageBoundary) {
    const std::string_view text("one\0two", 7);
    put(in("a"), text);
    const auto file = MappedFile::open(in("a"));
    ASSERT_TRUE(file.has_value());
    EXPECT_EQ(as_text(file->bytes()), text);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(file->bytes().data()) % 4096, 0u);
}

TEST_F(MappedFileTest, GivesNothingForAnEmptyFile) {
    put(in("a"), "");
    const auto file = MappedFile::open(in("a"));
    ASSERT_TRUE(file.has_value());
    EXPECT_TRUE(file->bytes().empty());
}

TEST_F(MappedFileTest, RefusesWhatIsNotThere) {
    const auto file = MappedFile::open(in("a"));
    ASSERT_FALSE(file.has_value());
    expect_error(file.error(), ErrorCode::kCannotOpen, ENOENT);
    EXPECT_FALSE(MappedFile::open("").has_value());
}

TEST_F(MappedFileTest, RefusesAFolder) {
    const auto file = MappedFile::open(folder_);
    ASSERT_FALSE(file.has_value());
    expect_error(file.error(), ErrorCode::kCannotRead, EISDIR);
}

TEST_F(MappedFileTest, CanBeMoved) {
    put(in("a"), "one");
    put(in("b"), "two");
    auto one = MappedFile::open(in("a"));
    auto two = MappedFile::open(in("b"));
    ASSERT_TRUE(one && two);
    MappedFile moved(std::move(*one));
    EXPECT_EQ(as_text(moved.bytes()), "one");
    moved = std::move(*two);
    EXPECT_EQ(as_text(moved.bytes()), "two");
    MappedFile empty;
    EXPECT_TRUE(empty.bytes().empty());
    empty = std::move(moved);
    EXPECT_EQ(as_text(empty.bytes()), "two");
}

TEST_F(MappedFileTest, ReadsIntoMemory) {
    put(in("a"), "text");
    put(in("empty"), "");
    const auto file = MappedFile::read(in("a"));
    ASSERT_TRUE(file.has_value());
    put(in("a"), "");  // not on Windows if it were mapped
    EXPECT_EQ(as_text(file->bytes()), "text");
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(file->bytes().data()) % 4096, 0u);
    EXPECT_EQ(mapped_file_at(file->bytes().data()), nullptr);
    const auto empty = MappedFile::read(in("empty"));
    ASSERT_TRUE(empty.has_value());
    EXPECT_TRUE(empty->bytes().empty());
    const auto none = MappedFile::read(in("none"));
    ASSERT_FALSE(none.has_value());
    expect_error(none.error(), ErrorCode::kCannotOpen, ENOENT);
    const auto folder = MappedFile::read(folder_);
    ASSERT_FALSE(folder.has_value());
    expect_error(folder.error(), ErrorCode::kCannotRead, EISDIR);
}

TEST_F(WriteFileTest, WritesSeveralFiles) {
    put(in("a"), "old");
    const std::vector<FileContents> files{{in("a"), as_byte_span("one")}, {in("b"), as_byte_span("two")}};
    ASSERT_TRUE(write_files(files).has_value());
    EXPECT_EQ(content(in("a")), "one");
    EXPECT_EQ(content(in("b")), "two");
    EXPECT_EQ(names(), (std::vector<std::string>{"a", "b"}));
    EXPECT_TRUE(write_files({}).has_value());
}

TEST_F(WriteFileTest, ASetOfFilesReplacesTheOldOnesAtItsEnd) {
    put(in("a"), "old");
    {
        FileSet abandoned;
        ASSERT_TRUE(abandoned.write({in("a"), as_byte_span("one")}).has_value());
        ASSERT_TRUE(abandoned.write({in("b"), as_byte_span("two")}).has_value());
        EXPECT_EQ(content(in("a")), "old");
        EXPECT_EQ(names().size(), 3u);  // and two beside it
    }
    EXPECT_EQ(names(), (std::vector<std::string>{"a"}));
    FileSet files;
    for (const char* text : {"one", "three"}) {  // it can be used again
        ASSERT_TRUE(files.write({in("a"), as_byte_span(text)}).has_value());
        EXPECT_FALSE(files.write({in("none") / "c", as_byte_span("lost")}).has_value());
        ASSERT_TRUE(files.write({in("b"), as_byte_span("two")}).has_value());
        ASSERT_TRUE(files.replace().has_value());
        EXPECT_EQ(content(in("a")), text);
        EXPECT_EQ(content(in("b")), "two");
        EXPECT_EQ(names(), (std::vector<std::string>{"a", "b"}));
    }
    ASSERT_TRUE(files.write({in("a"), as_byte_span("new")}).has_value());
    ASSERT_TRUE(files.write({in("d"), as_byte_span("new")}).has_value());
    fs::create_directory(in("d"));
    const auto replaced = files.replace();
    ASSERT_FALSE(replaced.has_value());
    EXPECT_EQ(replaced.error().file, 1u);
    EXPECT_EQ(content(in("a")), "three");
}

TEST_F(WriteFileTest, WritesNoneOfSeveralFilesIfOneCannotBeWritten) {
    put(in("a"), "old");
    fs::create_directory(in("folder"));
    for (const fs::path& wrong : {in("folder"), in("none") / "c"}) {
        const std::vector<FileContents> files{
            {in("a"), as_byte_span("one")}, {in("b"), as_byte_span("two")}, {wrong, as_byte_span("three")}};
        const auto written = write_files(files);
        ASSERT_FALSE(written.has_value());
        EXPECT_EQ(written.error().file, 2u);
        EXPECT_EQ(content(in("a")), "old");
        EXPECT_EQ(names(), (std::vector<std::string>{"a", "folder"}));
    }
}

TEST_F(WriteFileTest, WritesANewFileAndNothingElse) {
    ASSERT_TRUE(write_file(in("a"), as_byte_span("text")).has_value());
    EXPECT_EQ(content(in("a")), "text");
    EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

TEST_F(WriteFileTest, WritesAnEmptyFile) {
    ASSERT_TRUE(write_file(in("a"), {}).has_value());
    EXPECT_TRUE(fs::exists(in("a")));
    EXPECT_EQ(fs::file_size(in("a")), 0u);
}

TEST_F(WriteFileTest, ReplacesALongerFile) {
    put(in("a"), "a much longer text");
    ASSERT_TRUE(write_file(in("a"), as_byte_span("text")).has_value());
    EXPECT_EQ(content(in("a")), "text");
    EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

TEST_F(WriteFileTest, RefusesAFolderThatIsNotThere) {
    const auto written = write_file(in("none") / "a", as_byte_span("text"));
    ASSERT_FALSE(written.has_value());
    expect_error(written.error(), ErrorCode::kCannotWrite, ENOENT);
    EXPECT_TRUE(names().empty());
}

TEST_F(WriteFileTest, RefusesToReplaceAFolderAndLeavesNothingBehind) {
    fs::create_directory(in("a"));
    put(in("a") / "inside", "x");
    const auto written = write_file(in("a"), as_byte_span("text"));
    ASSERT_FALSE(written.has_value());
    expect_error(written.error(), ErrorCode::kCannotWrite, EISDIR);
    EXPECT_EQ(names(), std::vector<std::string>{"a"});
    EXPECT_EQ(content(in("a") / "inside"), "x");
}

TEST_F(WriteFileTest, NamesMayHaveAnyLetters) {
    for (const fs::path name : {u8"лиса.bendy", u8"狐.bendy", u8"Füchsin é.bendy", u8"\U0001F98A.bendy"}) {
        ASSERT_TRUE(write_file(in(name), as_byte_span("old")).has_value()) << name;
        ASSERT_TRUE(write_file(in(name), as_byte_span("new")).has_value()) << name;
        const auto file = MappedFile::open(in(name));
        ASSERT_TRUE(file.has_value()) << name;
        EXPECT_EQ(as_text(file->bytes()), "new");
    }
    // As the system has them, not as some code page would.
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder_)) found.push_back(entry.path().filename());
    EXPECT_EQ(found.size(), 4u);
    for (const fs::path name : {u8"лиса.bendy", u8"狐.bendy", u8"Füchsin é.bendy", u8"\U0001F98A.bendy"})
        EXPECT_EQ(std::count(found.begin(), found.end(), name), 1) << name;
}

TEST_F(WriteFileTest, FoldersMayHaveAnyLetters) {
    const fs::path folder = in(u8"狐の模型");
    fs::create_directory(folder);
    ASSERT_TRUE(write_file(folder / u8"лиса.bendy", as_byte_span("text")).has_value());
    const auto file = MappedFile::open(folder / u8"лиса.bendy");
    ASSERT_TRUE(file.has_value());
    EXPECT_EQ(as_text(file->bytes()), "text");
}

/// Folders in folders; created and removed one by one, by the name that Windows takes at any length.
class DeepFolder {
public:
    explicit DeepFolder(const fs::path& start, std::size_t depth) : path_(start) {
        for (std::size_t i = 0; i < depth; ++i) {
            path_ /= std::string(100, static_cast<char>('a' + i));
            fs::create_directory(full(path_));
            made_.push_back(path_);
        }
    }
    ~DeepFolder() {
        std::error_code ignored;
        for (auto at = made_.rbegin(); at != made_.rend(); ++at) fs::remove(full(*at), ignored);
    }
    DeepFolder(const DeepFolder&) = delete;
    DeepFolder& operator=(const DeepFolder&) = delete;
    [[nodiscard]] const fs::path& path() const { return path_; }
    static fs::path full(const fs::path& path) {
#ifdef _WIN32
        return LR"(\\?\)" + fs::path(path).make_preferred().wstring();
#else
        return path;
#endif
    }

private:
    fs::path path_;
    std::vector<fs::path> made_;
};

TEST_F(WriteFileTest, PathsMayBeLong) {
    const DeepFolder deep(folder_, 4);
    const fs::path path = deep.path() / u8"狐.bendy";
    ASSERT_GT(path.native().size(), 400u);
    ASSERT_TRUE(write_file(path, as_byte_span("old")).has_value());
    ASSERT_TRUE(write_file(path, as_byte_span("new")).has_value());
    {
        const auto file = MappedFile::open(path);
        ASSERT_TRUE(file.has_value());
        EXPECT_EQ(as_text(file->bytes()), "new");
    }
    EXPECT_TRUE(fs::remove(DeepFolder::full(path)));
}

TEST_F(WriteFileTest, APathMayBeRelative) {
    const fs::path before = fs::current_path();
    fs::current_path(folder_);
    const bool written = write_file("a", as_byte_span("text")).has_value();
    const auto file = MappedFile::open(fs::path(".") / "a");
    fs::current_path(before);
    EXPECT_TRUE(written);
    ASSERT_TRUE(file.has_value());
    EXPECT_EQ(as_text(file->bytes()), "text");
}

}  // namespace
}  // namespace bendy::file_test
