#include <bendy/format/file.h>

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bendy {
namespace {

namespace fs = std::filesystem;

/// An empty folder that goes away with the test.
class FileTest : public testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "bendy_file_test_XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { fs::remove_all(folder_); }

    [[nodiscard]] fs::path in(const char* name) const { return folder_ / name; }

    [[nodiscard]] std::vector<std::string> names() const {
        std::vector<std::string> list;
        for (const auto& entry : fs::directory_iterator(folder_)) list.push_back(entry.path().filename().string());
        std::sort(list.begin(), list.end());
        return list;
    }

    static std::string content(const fs::path& path) {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    static void put(const fs::path& path, std::string_view text) { std::ofstream(path, std::ios::binary) << text; }

    fs::path folder_;
};

using MappedFileTest = FileTest;
using WriteFileTest = FileTest;

/// The code, and what the system said.
void expect_error(const Error& error, ErrorCode code, int system) {
    EXPECT_STREQ(code_name(error.code), code_name(code));
    EXPECT_EQ(error.value, static_cast<std::uint64_t>(system));
}

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

TEST_F(MappedFileTest, RefusesAPipeWithoutWaitingForIt) {
    ASSERT_EQ(::mkfifo(in("pipe").c_str(), 0600), 0);
    const auto file = MappedFile::open(in("pipe"));
    ASSERT_FALSE(file.has_value());
    expect_error(file.error(), ErrorCode::kCannotRead, EINVAL);
}

TEST_F(MappedFileTest, FollowsALink) {
    put(in("a"), "text");
    fs::create_symlink(in("a"), in("link"));
    const auto file = MappedFile::open(in("link"));
    ASSERT_TRUE(file.has_value());
    EXPECT_EQ(as_text(file->bytes()), "text");
}

TEST_F(MappedFileTest, OutlivesTheNameOfItsFile) {
    put(in("a"), "text");
    const auto file = MappedFile::open(in("a"));
    ASSERT_TRUE(file.has_value());
    ASSERT_TRUE(write_file(in("a"), as_byte_span("other")).has_value());
    EXPECT_EQ(as_text(file->bytes()), "text");
    fs::remove(in("a"));
    EXPECT_EQ(as_text(file->bytes()), "text");
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

TEST_F(WriteFileTest, NeverShowsAnUnfinishedFile) {
    // Whoever has opened the old file goes on reading it: the new one comes beside it, not into it.
    put(in("a"), "old");
    const int old = ::open(in("a").c_str(), O_RDONLY);
    ASSERT_GE(old, 0);
    ASSERT_TRUE(write_file(in("a"), as_byte_span("new")).has_value());
    char text[4]{};
    EXPECT_EQ(::read(old, text, 3), 3);
    EXPECT_STREQ(text, "old");
    ::close(old);
}

TEST_F(WriteFileTest, GivesTheRightsThatAnyNewFileGets) {
    for (const mode_t mask : {mode_t{022}, mode_t{027}, mode_t{077}}) {
        const mode_t before = ::umask(mask);
        const bool written = write_file(in("a"), as_byte_span("text")).has_value();
        const mode_t after = ::umask(before);
        ASSERT_TRUE(written);
        EXPECT_EQ(after, mask);  // left as it was
        struct stat status {};
        ASSERT_EQ(::stat(in("a").c_str(), &status), 0);
        EXPECT_EQ(status.st_mode & 0777u, 0666u & ~mask);
    }
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

/// Lets no file of this process grow past `bytes` while it lives.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) : signal_(std::signal(SIGXFSZ, SIG_IGN)) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, signal_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
    rlimit before_{};
    void (*signal_)(int);
};

TEST_F(WriteFileTest, LeavesTheOldFileAloneWhenTheDiskIsFull) {
    put(in("a"), "old");
    const std::string much(100'000, 'x');
    Error error;
    bool written = true;
    {
        const FileSizeLimit limit(4096);
        const auto result = write_file(in("a"), as_byte_span(much));
        written = result.has_value();
        if (!written) error = result.error();
    }
    ASSERT_FALSE(written);
    expect_error(error, ErrorCode::kCannotWrite, EFBIG);
    EXPECT_EQ(content(in("a")), "old");
    EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

}  // namespace
}  // namespace bendy
