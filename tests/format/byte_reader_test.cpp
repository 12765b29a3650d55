#include <bendy/format/byte_reader.h>

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <span>

namespace bendy::byte_reader_test {
namespace {

constexpr std::uint64_t kHuge = std::numeric_limits<std::uint64_t>::max();

TEST(ByteReader, ViewsWhatLiesInside) {
    const std::array<std::uint32_t, 4> numbers{1, 2, 3, 4};
    const Bytes bytes = std::as_bytes(std::span(numbers));
    EXPECT_EQ(view_at<std::uint32_t>(bytes, 0, 4).data(), numbers.data());
    EXPECT_EQ(view_at<std::uint32_t>(bytes, 8, 2).back(), 4u);
    EXPECT_TRUE(view_at<std::uint32_t>(bytes, 16, 0).empty());
    EXPECT_TRUE(view_at<std::uint32_t>(bytes, 8, 3).empty());
    EXPECT_TRUE(view_at<std::uint32_t>(bytes, 0, kHuge / 4 + 2).empty());  // times 4 it would be 4
    EXPECT_TRUE(view_at<std::uint32_t>(bytes, 20, 0).empty());
    EXPECT_TRUE(view_at<std::uint32_t>(bytes, kHuge, 1).empty());
}

TEST(ByteReader, CopiesNoMoreThanThereIs) {
    const std::array<std::uint32_t, 2> numbers{0x01020304, 0x05060708};
    const Bytes bytes = std::as_bytes(std::span(numbers));
    std::uint64_t value = ~std::uint64_t{0};
    copy_at(bytes, 4, value);
    EXPECT_EQ(value, 0xffffffff05060708u);
    copy_at(bytes, 8, value);
    copy_at(bytes, kHuge, value);
    EXPECT_EQ(value, 0xffffffff05060708u);
}

}  // namespace
}  // namespace bendy::byte_reader_test
