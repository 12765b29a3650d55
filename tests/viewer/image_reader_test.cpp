#include "image_reader.h"

#include <bendy/viewer/picture.h>

#include <gtest/gtest.h>
#include <turbojpeg.h>
#include <webp/encode.h>
#include <zlib.h>

#include <cstring>
#include <string>

namespace bendy::viewer::image_reader_test {
namespace {

Picture gradient(std::uint32_t width, std::uint32_t height) {
    Picture picture{width, height, {}};
    for (std::uint32_t k = 0; k < width * height; ++k)
        picture.pixels.insert(picture.pixels.end(), {static_cast<std::uint8_t>(k), static_cast<std::uint8_t>(k * 7), 40,
                                                     static_cast<std::uint8_t>(k % 3 * 100)});
    return picture;
}

TEST(ImageReader, PngComesBackAsItWas) {
    const Picture picture = gradient(13, 7);
    const ReadImage read = read_image(encode_png(picture));
    EXPECT_EQ(read.problem, "");
    EXPECT_EQ(read.picture.width, 13u);
    EXPECT_EQ(read.picture.height, 7u);
    EXPECT_EQ(read.picture.pixels, picture.pixels);
}

TEST(ImageReader, EveryPrefixIsRefusedOrRead) {
    const std::vector<std::byte> bytes = encode_png(gradient(9, 9));
    for (std::size_t size = 0; size + 20 < bytes.size(); ++size) {
        const ReadImage read = read_image(Bytes(bytes).first(size));
        EXPECT_NE(read.problem, "") << size;
        EXPECT_TRUE(read.picture.pixels.empty());
    }
}

TEST(ImageReader, EveryByteMayBeWrong) {
    std::vector<std::byte> bytes = encode_png(gradient(9, 9));
    for (std::byte& byte : bytes) {
        const std::byte before = byte;
        byte ^= std::byte{0x55};
        const ReadImage read = read_image(bytes);
        if (read.problem.empty()) {
            EXPECT_EQ(read.picture.pixels.size(), read.picture.row_size() * read.picture.height);
        }
        byte = before;
    }
}

/// A PNG's header with other numbers in it.
std::vector<std::byte> with_png_size(std::vector<std::byte> bytes, std::uint32_t width, std::uint32_t height,
                                     bool is_interlaced) {
    constexpr std::size_t kHeader = 16;
    for (std::size_t k = 0; k < 4; ++k) {
        bytes[kHeader + k] = static_cast<std::byte>(width >> (24 - 8 * k));
        bytes[kHeader + 4 + k] = static_cast<std::byte>(height >> (24 - 8 * k));
    }
    bytes[kHeader + 12] = std::byte{is_interlaced};
    const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(bytes.data() + kHeader - 4), 17);
    for (std::size_t k = 0; k < 4; ++k) bytes[kHeader + 13 + k] = static_cast<std::byte>(sum >> (24 - 8 * k));
    return bytes;
}

TEST(ImageReader, ALargePictureIsRefusedBeforeItIsMade) {
    const std::vector<std::byte> png = encode_png(gradient(2, 2));
    const auto problem_of = [&](std::uint32_t width, std::uint32_t height, bool is_interlaced) {
        const std::vector<std::byte> bytes = with_png_size(png, width, height, is_interlaced);
        EXPECT_TRUE(read_image(bytes).picture.pixels.empty());
        return read_image_size(bytes).problem;
    };
    EXPECT_EQ(problem_of(16'384, 16'384, false), "is cut short: it has few bytes for 16384 x 16384");
    EXPECT_EQ(problem_of(16'384, 8'192, true), "is too large: 16384 x 8192");
    EXPECT_EQ(problem_of(16'385, 1, false), "is too large: 16385 x 1");

    // Lossless, in 34 bytes: 16,384 x 16,384, which the decoder would have in memory at once.
    const unsigned char webp[] = {'R',  'I', 'F', 'F', 26, 0, 0, 0, 'W',  'E',  'B',  'P',
                                  'V',  'P', '8', 'L', 14, 0, 0, 0, 0x2f, 0xff, 0xff, 0xff,
                                  0x0f, 0,   0,   0,   0,  0, 0, 0, 0,    0};
    const ReadImage large = read_image(std::as_bytes(std::span(webp)));
    EXPECT_EQ(large.problem, "is too large: 16384 x 16384");
}

TEST(ImageReader, ALargePngIsReadRowByRow) {
    const Picture picture{16'384, 4'100, std::vector<std::uint8_t>(std::size_t{4} * 16'384 * 4'100, 77)};
    const std::vector<std::byte> bytes = encode_png(picture);  // more pixels than may be held
    const ReadImage read = read_image(bytes, 10, Texels::linear);
    EXPECT_EQ(read.problem, "");
    EXPECT_EQ(read.picture.pixels, std::vector<std::uint8_t>(std::size_t{4} * 16 * 5, 77));
}

std::vector<std::byte> encode(const Picture& picture, bool is_webp) {
    std::uint8_t* bytes = nullptr;
    unsigned long size = 0;
    std::vector<std::byte> all;
    if (is_webp) {
        size = WebPEncodeLosslessRGBA(picture.pixels.data(), static_cast<int>(picture.width),
                                      static_cast<int>(picture.height), static_cast<int>(picture.row_size()), &bytes);
    } else {
        void* const encoder = tjInitCompress();
        EXPECT_EQ(tjCompress2(encoder, picture.pixels.data(), static_cast<int>(picture.width), 0,
                              static_cast<int>(picture.height), TJPF_RGBA, &bytes, &size, TJSAMP_444, 100, 0),
                  0);
        tjDestroy(encoder);
    }
    const auto* const from = reinterpret_cast<const std::byte*>(bytes);
    all.assign(from, from + size);
    is_webp ? WebPFree(bytes) : tjFree(bytes);
    return all;
}

/// Opaque, with the left half of one colour and the right one of another.
Picture two_colours(std::uint32_t width, std::uint32_t height) {
    Picture picture{width, height, {}};
    for (std::uint32_t k = 0; k < width * height; ++k) {
        const bool is_left = k % width < width / 2;
        for (const int value : {is_left ? 200 : 20, 100, is_left ? 10 : 250, 255})
            picture.pixels.push_back(static_cast<std::uint8_t>(value));
    }
    return picture;
}

TEST(ImageReader, EachFormatIsHalvedWhileItIsRead) {
    const Picture picture = two_colours(96, 40);
    for (const std::vector<std::byte>& bytes : {encode_png(picture), encode(picture, false), encode(picture, true)}) {
        for (const unsigned halvings : {1u, 2u, 3u, 4u}) {
            const ReadImage read = read_image(bytes, halvings);
            ASSERT_EQ(read.problem, "");
            EXPECT_EQ(read.picture.width, 96u >> halvings);
            EXPECT_EQ(read.picture.height, halved(40, halvings));
            ASSERT_EQ(read.picture.pixels.size(), read.picture.row_size() * read.picture.height);
            const std::uint8_t* const left = read.picture.pixels.data();
            const std::uint8_t* const right = read.picture.pixels.data() + read.picture.row_size() - 4;
            EXPECT_NEAR(left[0], 200, 2);
            EXPECT_NEAR(right[0], 20, 2);
            EXPECT_NEAR(right[2], 250, 2);
            EXPECT_EQ(left[3], 255);
        }
        EXPECT_EQ(read_image(bytes, 14).picture.pixels.size(), 4u);
    }
}

TEST(ImageReader, HalvedColoursAreMeansOfTheirLight) {
    const Picture picture{2, 2, {0, 0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 0}};
    // Half the light of white is 188 of 255 in sRGB.
    EXPECT_EQ(read_image(encode_png(picture), 1).picture.pixels, (std::vector<std::uint8_t>{188, 188, 188, 128}));
    EXPECT_EQ(read_image(encode_png(picture), 1, Texels::linear).picture.pixels,
              (std::vector<std::uint8_t>{128, 128, 128, 128}));
    // An odd side keeps the rest of its pixels.
    const Picture odd{3, 1, {10, 10, 10, 255, 30, 30, 30, 255, 90, 90, 90, 255}};
    EXPECT_EQ(read_image(encode_png(odd), 1, Texels::linear).picture.pixels,
              (std::vector<std::uint8_t>{20, 20, 20, 255, 90, 90, 90, 255}));
}

void put(std::vector<std::byte>& bytes, std::initializer_list<int> values) {
    for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
}

/// 2 x 2, 24 bits, from the bottom up: red, green; blue, white at the top.
std::vector<std::byte> small_bmp(int width = 2) {
    std::vector<std::byte> bytes;
    put(bytes,
        {'B', 'M', 70, 0, 0, 0, 0, 0, 0, 0, 54, 0, 0, 0, 40, 0, 0, 0, width & 255, width >> 8, 0, 0, 2, 0, 0, 0});
    put(bytes, {1, 0, 24, 0, 0, 0, 0, 0, 16, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    put(bytes, {0, 0, 255, 0, 255, 0, 0, 0, 255, 0, 0, 255, 255, 255, 0, 0});
    return bytes;
}

/// 3 x 2, 32 bits, from the top down, in runs: four of half-clear blue, then two pixels.
std::vector<std::byte> small_tga() {
    std::vector<std::byte> bytes;
    put(bytes, {0, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 2, 0, 32, 0x28});
    put(bytes, {0x83, 255, 0, 0, 128, 0x01, 1, 2, 3, 4, 5, 6, 7, 8});
    return bytes;
}

using Texels = std::vector<std::uint8_t>;

TEST(ImageReader, BmpAndTgaAreRead) {
    const ReadImage bmp = read_image(small_bmp());
    EXPECT_EQ(bmp.problem, "");
    EXPECT_EQ(bmp.picture.pixels, (Texels{0, 0, 255, 255, 255, 255, 255, 255, 255, 0, 0, 255, 0, 255, 0, 255}));
    const ReadImage tga = read_image(small_tga());
    EXPECT_EQ(tga.problem, "");
    EXPECT_EQ(tga.picture.width, 3u);
    EXPECT_EQ(tga.picture.height, 2u);
    EXPECT_EQ(tga.picture.pixels, (Texels{0, 0, 255, 128, 0, 0, 255, 128, 0, 0, 255, 128,  //
                                          0, 0, 255, 128, 3, 2, 1,   4,   7, 6, 5,   8}));
}

TEST(ImageReader, BadBmpAndTgaGiveAPictureOrAProblem) {
    for (const std::vector<std::byte>& good : {small_bmp(), small_tga()}) {
        const auto check = [](Bytes bytes) {
            const ReadImage read = read_image(bytes);
            EXPECT_EQ(read.problem.empty(), !read.picture.pixels.empty());
            EXPECT_EQ(read.picture.pixels.size(), read.picture.row_size() * read.picture.height);
        };
        for (std::size_t size = 0; size < good.size(); ++size) check(Bytes(good).first(size));
        for (std::size_t at = 0; at < good.size(); ++at) {
            for (const int wrong : {0x00, 0x01, 0x7f, 0x80, 0xff, 0x55}) {
                std::vector<std::byte> bytes = good;
                bytes[at] = static_cast<std::byte>(wrong);
                check(bytes);
            }
        }
    }
}

TEST(ImageReader, PixelsThatAShortFileLacksAreBlack) {
    std::vector<std::byte> bytes;
    put(bytes, {0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 64, 0, 64, 0, 24, 0x20, 0, 0, 0});
    const ReadImage read = read_image(bytes);
    ASSERT_EQ(read.problem, "");
    for (std::size_t at = 0; at < read.picture.pixels.size(); ++at)
        ASSERT_EQ(read.picture.pixels[at], at % 4 == 3 ? 255 : 0) << at;
}

TEST(ImageReader, ALargeBmpOrTgaIsRefusedBeforeItIsMade) {
    EXPECT_EQ(read_image(small_bmp(20'000)).problem, "is too large: 20000 x 2");
    std::vector<std::byte> tga = small_tga();
    tga[13] = tga[15] = std::byte{0x40};  // 16,387 x 16,386
    EXPECT_EQ(read_image(tga).problem, "is too large: 16387 x 16386");
}

TEST(ImageReader, OtherFormatsAreNamed) {
    const std::string text = "not a picture at all";
    EXPECT_EQ(read_image(std::as_bytes(std::span(text))).problem, "is neither PNG, JPEG, WebP, BMP nor TGA");
    EXPECT_EQ(read_image({}).problem, "is neither PNG, JPEG, WebP, BMP nor TGA");
    const unsigned char jpeg[] = {0xff, 0xd8, 0xff, 0xe0, 0, 16};
    const std::string problem = read_image(std::as_bytes(std::span(jpeg))).problem;
    EXPECT_EQ(problem.find("is not a valid JPEG: "), 0u) << problem;
}

}  // namespace
}  // namespace bendy::viewer::image_reader_test
