#include <bendy/format/codec.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <vector>

namespace bendy::codec_test {
namespace {

using Buffer = std::vector<std::byte>;

Buffer decoded(Codec codec, Bytes encoded) {
    CodecHeader header;
    EXPECT_FALSE(check_encoded(static_cast<unsigned>(codec), encoded, header).has_value());
    Buffer out(header.size);
    EXPECT_TRUE(decode_payload(codec, encoded, out));
    return out;
}

/// Rows that change slowly, behind a head.
Buffer rows(std::size_t head, std::size_t stride, std::size_t count) {
    std::mt19937 random(7);
    Buffer bytes(head + stride * count);
    for (std::size_t at = 0; at < bytes.size(); ++at)
        bytes[at] = static_cast<std::byte>(
            at < head + stride ? random() : std::to_integer<unsigned>(bytes[at - stride]) + random() % 3);
    return bytes;
}

/// A strip of triangles over a grid.
std::vector<std::uint32_t> grid(std::uint32_t side) {
    std::vector<std::uint32_t> indices;
    for (std::uint32_t y = 0; y + 1 < side; ++y) {
        for (std::uint32_t x = 0; x + 1 < side; ++x) {
            const std::uint32_t a = y * side + x;
            for (const std::uint32_t index : {a, a + 1, a + side, a + side, a + 1, a + side + 1})
                indices.push_back(index);
        }
    }
    return indices;
}

template <class T>
Buffer triangles(std::size_t head, const std::vector<std::uint32_t>& indices) {
    Buffer bytes(head, std::byte{0x5a});
    for (const std::uint32_t index : indices) {
        const auto narrow = static_cast<T>(index);
        const auto raw = std::as_bytes(std::span(&narrow, 1));
        bytes.insert(bytes.end(), raw.begin(), raw.end());
    }
    return bytes;
}

TEST(Codec, RowsOfAnyWidthComeBack) {
    for (const Codec codec : {Codec::zstd, Codec::vertices, Codec::vertices_zstd}) {
        for (const std::size_t stride : {1u, 2u, 3u, 4u, 6u, 7u, 16u, 255u, 256u}) {
            for (const std::size_t count : {0u, 1u, 2u, 15u, 16u, 17u, 255u, 256u, 257u, 1000u}) {
                for (const std::size_t head : {0u, 16u, 17u, 48u}) {
                    if (codec == Codec::zstd && head != 0) continue;
                    const Buffer payload = rows(head, stride, count);
                    const auto encoded = encode_payload(codec, payload, static_cast<std::uint16_t>(head),
                                                        static_cast<std::uint16_t>(stride));
                    ASSERT_TRUE(encoded) << stride << ' ' << count << ' ' << head;
                    EXPECT_EQ(decoded(codec, *encoded), payload) << stride << ' ' << count << ' ' << head;
                }
            }
        }
    }
}

TEST(Codec, SumsComeBack) {
    for (const std::size_t stride : {2u, 4u, 8u, 256u}) {
        for (const std::size_t count : {0u, 1u, 3u, 300u}) {
            for (const std::uint16_t head : {std::uint16_t{0}, std::uint16_t{16}, std::uint16_t{48}}) {
                const Buffer payload = rows(head, stride, count);
                const auto encoded = encode_payload(Codec::sums, payload, head, static_cast<std::uint16_t>(stride));
                ASSERT_TRUE(encoded);
                EXPECT_EQ(decoded(Codec::sums, *encoded), payload) << stride << ' ' << count;
            }
        }
    }
    EXPECT_FALSE(encode_payload(Codec::sums, Buffer(9), 0, 3));
}

TEST(Codec, TrianglesComeBackOnceTheyAreCanonical) {
    for (const Codec codec : {Codec::indices, Codec::indices_zstd}) {
        for (const std::uint32_t side : {1u, 2u, 5u, 12u}) {
            const auto list = canonical_triangles(grid(side));
            ASSERT_TRUE(list);
            for (const std::uint16_t head : {std::uint16_t{0}, std::uint16_t{16}, std::uint16_t{3}}) {
                const Buffer narrow = triangles<std::uint16_t>(head, *list);
                const Buffer wide = triangles<std::uint32_t>(head, *list);
                const auto a = encode_payload(codec, narrow, head, 2);
                const auto b = encode_payload(codec, wide, head, 4);
                ASSERT_TRUE(a && b);
                EXPECT_EQ(decoded(codec, *a), narrow);
                EXPECT_EQ(decoded(codec, *b), wide);
            }
        }
    }
}

TEST(Codec, CanonicalTrianglesAreTheSameTriangles) {
    std::mt19937 random(3);
    std::vector<std::uint32_t> list;
    for (int k = 0; k < 3000; ++k) list.push_back(static_cast<std::uint32_t>(random() % 500));
    const auto canonical = canonical_triangles(list);
    ASSERT_TRUE(canonical && canonical->size() == list.size());
    for (std::size_t t = 0; t < list.size(); t += 3) {
        const std::vector<std::uint32_t> source(list.begin() + static_cast<std::ptrdiff_t>(t),
                                                list.begin() + static_cast<std::ptrdiff_t>(t + 3));
        std::vector<std::uint32_t> turned(canonical->begin() + static_cast<std::ptrdiff_t>(t),
                                          canonical->begin() + static_cast<std::ptrdiff_t>(t + 3));
        bool is_same = false;
        for (int turn = 0; turn < 3; ++turn) {
            is_same = is_same || turned == source;
            std::rotate(turned.begin(), turned.begin() + 1, turned.end());
        }
        EXPECT_TRUE(is_same) << t;
    }
    EXPECT_EQ(canonical_triangles(*canonical), canonical);
    EXPECT_FALSE(canonical_triangles(std::vector<std::uint32_t>{0, 1}));
}

TEST(Codec, WhatDoesNotFitIsNotEncoded) {
    const Buffer seven(7);
    EXPECT_FALSE(encode_payload(Codec::vertices, seven, 0, 2));
    EXPECT_FALSE(encode_payload(Codec::vertices, seven, 8, 1));
    EXPECT_FALSE(encode_payload(Codec::vertices, seven, 0, 0));
    EXPECT_FALSE(encode_payload(Codec::vertices, Buffer(514), 0, 257));
    EXPECT_FALSE(encode_payload(Codec::indices, seven, 2, 2));
    EXPECT_FALSE(encode_payload(Codec::indices, Buffer(12), 0, 3));
    EXPECT_FALSE(encode_payload(Codec::indices, seven, 8, 2));
}

TEST(Codec, WhatItDoesNotKnowIsRefused) {
    const Buffer payload(64);
    for (const unsigned codec : {0u, kCodecs, 255u}) {
        CodecHeader header;
        const auto fault = check_encoded(codec, payload, header);
        ASSERT_TRUE(fault) << codec;
        EXPECT_EQ(fault->code, ErrorCode::kUnsupportedCodec);
        Buffer out(64);
        EXPECT_FALSE(decode_payload(static_cast<Codec>(codec), payload, out));
        EXPECT_FALSE(encode_payload(static_cast<Codec>(codec), payload, 0, 0));
    }
    EXPECT_FALSE(encode_payload(Codec::zstd, payload, 1, 0));
    EXPECT_FALSE(encode_payload(Codec::clip, payload, 1, 0));
    EXPECT_FALSE(encode_payload(Codec::clip, payload, 0, 1));
}

TEST(Codec, DamageIsFoundOrHarmless) {
    struct Case {
        Codec codec;
        Buffer bytes;
    };
    std::vector<Case> cases;
    const auto list = *canonical_triangles(grid(9));
    for (const Codec codec : {Codec::vertices, Codec::vertices_zstd})
        cases.push_back({codec, *encode_payload(codec, rows(16, 6, 70), 16, 6)});
    for (const Codec codec : {Codec::indices, Codec::indices_zstd}) {
        cases.push_back({codec, *encode_payload(codec, triangles<std::uint16_t>(16, list), 16, 2)});
        cases.push_back({codec, *encode_payload(codec, triangles<std::uint32_t>(16, list), 16, 4)});
    }
    cases.push_back({Codec::sums, *encode_payload(Codec::sums, rows(16, 8, 70), 16, 8)});
    cases.push_back({Codec::zstd, *encode_payload(Codec::zstd, rows(0, 6, 70), 0, 6)});
    const auto attempt = [](Codec codec, const Buffer& bytes) {
        CodecHeader header;
        if (check_encoded(static_cast<unsigned>(codec), bytes, header)) return;
        const Buffer exact(bytes);  // its own allocation: the sanitizer sees a byte read too many
        Buffer out(header.size);
        static_cast<void>(decode_payload(codec, exact, out));
    };
    for (const Case& one : cases) {
        for (std::size_t length = 0; length < one.bytes.size(); ++length)
            attempt(one.codec, Buffer(one.bytes.begin(), one.bytes.begin() + static_cast<std::ptrdiff_t>(length)));
        for (std::size_t at = 0; at < one.bytes.size(); ++at) {
            for (const unsigned change : {0x01u, 0x80u, 0xffu, 0x10u}) {
                Buffer damaged = one.bytes;
                damaged[at] ^= static_cast<std::byte>(change);
                attempt(one.codec, damaged);
            }
        }
    }
}

TEST(Codec, ABodyIsOneFrameAndEndsWithIt) {
    const Buffer payload = rows(0, 1, 100);
    Buffer encoded = *encode_payload(Codec::zstd, payload, 0, 0);
    const Buffer empty_frame = [] {
        const Buffer whole = *encode_payload(Codec::zstd, {}, 0, 0);
        return Buffer(whole.begin() + sizeof(CodecHeader), whole.end());
    }();
    EXPECT_EQ(decoded(Codec::zstd, encoded), payload);
    encoded.insert(encoded.end(), empty_frame.begin(), empty_frame.end());
    Buffer out(payload.size());
    EXPECT_FALSE(decode_payload(Codec::zstd, encoded, out));
}

TEST(Codec, OtherVersionsOfTheMeshCodecsAreRefused) {
    const Buffer list = triangles<std::uint16_t>(0, *canonical_triangles(grid(4)));
    Buffer indices = *encode_payload(Codec::indices, list, 0, 2);
    Buffer out(list.size());
    ASSERT_EQ(indices[sizeof(CodecHeader)], std::byte{0xe1});
    indices[sizeof(CodecHeader)] = std::byte{0xe0};
    EXPECT_FALSE(decode_payload(Codec::indices, indices, out));
    Buffer vertices = *encode_payload(Codec::vertices, rows(0, 4, 20), 0, 4);
    out.resize(80);
    ASSERT_EQ(vertices[sizeof(CodecHeader)], std::byte{0xa0});
    vertices[sizeof(CodecHeader)] = std::byte{0xa1};
    EXPECT_FALSE(decode_payload(Codec::vertices, vertices, out));
}

TEST(Codec, SizesHaveALimit) {
    const CodecHeader lie{std::uint64_t{1} << 40U, 0, 4, 0};
    Buffer bytes(64);
    std::memcpy(bytes.data(), &lie, sizeof lie);
    CodecHeader header;
    const auto fault = check_encoded(static_cast<unsigned>(Codec::vertices), bytes, header);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->code, ErrorCode::kCodecRatio);
    EXPECT_FALSE(encode_payload(Codec::zstd, Buffer(1 << 20), 0, 0)) << "zeros get too small to be read again";
}

}  // namespace
}  // namespace bendy::codec_test
