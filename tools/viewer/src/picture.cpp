#include <bendy/viewer/picture.h>

#include <gif_lib.h>
#include <png.h>
#include <webp/encode.h>
#include <webp/mux.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace bendy::viewer {
namespace {

constexpr int kColours = 256;

int append(GifFileType* file, const GifByteType* data, int size) {
    auto& bytes = *static_cast<std::vector<std::byte>*>(file->UserData);
    const auto* from = reinterpret_cast<const std::byte*>(data);
    bytes.insert(bytes.end(), from, from + size);
    return size;
}

class GifFile : public AnimationFile {
public:
    GifFile(std::uint32_t width, std::uint32_t height)
        : width_(static_cast<int>(width)), height_(static_cast<int>(height)) {
        int problem = 0;
        file_ = EGifOpen(&bytes_, append, &problem);
        if (file_ == nullptr) fail(problem);
        EGifSetGifVersion(file_, true);
        if (EGifPutScreenDesc(file_, width_, height_, 8, 0, nullptr) == GIF_ERROR) fail(file_->Error);
        // Netscape's looping block: 1, then the number of repetitions; 0 means for ever.
        constexpr std::array<GifByteType, 3> kForEver{1, 0, 0};
        if (EGifPutExtensionLeader(file_, APPLICATION_EXT_FUNC_CODE) == GIF_ERROR ||
            EGifPutExtensionBlock(file_, 11, "NETSCAPE2.0") == GIF_ERROR ||
            EGifPutExtensionBlock(file_, kForEver.size(), kForEver.data()) == GIF_ERROR ||
            EGifPutExtensionTrailer(file_) == GIF_ERROR)
            fail(file_->Error);
    }
    GifFile(const GifFile&) = delete;
    GifFile& operator=(const GifFile&) = delete;
    GifFile(GifFile&&) = delete;
    GifFile& operator=(GifFile&&) = delete;
    ~GifFile() override {
        int ignored = 0;
        if (file_ != nullptr) EGifCloseFile(file_, &ignored);
    }

    void add(const Picture& picture, double seconds) override {
        // A frame stores its duration, which is known when the next frame arrives.
        if (has_waiting_) put(waiting_, seconds - waiting_since_);
        waiting_ = picture;
        waiting_since_ = seconds;
        has_waiting_ = true;
    }

    std::vector<std::byte> finish(double seconds) override {
        if (has_waiting_) put(waiting_, seconds - waiting_since_);
        int problem = 0;
        const int closed = EGifCloseFile(file_, &problem);
        file_ = nullptr;
        if (closed == GIF_ERROR) fail(problem);
        return std::move(bytes_);
    }

private:
    [[noreturn]] static void fail(int problem) {
        const char* text = GifErrorString(problem);
        throw ViewerError(std::string("GIF: ") + (text == nullptr ? "out of memory" : text));
    }

    void put(const Picture& picture, double seconds) {
        const std::size_t count = std::size_t{picture.width} * picture.height;
        std::array<std::vector<GifByteType>, 3> parts;
        for (std::size_t c = 0; c < 3; ++c) {
            parts[c].resize(count);
            for (std::size_t k = 0; k < count; ++k) parts[c][k] = picture.pixels[4 * k + c];
        }
        int colours = kColours - 1;  // the last one means transparent
        ColorMapObject* map = GifMakeMapObject(kColours, nullptr);
        std::vector<GifByteType> picked(count);
        if (map == nullptr ||
            GifQuantizeBuffer(static_cast<unsigned>(width_), static_cast<unsigned>(height_), &colours, parts[0].data(),
                              parts[1].data(), parts[2].data(), picked.data(), map->Colors) == GIF_ERROR) {
            GifFreeMapObject(map);
            throw ViewerError("GIF: out of memory");
        }
        bool has_nothing = false;
        for (std::size_t k = 0; k < count; ++k) {
            constexpr std::uint8_t kHalf = 128;
            if (picture.pixels[4 * k + 3] >= kHalf) continue;
            picked[k] = kColours - 1;
            has_nothing = true;
        }
        // The end is rounded, not the duration, so that rounding errors do not add up.
        shown_ += seconds;
        const long until = std::lround(100.0 * shown_);
        GraphicsControlBlock control{};
        control.DisposalMode = has_nothing ? DISPOSE_BACKGROUND : DISPOSE_DO_NOT;
        control.DelayTime = static_cast<int>(std::clamp(until - written_, 2L, 60'000L));
        written_ = until;
        control.TransparentColor = has_nothing ? kColours - 1 : NO_TRANSPARENT_COLOR;
        std::array<GifByteType, 4> extension{};
        EGifGCBToExtension(&control, extension.data());
        int state = EGifPutExtension(file_, GRAPHICS_EXT_FUNC_CODE, extension.size(), extension.data());
        if (state != GIF_ERROR) state = EGifPutImageDesc(file_, 0, 0, width_, height_, false, map);
        GifFreeMapObject(map);
        for (std::size_t y = 0; y < picture.height && state != GIF_ERROR; ++y)
            state = EGifPutLine(file_, picked.data() + y * picture.width, width_);
        if (state == GIF_ERROR) fail(file_->Error);
    }

    int width_;
    int height_;
    GifFileType* file_ = nullptr;
    std::vector<std::byte> bytes_;
    Picture waiting_;
    double waiting_since_ = 0.0;
    bool has_waiting_ = false;
    double shown_ = 0.0;
    long written_ = 0;  // hundredths of a second
};

class WebpFile : public AnimationFile {
public:
    WebpFile(std::uint32_t width, std::uint32_t height) {
        WebPAnimEncoderOptions options;
        WebPAnimEncoderOptionsInit(&options);
        encoder_ = WebPAnimEncoderNew(static_cast<int>(width), static_cast<int>(height), &options);
        if (encoder_ == nullptr) throw ViewerError("WebP: no animation of this size");
        WebPConfigInit(&config_);
        constexpr float kQuality = 90.0f;
        config_.quality = kQuality;
    }
    WebpFile(const WebpFile&) = delete;
    WebpFile& operator=(const WebpFile&) = delete;
    WebpFile(WebpFile&&) = delete;
    WebpFile& operator=(WebpFile&&) = delete;
    ~WebpFile() override { WebPAnimEncoderDelete(encoder_); }

    void add(const Picture& picture, double seconds) override {
        WebPPicture frame;
        WebPPictureInit(&frame);
        frame.width = static_cast<int>(picture.width);
        frame.height = static_cast<int>(picture.height);
        frame.use_argb = 1;
        const bool is_good =
            WebPPictureImportRGBA(&frame, picture.pixels.data(), static_cast<int>(picture.row_size())) != 0 &&
            WebPAnimEncoderAdd(encoder_, &frame, milliseconds(seconds), &config_) != 0;
        WebPPictureFree(&frame);
        if (!is_good) fail();
    }

    std::vector<std::byte> finish(double seconds) override {
        WebPData data;
        WebPDataInit(&data);
        if (WebPAnimEncoderAdd(encoder_, nullptr, milliseconds(seconds), nullptr) == 0 ||
            WebPAnimEncoderAssemble(encoder_, &data) == 0)
            fail();
        const auto* from = reinterpret_cast<const std::byte*>(data.bytes);
        std::vector<std::byte> bytes(from, from + data.size);
        WebPDataClear(&data);
        return bytes;
    }

private:
    static int milliseconds(double seconds) { return static_cast<int>(std::lround(1000.0 * seconds)); }
    [[noreturn]] void fail() { throw ViewerError(std::string("WebP: ") + WebPAnimEncoderGetError(encoder_)); }

    WebPAnimEncoder* encoder_ = nullptr;
    WebPConfig config_{};
};

}  // namespace

std::vector<std::byte> encode_png(const Picture& picture) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = picture.width;
    image.height = picture.height;
    image.format = PNG_FORMAT_RGBA;
    const bool is_opaque = [&] {
        for (std::size_t at = 3; at < picture.pixels.size(); at += 4) {
            if (picture.pixels[at] != 255) return false;
        }
        return true;
    }();
    std::vector<std::uint8_t> opaque;
    if (is_opaque) {
        image.format = PNG_FORMAT_RGB;
        opaque.reserve(picture.pixels.size() / 4 * 3);
        for (std::size_t at = 0; at + 4 <= picture.pixels.size(); at += 4)
            opaque.insert(opaque.end(), {picture.pixels[at], picture.pixels[at + 1], picture.pixels[at + 2]});
    }
    const std::vector<std::uint8_t>& pixels = is_opaque ? opaque : picture.pixels;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::vector<std::byte> bytes(size);
    if (png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels.data(), 0, nullptr) == 0)
        throw ViewerError(std::string("PNG: ") + image.message);
    bytes.resize(size);
    return bytes;
}

std::unique_ptr<AnimationFile> make_gif(std::uint32_t width, std::uint32_t height) {
    return std::make_unique<GifFile>(width, height);
}

std::unique_ptr<AnimationFile> make_webp(std::uint32_t width, std::uint32_t height) {
    return std::make_unique<WebpFile>(width, height);
}

Picture contact_sheet(const std::vector<Picture>& pictures, std::uint32_t columns, const Picture& empty) {
    const Picture& first = pictures.front();
    const auto rows = (static_cast<std::uint32_t>(pictures.size()) + columns - 1) / columns;
    Picture sheet{columns * first.width, rows * first.height, {}};
    sheet.pixels.resize(sheet.row_size() * sheet.height);
    for (std::size_t k = 0; k < std::size_t{rows} * columns; ++k) {
        const Picture& picture = k < pictures.size() ? pictures[k] : empty;
        const std::size_t left = (k % columns) * first.row_size();
        const std::size_t top = (k / columns) * first.height;
        for (std::size_t y = 0; y < first.height; ++y) {
            const auto from = static_cast<std::ptrdiff_t>(y * first.row_size());
            const auto to = static_cast<std::ptrdiff_t>((top + y) * sheet.row_size() + left);
            std::copy_n(picture.pixels.begin() + from, first.row_size(), sheet.pixels.begin() + to);
        }
    }
    return sheet;
}

}  // namespace bendy::viewer
