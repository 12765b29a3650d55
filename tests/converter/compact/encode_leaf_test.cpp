#include "optimise/compact/leaf_writer.h"

#include <bendy/format/codec.h>

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

namespace bendy::converter::encode_leaf_test {
namespace {

/// A head of 16 bytes and rows of two u16 that walk; long enough to be judged by a sample.
std::vector<std::byte> walking_rows(std::size_t rows) {
    std::vector<std::byte> payload(16 + rows * 4);
    std::mt19937 random(5);
    std::uint16_t x = 0;
    std::uint16_t y = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        x = static_cast<std::uint16_t>(x + random() % 7);
        y = static_cast<std::uint16_t>(y + random() % 3 - 1);
        std::memcpy(payload.data() + 16 + row * 4, &x, sizeof x);
        std::memcpy(payload.data() + 16 + row * 4 + 2, &y, sizeof y);
    }
    return payload;
}

std::vector<std::byte> decode(const EncodedLeaf& leaf) {
    CodecHeader header;
    EXPECT_FALSE(check_encoded(static_cast<unsigned>(leaf.codec), leaf.bytes, header).has_value());
    std::vector<std::byte> payload(header.size);
    EXPECT_TRUE(decode_payload(leaf.codec, leaf.bytes, payload));
    return payload;
}

TEST(EncodeLeaf, ALongPayloadComesBackAndIsAsSmallAsTheBestWayMakesIt) {
    const LeafShape shape{16, 4, 2, false};
    const auto payload = walking_rows(400'000);
    const EncodedLeaf leaf = encode_leaf(payload, shape);
    ASSERT_NE(leaf.codec, Codec::raw);
    EXPECT_EQ(decode(leaf), payload);
    for (const Codec codec : {Codec::vertices, Codec::vertices_zstd}) {
        const auto other = encode_payload(codec, payload, 16, 4);
        ASSERT_TRUE(other.has_value());
        EXPECT_LE(leaf.bytes.size(), other->size());
    }
}

TEST(EncodeLeaf, ALongPayloadThatNothingMakesSmallerStays) {
    std::vector<std::byte> noise(2'000'016);
    std::mt19937 random(9);
    for (std::byte& byte : noise) byte = static_cast<std::byte>(random());
    EXPECT_EQ(encode_leaf(noise, {16, 4, 2, false}).codec, Codec::raw);
}

TEST(EncodeLeaf, WhatTheWholeCannotTakeIsNotTaken) {
    // So alike that zstd would make it decode to more than kMaxCodecRatio times its bytes, of a sample as of the whole.
    const std::vector<std::byte> zeros(8'000'016);
    const EncodedLeaf leaf = encode_leaf(zeros, {16, 4, 4, false});
    EXPECT_EQ(leaf.codec == Codec::raw ? zeros : decode(leaf), zeros);
}

}  // namespace
}  // namespace bendy::converter::encode_leaf_test
