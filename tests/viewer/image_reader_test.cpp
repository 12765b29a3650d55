#include "image_reader.h"

#include <bendy/viewer/picture.h>

#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace bendy::viewer::image_reader_test {
namespace {

constexpr std::uint64_t kPlenty = 1u << 20u;

Picture gradient(std::uint32_t width, std::uint32_t height) {
    Picture picture{width, height, {}};
    for (std::uint32_t k = 0; k < width * height; ++k)
        picture.pixels.insert(picture.pixels.end(), {static_cast<std::uint8_t>(k), static_cast<std::uint8_t>(k * 7), 40,
                                                     static_cast<std::uint8_t>(k % 3 * 100)});
    return picture;
}

TEST(ImageReader, PngComesBackAsItWas) {
    const Picture picture = gradient(13, 7);
    const ReadImage read = read_image(encode_png(picture), kPlenty);
    EXPECT_EQ(read.problem, "");
    EXPECT_EQ(read.picture.width, 13u);
    EXPECT_EQ(read.picture.height, 7u);
    EXPECT_EQ(read.picture.pixels, picture.pixels);
}

TEST(ImageReader, EveryPrefixIsRefusedOrRead) {
    const std::vector<std::byte> bytes = encode_png(gradient(9, 9));
    for (std::size_t size = 0; size + 20 < bytes.size(); ++size) {
        const ReadImage read = read_image(Bytes(bytes).first(size), kPlenty);
        EXPECT_NE(read.problem, "") << size;
        EXPECT_TRUE(read.picture.pixels.empty());
    }
}

TEST(ImageReader, EveryByteMayBeWrong) {
    std::vector<std::byte> bytes = encode_png(gradient(9, 9));
    for (std::byte& byte : bytes) {
        const std::byte before = byte;
        byte ^= std::byte{0x55};
        const ReadImage read = read_image(bytes, kPlenty);
        if (read.problem.empty()) {
            EXPECT_EQ(read.picture.pixels.size(), read.picture.row_size() * read.picture.height);
        }
        byte = before;
    }
}

TEST(ImageReader, ALargePictureIsRefusedBeforeItIsMade) {
    // A header that says 16,000 x 16,000: a gigabyte.
    std::vector<std::byte> bytes = encode_png(gradient(2, 2));
    const ReadImage small = read_image(bytes, 3);
    EXPECT_NE(small.problem.find("too large"), std::string::npos);
    EXPECT_TRUE(small.picture.pixels.empty());

    const unsigned char webp[] = {'R',  'I', 'F', 'F', 26, 0, 0, 0, 'W',  'E',  'B',  'P',
                                  'V',  'P', '8', 'L', 14, 0, 0, 0, 0x2f, 0xff, 0xff, 0xff,
                                  0x0f, 0,   0,   0,   0,  0, 0, 0, 0,    0};
    const ReadImage large = read_image(std::as_bytes(std::span(webp)), kPlenty);
    EXPECT_NE(large.problem.find("too large: 16384 x 16384"), std::string::npos) << large.problem;
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
    const ReadImage bmp = read_image(small_bmp(), kPlenty);
    EXPECT_EQ(bmp.problem, "");
    EXPECT_EQ(bmp.picture.pixels, (Texels{0, 0, 255, 255, 255, 255, 255, 255, 255, 0, 0, 255, 0, 255, 0, 255}));
    const ReadImage tga = read_image(small_tga(), kPlenty);
    EXPECT_EQ(tga.problem, "");
    EXPECT_EQ(tga.picture.width, 3u);
    EXPECT_EQ(tga.picture.height, 2u);
    EXPECT_EQ(tga.picture.pixels, (Texels{0, 0, 255, 128, 0, 0, 255, 128, 0, 0, 255, 128,  //
                                          0, 0, 255, 128, 3, 2, 1,   4,   7, 6, 5,   8}));
}

TEST(ImageReader, BadBmpAndTgaGiveAPictureOrAProblem) {
    for (const std::vector<std::byte>& good : {small_bmp(), small_tga()}) {
        const auto check = [](Bytes bytes) {
            const ReadImage read = read_image(bytes, 4096);
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
    const ReadImage read = read_image(bytes, kPlenty);
    ASSERT_EQ(read.problem, "");
    for (std::size_t at = 0; at < read.picture.pixels.size(); ++at)
        ASSERT_EQ(read.picture.pixels[at], at % 4 == 3 ? 255 : 0) << at;
}

TEST(ImageReader, ALargeBmpOrTgaIsRefusedBeforeItIsMade) {
    EXPECT_EQ(read_image(small_bmp(20'000), kPlenty).problem, "is too large: 20000 x 2");
    EXPECT_EQ(read_image(small_tga(), 5).problem, "is too large: 3 x 2");
}

TEST(ImageReader, OtherFormatsAreNamed) {
    const std::string text = "not a picture at all";
    EXPECT_EQ(read_image(std::as_bytes(std::span(text)), kPlenty).problem, "is neither PNG, JPEG, WebP, BMP nor TGA");
    EXPECT_EQ(read_image({}, kPlenty).problem, "is neither PNG, JPEG, WebP, BMP nor TGA");
    const unsigned char jpeg[] = {0xff, 0xd8, 0xff, 0xe0, 0, 16};
    const std::string problem = read_image(std::as_bytes(std::span(jpeg)), kPlenty).problem;
    EXPECT_EQ(problem.find("is not a valid JPEG: "), 0u) << problem;
}

}  // namespace
}  // namespace bendy::viewer::image_reader_test
