#include <bendy/viewer/picture.h>

#include <gif_lib.h>
#include <gtest/gtest.h>
#include <webp/demux.h>

#include <algorithm>
#include <cstring>
#include <string>

namespace bendy::viewer::picture_test {
namespace {

Picture plain(std::uint8_t red, std::uint8_t green, std::uint8_t blue, std::uint8_t alpha = 255) {
    Picture picture{8, 6, {}};
    for (int k = 0; k < 48; ++k) picture.pixels.insert(picture.pixels.end(), {red, green, blue, alpha});
    return picture;
}

struct Reader {
    const std::vector<std::byte>* bytes;
    std::size_t at = 0;
};
int read_some(GifFileType* file, GifByteType* out, int count) {
    auto& reader = *static_cast<Reader*>(file->UserData);
    const std::size_t size = std::min<std::size_t>(static_cast<std::size_t>(count), reader.bytes->size() - reader.at);
    std::memcpy(out, reader.bytes->data() + reader.at, size);
    reader.at += size;
    return static_cast<int>(size);
}

TEST(GifFile, HoldsEveryFrameAndTheWholeLength) {
    const auto file = make_gif(8, 6);
    for (int k = 0; k < 7; ++k) file->add(plain(static_cast<std::uint8_t>(30 * k), 100, 50), k / 7.0);
    const std::vector<std::byte> bytes = file->finish(1.0);
    Reader reader{&bytes};
    int problem = 0;
    GifFileType* gif = DGifOpen(&reader, read_some, &problem);
    ASSERT_NE(gif, nullptr);
    ASSERT_EQ(DGifSlurp(gif), GIF_OK);
    EXPECT_EQ(gif->SWidth, 8);
    EXPECT_EQ(gif->SHeight, 6);
    ASSERT_EQ(gif->ImageCount, 7);
    int length = 0;
    for (int k = 0; k < 7; ++k) {
        GraphicsControlBlock control;
        ASSERT_EQ(DGifSavedExtensionToGCB(gif, k, &control), GIF_OK);
        length += control.DelayTime;
        const SavedImage& image = gif->SavedImages[k];
        const GifColorType colour = image.ImageDesc.ColorMap->Colors[image.RasterBits[20]];
        EXPECT_NEAR(colour.Red, 30 * k, 8);
        EXPECT_NEAR(colour.Green, 100, 8);
    }
    EXPECT_EQ(length, 100);
    DGifCloseFile(gif, &problem);
}

TEST(GifFile, NothingStaysNothing) {
    const auto file = make_gif(8, 6);
    file->add(plain(200, 0, 0, 0), 0.0);
    const std::vector<std::byte> bytes = file->finish(0.5);
    Reader reader{&bytes};
    int problem = 0;
    GifFileType* gif = DGifOpen(&reader, read_some, &problem);
    ASSERT_NE(gif, nullptr);
    ASSERT_EQ(DGifSlurp(gif), GIF_OK);
    GraphicsControlBlock control;
    ASSERT_EQ(DGifSavedExtensionToGCB(gif, 0, &control), GIF_OK);
    EXPECT_EQ(gif->SavedImages[0].RasterBits[0], control.TransparentColor);
    DGifCloseFile(gif, &problem);
}

TEST(WebpFile, HoldsEveryFrameAndTheWholeLength) {
    const auto file = make_webp(8, 6);
    for (int k = 0; k < 5; ++k) file->add(plain(static_cast<std::uint8_t>(50 * k), 100, 50), 0.2 * k);
    const std::vector<std::byte> bytes = file->finish(1.0);
    const WebPData data{reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
    WebPAnimDecoder* decoder = WebPAnimDecoderNew(&data, nullptr);
    ASSERT_NE(decoder, nullptr);
    int frames = 0;
    int until = 0;
    while (WebPAnimDecoderHasMoreFrames(decoder) != 0) {
        std::uint8_t* pixels = nullptr;
        ASSERT_NE(WebPAnimDecoderGetNext(decoder, &pixels, &until), 0);
        EXPECT_NEAR(pixels[0], 50 * frames, 12);
        ++frames;
    }
    EXPECT_EQ(frames, 5);
    EXPECT_EQ(until, 1000);
    WebPAnimDecoderDelete(decoder);
}

TEST(ContactSheet, FillsRowsFromTheTopLeft) {
    const std::vector<Picture> pictures{plain(1, 0, 0), plain(2, 0, 0), plain(3, 0, 0)};
    Picture empty = plain(4, 0, 0);
    for (std::size_t at = 3; at < empty.pixels.size(); at += 4) empty.pixels[at] = 7;
    const Picture sheet = contact_sheet(pictures, 2, empty);
    EXPECT_EQ(sheet.width, 16u);
    EXPECT_EQ(sheet.height, 12u);
    const auto red = [&](std::size_t x, std::size_t y) { return sheet.pixels[y * sheet.row_size() + 4 * x]; };
    EXPECT_EQ(red(0, 0), 1);
    EXPECT_EQ(red(8, 0), 2);
    EXPECT_EQ(red(7, 6), 3);
    for (std::size_t y = 6; y < 12; ++y) {
        for (std::size_t x = 8; x < 16; ++x) {
            EXPECT_EQ(red(x, y), 4);
            EXPECT_EQ(sheet.pixels[y * sheet.row_size() + 4 * x + 3], 7);
        }
    }
}

}  // namespace
}  // namespace bendy::viewer::picture_test
