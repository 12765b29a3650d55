#pragma once

#include <bendy/format/file.h>

#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::test {

/// An empty folder that goes away with the test.
class FileTest : public testing::Test {
protected:
    [[nodiscard]] std::filesystem::path in(const std::filesystem::path& name) const { return folder_ / name; }

    [[nodiscard]] std::vector<std::string> names() const {
        std::vector<std::string> list;
        for (const auto& entry : std::filesystem::directory_iterator(folder_))
            list.push_back(entry.path().filename().string());
        std::sort(list.begin(), list.end());
        return list;
    }

    static std::string content(const std::filesystem::path& path) {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    static void put(const std::filesystem::path& path, std::string_view text) {
        std::ofstream(path, std::ios::binary) << text;
    }

    TemporaryFolder temporary_;
    std::filesystem::path folder_ = temporary_.path();
};

/// The code, and what the system said.
inline void expect_error(const Error& error, ErrorCode code, int system) {
    EXPECT_STREQ(code_name(error.code), code_name(code));
    EXPECT_EQ(error.value, static_cast<std::uint64_t>(system));
}

}  // namespace bendy::test
