#include <bendy/viewer/picture_file.h>
#include <bendy/viewer/viewer_error.h>

#include <webp/encode.h>
#include <webp/mux.h>

#include <cmath>

namespace bendy::viewer {
namespace {

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

std::unique_ptr<AnimationFile> make_webp(std::uint32_t width, std::uint32_t height) {
    return std::make_unique<WebpFile>(width, height);
}

}  // namespace bendy::viewer
