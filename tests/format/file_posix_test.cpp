#include "format/file_fixture.h"

#include <gtest/gtest.h>

#ifndef _WIN32
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>
#endif

namespace bendy::file_posix_test {
namespace {

using MappedFileTest = test::FileTest;
using WriteFileTest = test::FileTest;

#ifdef _WIN32

// Named, so that a run on Windows says what it leaves out.
TEST_F(MappedFileTest, RefusesAPipeWithoutWaitingForIt) {
    GTEST_SKIP() << "pipes are no files there: MappedFileOnWindows.RefusesAPipe";
}
TEST_F(MappedFileTest, FollowsALink) {
    GTEST_SKIP() << "to make a link needs rights there that a test has not";
}
TEST_F(MappedFileTest, OutlivesTheNameOfItsFile) {
    GTEST_SKIP() << "a mapped file keeps its name there: MappedFileOnWindows.IsLeftAloneByOthers";
}
TEST_F(MappedFileTest, IsKnownByItsAddress) {
    GTEST_SKIP() << "a mapped file cannot become shorter there";
}
TEST_F(WriteFileTest, KeepsTheModeOfTheOldFile) {
    GTEST_SKIP() << "files have no such rights there";
}
TEST_F(WriteFileTest, NeverShowsAnUnfinishedFile) {
    GTEST_SKIP() << "an open file is not replaced there: WriteFileOnWindows.LeavesAnOpenFileAlone";
}
TEST_F(WriteFileTest, WritesIntoAPipeAndLeavesItOne) {
    GTEST_SKIP() << "pipes are no files there";
}
TEST_F(WriteFileTest, GivesTheRightsThatAnyNewFileGets) {
    GTEST_SKIP() << "files have no such rights there";
}
TEST_F(WriteFileTest, LeavesTheOldFileAloneWhenTheDiskIsFull) {
    GTEST_SKIP() << "a process cannot limit the size of its files there";
}

#else

namespace fs = std::filesystem;
using test::expect_error;

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

TEST_F(MappedFileTest, IsKnownByItsAddress) {
    put(in("a"), "text");
    put(in("b"), "another");
    const std::byte* gone = nullptr;
    for (int turn = 0; turn < 2; ++turn) {  // an entry is used again
        const auto a = MappedFile::open(in("a"));
        auto b = MappedFile::open(in("b"));
        ASSERT_TRUE(a && b);
        const MappedFile moved(*std::move(b));
        gone = moved.bytes().data();
        EXPECT_EQ(mapped_file_at(a->bytes().data()), in("a").native());
        EXPECT_EQ(mapped_file_at(gone + 6), in("b").native());
        EXPECT_EQ(mapped_file_at(&gone), nullptr);
        EXPECT_EQ(mapped_file_at(nullptr), nullptr);
    }
    EXPECT_EQ(mapped_file_at(gone), nullptr);
}

TEST_F(WriteFileTest, KeepsTheModeOfTheOldFile) {
    put(in("a"), "old");
    for (const mode_t mode : {0600U, 0640U, 0444U, 0755U}) {
        ASSERT_EQ(::chmod(in("a").c_str(), mode), 0);
        ASSERT_TRUE(write_file(in("a"), as_byte_span("new")).has_value());
        struct stat status {};
        ASSERT_EQ(::stat(in("a").c_str(), &status), 0);
        EXPECT_EQ(status.st_mode & 07777U, mode);
    }
}

TEST_F(WriteFileTest, WritesIntoAPipeAndLeavesItOne) {
    ASSERT_EQ(::mkfifo(in("pipe").c_str(), 0600), 0);
    const int reader = ::open(in("pipe").c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    ASSERT_GE(reader, 0);
    EXPECT_TRUE(write_file(in("pipe"), as_byte_span("text")).has_value());
    std::string read(10, ' ');
    EXPECT_EQ(::read(reader, read.data(), read.size()), 4);
    EXPECT_EQ(read.substr(0, 4), "text");
    ::close(reader);
    EXPECT_TRUE(fs::is_fifo(in("pipe")));
    EXPECT_EQ(names(), std::vector<std::string>{"pipe"});
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
        fs::remove(in("a"));
        const bool written = write_file(in("a"), as_byte_span("text")).has_value();
        const mode_t after = ::umask(before);
        ASSERT_TRUE(written);
        EXPECT_EQ(after, mask);  // left as it was
        struct stat status {};
        ASSERT_EQ(::stat(in("a").c_str(), &status), 0);
        EXPECT_EQ(status.st_mode & 0777u, 0666u & ~mask);
    }
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

#endif

}  // namespace
}  // namespace bendy::file_posix_test
