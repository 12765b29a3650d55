#include <bendy/format/crc32c.h>

#include "crc32c_kernels.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace bendy::crc32c_test {
namespace {

/// One bit at a time, straight from the polynomial.
std::uint32_t plain_crc32c(Bytes bytes) {
    std::uint32_t sum = 0xffffffffu;
    for (const std::byte byte : bytes) {
        sum ^= std::to_integer<std::uint32_t>(byte);
        for (int bit = 0; bit < 8; ++bit) sum = (sum & 1u) != 0 ? (sum >> 1) ^ 0x82f63b78u : sum >> 1;
    }
    return ~sum;
}

std::uint32_t sum_of(const std::vector<std::uint8_t>& bytes) {
    return crc32c(std::as_bytes(std::span(bytes)));
}

TEST(Crc32c, GivesTheSumsOfRfc3720) {
    std::vector<std::uint8_t> ascending(32);
    std::vector<std::uint8_t> descending(32);
    for (std::uint8_t i = 0; i < 32; ++i) {
        ascending[i] = i;
        descending[i] = static_cast<std::uint8_t>(31 - i);
    }
    EXPECT_EQ(sum_of(std::vector<std::uint8_t>(32, 0x00)), 0x8a9136aau);
    EXPECT_EQ(sum_of(std::vector<std::uint8_t>(32, 0xff)), 0x62a8ab43u);
    EXPECT_EQ(sum_of(ascending), 0x46dd794eu);
    EXPECT_EQ(sum_of(descending), 0x113fdb5cu);
    EXPECT_EQ(sum_of({0x01, 0xc0, 0, 0,    0, 0, 0, 0,    0,    0, 0, 0, 0, 0, 0, 0, 0x14, 0, 0, 0, 0, 0, 4, 0,
                      0,    0,    0, 0x14, 0, 0, 0, 0x18, 0x28, 0, 0, 0, 0, 0, 0, 0, 0x02, 0, 0, 0, 0, 0, 0, 0}),
              0xd9963a56u);
}

TEST(Crc32c, GivesTheUsualCheckValue) {
    EXPECT_EQ(crc32c(as_byte_span("123456789")), 0xe3069283u);
}

TEST(Crc32c, OfNothingIsZero) {
    EXPECT_EQ(crc32c({}), 0u);
}

TEST(Crc32c, IsThePlainSumForEveryLengthAndAlignment) {
    std::array<std::byte, 96> bytes{};
    std::uint32_t state = 1;
    for (std::byte& byte : bytes) {
        state = state * 1664525u + 1013904223u;
        byte = static_cast<std::byte>(state >> 24);
    }
    for (std::size_t offset = 0; offset < 16; ++offset) {
        for (std::size_t length = 0; length <= 64; ++length) {
            const Bytes part = Bytes(bytes).subspan(offset, length);
            ASSERT_EQ(crc32c(part), plain_crc32c(part)) << "offset " << offset << ", length " << length;
        }
    }
}

TEST(Crc32c, GoesOnFromAnEarlierSum) {
    const Bytes whole = as_byte_span("the quick brown fox jumps over the lazy dog");
    for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
        ASSERT_EQ(crc32c(whole.subspan(cut), crc32c(whole.first(cut))), plain_crc32c(whole)) << "cut at " << cut;
    }
}

TEST(Crc32c, EveryKernelGivesThePlainSum) {
    std::vector<std::uint8_t> numbers(20'000);
    std::uint32_t state = 7;
    for (std::uint8_t& number : numbers) {
        state = state * 1664525u + 1013904223u;
        number = static_cast<std::uint8_t>(state >> 24);
    }
    const Bytes bytes = std::as_bytes(std::span(numbers));
    std::size_t tried = 0;
    for (const Crc32cKernel& kernel : crc32c_kernels()) {
        if (!kernel.is_supported()) continue;
        ++tried;
        for (std::size_t length = 0; length < bytes.size(); length += length < 100 ? 1 : 211) {
            const Bytes part = bytes.subspan(length % 13 % (bytes.size() - length), length);
            const std::size_t cut = length / 3;
            ASSERT_EQ(kernel.sum(part, 0), plain_crc32c(part)) << kernel.name << ' ' << length;
            ASSERT_EQ(kernel.sum(part.subspan(cut), kernel.sum(part.first(cut), 0)), plain_crc32c(part)) << kernel.name;
        }
    }
    EXPECT_GE(tried, 1u);
}

TEST(Crc32c, LongLanesGiveTheSameSum) {
    constexpr std::size_t kLanes = std::size_t{3} * 16384;
    std::vector<std::uint8_t> numbers(3 * kLanes);
    std::uint32_t state = 11;
    for (std::uint8_t& number : numbers) {
        state = state * 1664525u + 1013904223u;
        number = static_cast<std::uint8_t>(state >> 24);
    }
    const Bytes bytes = std::as_bytes(std::span(numbers));
    for (const Crc32cKernel& kernel : crc32c_kernels()) {
        if (!kernel.is_supported()) continue;
        for (const std::size_t length : {kLanes - 1, kLanes, kLanes + 1, kLanes + 3079, 2 * kLanes, 3 * kLanes - 5}) {
            const Bytes part = bytes.subspan(5, length);
            ASSERT_EQ(kernel.sum(part, 0), plain_crc32c(part)) << kernel.name << ' ' << length;
        }
    }
}

}  // namespace
}  // namespace bendy::crc32c_test
