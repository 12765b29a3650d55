#include "image_reader.h"

#include <bendy/viewer/picture_file.h>

#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace bendy::viewer {
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

TEST(ImageReader, OtherFormatsAreNamed) {
    const std::string text = "not a picture at all";
    EXPECT_EQ(read_image(std::as_bytes(std::span(text)), kPlenty).problem, "is neither PNG nor JPEG nor WebP");
    EXPECT_EQ(read_image({}, kPlenty).problem, "is neither PNG nor JPEG nor WebP");
    const unsigned char jpeg[] = {0xff, 0xd8, 0xff, 0xe0, 0, 16};
    const std::string problem = read_image(std::as_bytes(std::span(jpeg)), kPlenty).problem;
    EXPECT_EQ(problem.find("is no good JPEG: "), 0u) << problem;
}

}  // namespace
}  // namespace bendy::viewer
