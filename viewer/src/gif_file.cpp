#include <bendy/viewer/picture_file.h>
#include <bendy/viewer/viewer_error.h>

#include <gif_lib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

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
        // Netscape's looping block: 1, then how often, 0 for ever.
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
        // A frame says how long it stays, which is known when the next one comes.
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
        int colours = kColours - 1;  // the last one is nothing
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
        // Rounded from the start, so that the whole length is right.
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
    long written_ = 0;  // hundredths
};

}  // namespace

std::unique_ptr<AnimationFile> make_gif(std::uint32_t width, std::uint32_t height) {
    return std::make_unique<GifFile>(width, height);
}

}  // namespace bendy::viewer
