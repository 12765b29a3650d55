#ifdef _WIN32
#include "format/file_fixture.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#define WIN32_LEAN_AND_MEAN
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <windows.h>

namespace bendy::file_windows_test {
namespace {

namespace fs = std::filesystem;
using test::expect_error;
using MappedFileOnWindows = test::FileTest;
using WriteFileOnWindows = test::FileTest;

TEST_F(MappedFileOnWindows, IsLeftAloneByOthers) {
    put(in("a"), "old");
    {
        const auto file = MappedFile::open(in("a"));
        ASSERT_TRUE(file.has_value());
        const auto written = write_file(in("a"), as_byte_span("new"));
        ASSERT_FALSE(written.has_value());
        expect_error(written.error(), ErrorCode::kCannotWrite, EBUSY);
        EXPECT_FALSE(std::ofstream(in("a"), std::ios::binary).is_open());
        std::error_code refused;
        EXPECT_FALSE(fs::remove(in("a"), refused));
        fs::rename(in("a"), in("b"), refused);
        EXPECT_TRUE(refused);
        EXPECT_EQ(names(), std::vector<std::string>{"a"});
        EXPECT_EQ(as_text(file->bytes()), "old");
        EXPECT_EQ(content(in("a")), "old");  // by another reader
        EXPECT_TRUE(MappedFile::open(in("a")).has_value());
    }
    EXPECT_TRUE(write_file(in("a"), as_byte_span("new")).has_value());
    EXPECT_EQ(content(in("a")), "new");
}

TEST_F(MappedFileOnWindows, LetsGoWhenItIsMovedFrom) {
    put(in("a"), "old");
    auto file = MappedFile::open(in("a"));
    ASSERT_TRUE(file.has_value());
    { const MappedFile moved(std::move(*file)); }
    EXPECT_TRUE(write_file(in("a"), as_byte_span("new")).has_value());
}

TEST_F(MappedFileOnWindows, RefusesAFileThatIsBeingWritten) {
    std::ofstream writer(in("a"), std::ios::binary);
    writer << "half" << std::flush;
    const auto file = MappedFile::open(in("a"));
    ASSERT_FALSE(file.has_value());
    expect_error(file.error(), ErrorCode::kCannotOpen, EBUSY);
}

TEST_F(MappedFileOnWindows, RefusesAPipe) {
    const std::wstring name = LR"(\\.\pipe\bendy_test_)" + folder_.filename().wstring();
    const HANDLE pipe = ::CreateNamedPipeW(name.c_str(), PIPE_ACCESS_DUPLEX, PIPE_TYPE_BYTE, 1, 64, 64, 0, nullptr);
    ASSERT_NE(pipe, INVALID_HANDLE_VALUE);
    const auto file = MappedFile::open(name);
    ::CloseHandle(pipe);
    ASSERT_FALSE(file.has_value());
    expect_error(file.error(), ErrorCode::kCannotRead, EINVAL);
}

TEST_F(MappedFileOnWindows, RefusesADevice) {
    const auto file = MappedFile::open("NUL");
    ASSERT_FALSE(file.has_value());
    expect_error(file.error(), ErrorCode::kCannotRead, EINVAL);
}

TEST_F(WriteFileOnWindows, LeavesAnOpenFileAlone) {
    put(in("a"), "old");
    std::ifstream reader(in("a"), std::ios::binary);
    const auto written = write_file(in("a"), as_byte_span("new"));
    ASSERT_FALSE(written.has_value());
    expect_error(written.error(), ErrorCode::kCannotWrite, EBUSY);
    EXPECT_EQ(content(in("a")), "old");
    EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

TEST_F(WriteFileOnWindows, TakesEitherSlash) {
    fs::create_directory(in("folder"));
    const std::wstring folder = folder_.wstring();
    ASSERT_TRUE(write_file(folder + L"/folder\\a", as_byte_span("text")).has_value());
    EXPECT_EQ(content(in("folder") / "a"), "text");
}

}  // namespace
}  // namespace bendy::file_windows_test
#endif
