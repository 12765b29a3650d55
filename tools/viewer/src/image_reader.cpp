#include "image_reader.h"

#include <png.h>
#include <turbojpeg.h>
#include <webp/decode.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <csetjmp>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <string_view>
#include <utility>

// Two formats only. Memory is zeroed, so the missing pixels of a truncated file are black.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STBI_MALLOC(size) std::calloc(1, size)
#define STBI_REALLOC(memory, size) std::realloc(memory, size)
#define STBI_FREE(memory) std::free(memory)
#include <stb/stb_image.h>

namespace bendy::viewer {
namespace {

constexpr std::uint64_t kMostSide = 16'384;
constexpr std::uint64_t kMostHeld = std::uint64_t{1} << 26u;  // pixels of an image that is decoded as a whole

enum class Decoding : std::uint8_t { by_rows, as_a_whole };

/// How many pixels a byte of an encoded image can stand for.
constexpr std::uint64_t kMostOfPng = 8256;  // deflate: 1032 bytes, of 8 pixels
constexpr std::uint64_t kMostOfJpeg = 1024;
constexpr std::uint64_t kMostOfTga = 128;

/// Returns the size of an image; a problem if it is too large, or so much larger than its bytes that most of it is
/// missing.
ImageSize size_of(std::uint64_t width, std::uint64_t height, Decoding decoding, std::uint64_t most_pixels) {
    constexpr std::uint64_t kFew = std::uint64_t{1} << 20u;
    const std::string text = std::to_string(width) + " x " + std::to_string(height);
    if (width == 0 || height == 0 || width > kMostSide || height > kMostSide ||
        (decoding == Decoding::as_a_whole && width > kMostHeld / height))
        return {0, 0, "is too large: " + text};
    if (width * height > std::max(kFew, most_pixels)) return {0, 0, "is cut short: it has few bytes for " + text};
    return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
}

Picture blank(std::uint32_t width, std::uint32_t height) {
    Picture picture{width, height, {}};
    picture.pixels.resize(picture.row_size() * height);
    return picture;
}

/// 16 bits are enough to give back every sRGB value.
constexpr std::uint32_t kWhite = 65'535;

std::array<std::uint32_t, 256> linear_values() {
    std::array<std::uint32_t, 256> values{};
    for (std::size_t k = 0; k < values.size(); ++k) {
        const double srgb = static_cast<double>(k) / 255.0;
        const double linear = srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
        values[k] = static_cast<std::uint32_t>(std::lround(linear * kWhite));
    }
    return values;
}

std::uint8_t srgb_value(std::uint64_t linear) {
    static const std::vector<std::uint8_t> values = [] {
        std::vector<std::uint8_t> all(kWhite + 1);
        for (std::size_t k = 0; k < all.size(); ++k) {
            const double value = static_cast<double>(k) / kWhite;
            const double srgb = value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055;
            all[k] = static_cast<std::uint8_t>(std::lround(255.0 * srgb));
        }
        return all;
    }();
    return values[linear];
}

/// Halves a picture whose rows come one after another: the mean of each square of pixels.
class Shrinker {
public:
    Shrinker(const ImageSize& size, unsigned halvings, Texels texels)
        : picture_(blank(halved(size.width, halvings), halved(size.height, halvings))),
          size_(size),
          halvings_(halvings),
          texels_(texels) {
        if (halvings != 0) sums_.resize(std::size_t{4} * picture_.width);
    }

    void add(const std::uint8_t* row) {
        static const std::array<std::uint32_t, 256> linear_by_value = linear_values();
        if (halvings_ == 0) {
            std::memcpy(picture_.pixels.data() + picture_.row_size() * row_, row, picture_.row_size());
            ++row_;
            return;
        }
        for (std::size_t x = 0; x < size_.width; ++x) {
            std::uint64_t* const sum = sums_.data() + 4 * (x >> halvings_);
            for (std::size_t c = 0; c < 4; ++c) {
                const std::uint8_t value = row[4 * x + c];
                sum[c] += c < 3 && texels_ == Texels::srgb ? linear_by_value[value] : value;
            }
        }
        ++rows_;
        ++row_;
        if (row_ % (1u << halvings_) == 0 || row_ == size_.height) put_means();
    }

    Picture take() && { return std::move(picture_); }

private:
    void put_means() {
        std::uint8_t* to = picture_.pixels.data() + picture_.row_size() * ((row_ - 1) >> halvings_);
        const std::uint64_t side = std::uint64_t{1} << halvings_;
        for (std::size_t x = 0; x < picture_.width; ++x) {
            const std::uint64_t count = rows_ * std::min<std::uint64_t>(side, size_.width - x * side);
            for (std::size_t c = 0; c < 4; ++c) {
                const std::uint64_t mean = (sums_[4 * x + c] + count / 2) / count;
                *to++ = c < 3 && texels_ == Texels::srgb ? srgb_value(mean) : static_cast<std::uint8_t>(mean);
            }
        }
        std::fill(sums_.begin(), sums_.end(), 0);
        rows_ = 0;
    }

    Picture picture_;
    ImageSize size_;
    unsigned halvings_;
    Texels texels_;
    std::vector<std::uint64_t> sums_;  // of the pixels of one row of the result
    std::uint64_t rows_ = 0;           // in the sums
    std::uint32_t row_ = 0;
};

/// Halves a whole picture.
Picture shrunk(const std::uint8_t* pixels, const ImageSize& size, unsigned halvings, Texels texels) {
    Shrinker shrinker(size, halvings, texels);
    for (std::size_t y = 0; y < size.height; ++y) shrinker.add(pixels + 4 * y * size.width);
    return std::move(shrinker).take();
}

Picture shrunk(Picture picture, unsigned halvings, Texels texels) {
    if (halvings == 0) return picture;
    return shrunk(picture.pixels.data(), {picture.width, picture.height, {}}, halvings, texels);
}

/// libpng reports an error by longjmp, which runs no destructors: nothing that needs one lives inside a guarded call.
class PngReader {
public:
    explicit PngReader(Bytes bytes) : left_(bytes), size_(bytes.size()) {
        png_ = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, this, fail, warn, this, allocate, release);
        if (png_ != nullptr) info_ = png_create_info_struct(png_);
        if (info_ == nullptr) throw std::bad_alloc();
    }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;
    PngReader(PngReader&&) = delete;
    PngReader& operator=(PngReader&&) = delete;
    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

    /// Reads what comes before the pixels, and asks for RGBA with 8 bits each. As glTF says, colour spaces are ignored.
    bool begin() {
        return guarded([this] {
            png_set_read_fn(png_, this, read);
            png_set_benign_errors(png_, 1);
            png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);  // texts can be any size
            png_read_info(png_, info_);
            png_set_expand(png_);
            png_set_scale_16(png_);
            png_set_gray_to_rgb(png_);
            constexpr png_uint_32 kOpaque = 255;
            png_set_add_alpha(png_, kOpaque, PNG_FILLER_AFTER);
            passes_ = png_set_interlace_handling(png_);
            png_read_update_info(png_, info_);
        });
    }
    [[nodiscard]] ImageSize size() const {
        return size_of(png_get_image_width(png_, info_), png_get_image_height(png_, info_),
                       is_interlaced() ? Decoding::as_a_whole : Decoding::by_rows, kMostOfPng * size_);
    }
    [[nodiscard]] bool is_interlaced() const { return passes_ > 1; }
    [[nodiscard]] int passes() const { return passes_; }
    /// Reads the next row; in later passes over an interlaced image, into what is there.
    bool read_row(std::uint8_t* row) {
        return guarded([this, row] { png_read_row(png_, row, nullptr); });
    }
    [[nodiscard]] std::string problem() const {
        if (is_out_of_memory_) throw std::bad_alloc();
        return std::string("is not a valid PNG: ") + message_.data();
    }

private:
    template <class Call>
    bool guarded(Call call) {
        // NOLINTNEXTLINE(cert-err52-cpp): libpng has no other way
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        call();
        return true;
    }
    [[noreturn]] static void fail(png_structp png, png_const_charp what) {
        auto& message = static_cast<PngReader*>(png_get_error_ptr(png))->message_;
        std::copy_n(what, std::min(std::strlen(what), message.size() - 1), message.begin());
        png_longjmp(png, 1);
    }
    static void warn(png_structp /*png*/, png_const_charp /*what*/) {}
    static void read(png_structp png, png_bytep to, std::size_t size) {
        Bytes& left = static_cast<PngReader*>(png_get_io_ptr(png))->left_;
        if (size > left.size()) png_error(png, "it is cut short");
        std::memcpy(to, left.data(), size);
        left = left.subspan(size);
    }
    static png_voidp allocate(png_structp png, png_alloc_size_t size) {
        void* const memory = std::malloc(size);
        if (memory == nullptr) static_cast<PngReader*>(png_get_mem_ptr(png))->is_out_of_memory_ = true;
        return memory;
    }
    static void release(png_structp /*png*/, png_voidp memory) { std::free(memory); }

    Bytes left_;
    std::uint64_t size_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    int passes_ = 1;
    bool is_out_of_memory_ = false;
    std::array<char, 200> message_{};
};

ImageSize png_size(Bytes bytes) {
    PngReader reader(bytes);
    return reader.begin() ? reader.size() : ImageSize{0, 0, reader.problem()};
}

ReadImage read_png(Bytes bytes, const ImageSize& size, unsigned halvings, Texels texels) {
    PngReader reader(bytes);
    if (!reader.begin()) return {{}, reader.problem()};
    if (reader.is_interlaced()) {
        Picture whole = blank(size.width, size.height);
        for (int pass = 0; pass < reader.passes(); ++pass) {
            for (std::size_t y = 0; y < size.height; ++y) {
                if (!reader.read_row(whole.pixels.data() + whole.row_size() * y)) return {{}, reader.problem()};
            }
        }
        return {shrunk(std::move(whole), halvings, texels), {}};
    }
    Shrinker shrinker(size, halvings, texels);
    std::vector<std::uint8_t> row(std::size_t{4} * size.width);
    for (std::uint32_t y = 0; y < size.height; ++y) {
        if (!reader.read_row(row.data())) return {{}, reader.problem()};
        shrinker.add(row.data());
    }
    return {std::move(shrinker).take(), {}};
}

/// A JPEG file and its decoder.
class JpegReader {
public:
    explicit JpegReader(Bytes bytes)
        : data_(reinterpret_cast<const unsigned char*>(bytes.data())),
          bytes_(static_cast<unsigned long>(bytes.size())) {
        if (decoder_ == nullptr) throw std::bad_alloc();
    }

    ImageSize size() {
        int width = 0;
        int height = 0;
        int subsampling = 0;
        int space = 0;
        if (tjDecompressHeader3(decoder_.get(), data_, bytes_, &width, &height, &subsampling, &space) != 0 ||
            width <= 0 || height <= 0)
            return {0, 0, problem()};
        // A progressive one is held by the decoder.
        return size_of(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), Decoding::as_a_whole,
                       kMostOfJpeg * bytes_);
    }

    ReadImage read(const ImageSize& size, unsigned halvings, Texels texels) {
        const unsigned own = std::min(halvings, 3u);  // the decoder's
        Picture picture = blank(halved(size.width, own), halved(size.height, own));
        // A damaged file is shown as far as possible. Scans are limited, because progressive files can have any number.
        const int failed =
            tjDecompress2(decoder_.get(), data_, bytes_, picture.pixels.data(), static_cast<int>(picture.width), 0,
                          static_cast<int>(picture.height), TJPF_RGBA, TJFLAG_LIMITSCANS);
        if (failed != 0 && tjGetErrorCode(decoder_.get()) == TJERR_FATAL) return {{}, problem()};
        return {shrunk(std::move(picture), halvings - own, texels), {}};
    }

private:
    [[nodiscard]] std::string problem() const {
        const std::string_view what = tjGetErrorStr2(decoder_.get());
        if (what.find("emory") != std::string_view::npos) throw std::bad_alloc();
        return "is not a valid JPEG: " + std::string(what);
    }

    struct Destroy {
        void operator()(void* decoder) const { tjDestroy(decoder); }
    };
    std::unique_ptr<void, Destroy> decoder_{tjInitDecompress()};
    const unsigned char* data_;
    unsigned long bytes_;
};

ImageSize webp_size(Bytes bytes) {
    WebPBitstreamFeatures features;
    constexpr int kLossy = 1;
    constexpr std::uint64_t kAny = std::numeric_limits<std::uint64_t>::max();  // one colour takes no bytes
    if (WebPGetFeatures(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), &features) != VP8_STATUS_OK)
        return {0, 0, "is not a valid WebP"};
    return size_of(static_cast<std::uint64_t>(features.width), static_cast<std::uint64_t>(features.height),
                   features.format == kLossy ? Decoding::by_rows : Decoding::as_a_whole, kAny);
}

ReadImage read_webp(Bytes bytes, const ImageSize& size, unsigned halvings, Texels texels) {
    const unsigned own = std::min(halvings, 5u);  // the decoder's; its sums have 32 bits
    Picture picture = blank(halved(size.width, own), halved(size.height, own));
    WebPDecoderConfig config;
    WebPInitDecoderConfig(&config);
    config.options.use_scaling = own == 0 ? 0 : 1;
    config.options.scaled_width = static_cast<int>(picture.width);
    config.options.scaled_height = static_cast<int>(picture.height);
    config.output.colorspace = MODE_RGBA;
    config.output.is_external_memory = 1;
    config.output.u.RGBA.rgba = picture.pixels.data();
    config.output.u.RGBA.stride = static_cast<int>(picture.row_size());
    config.output.u.RGBA.size = picture.pixels.size();
    const VP8StatusCode status = WebPDecode(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), &config);
    if (status == VP8_STATUS_OUT_OF_MEMORY) throw std::bad_alloc();
    if (status != VP8_STATUS_OK) return {{}, "is not a valid WebP"};
    return {shrunk(std::move(picture), halvings - own, texels), {}};
}

bool is_bmp(Bytes bytes) {
    return bytes.size() >= 2 && std::memcmp(bytes.data(), "BM", 2) == 0;
}

/// BMP or TGA, the usual textures of X and MD2 files. TGA has no signature, so bytes that are not a TGA header are not
/// reported as a bad TGA.
ImageSize bmp_or_tga_size(Bytes bytes) {
    constexpr const char* kNeither = "is neither PNG, JPEG, WebP, BMP nor TGA";
    if (bytes.size() > INT_MAX) return {0, 0, kNeither};
    int width = 0;
    int height = 0;
    int channels = 0;
    if (stbi_info_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()), &width,
                              &height, &channels) == 0)
        return {0, 0, is_bmp(bytes) ? "is not a valid BMP: " + std::string(stbi_failure_reason()) : kNeither};
    const auto magnitude = [](int side) { return static_cast<std::uint64_t>(std::abs(static_cast<long long>(side))); };
    return size_of(magnitude(width), magnitude(height), Decoding::as_a_whole, kMostOfTga * bytes.size());
}

ReadImage read_bmp_or_tga(Bytes bytes, const ImageSize& size, unsigned halvings, Texels texels) {
    int width = 0;
    int height = 0;
    int channels = 0;
    const auto drop = [](stbi_uc* pixels) { stbi_image_free(pixels); };
    const std::unique_ptr<stbi_uc, decltype(drop)> pixels(
        stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()), &width,
                              &height, &channels, STBI_rgb_alpha),
        drop);
    if (!pixels && std::strcmp(stbi_failure_reason(), "outofmem") == 0) throw std::bad_alloc();
    const bool is_read =
        pixels && static_cast<std::uint32_t>(width) == size.width && static_cast<std::uint32_t>(height) == size.height;
    if (!is_read) {
        const std::string why = pixels ? "bad size" : stbi_failure_reason();
        return {{}, std::string("is not a valid ") + (is_bmp(bytes) ? "BMP: " : "TGA: ") + why};
    }
    return {shrunk(pixels.get(), size, halvings, texels), {}};
}

template <std::size_t N>
bool begins(Bytes bytes, const std::array<unsigned char, N>& start, std::size_t at = 0) {
    return bytes.size() >= at && N <= bytes.size() - at &&
           std::equal(start.begin(), start.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at),
                      [](unsigned char a, std::byte b) { return a == std::to_integer<unsigned char>(b); });
}

enum class Format : std::uint8_t { png, jpeg, webp, other };

Format format_of(Bytes bytes) {
    constexpr std::array<unsigned char, 4> kPng{0x89, 'P', 'N', 'G'};
    constexpr std::array<unsigned char, 3> kJpeg{0xff, 0xd8, 0xff};
    constexpr std::array<unsigned char, 4> kWebp{'W', 'E', 'B', 'P'};
    if (begins(bytes, kPng)) return Format::png;
    if (begins(bytes, kJpeg)) return Format::jpeg;
    return begins(bytes, kWebp, 8) ? Format::webp : Format::other;
}

}  // namespace

ImageSize read_image_size(Bytes bytes) {
    switch (format_of(bytes)) {
        case Format::png:
            return png_size(bytes);
        case Format::jpeg:
            return JpegReader(bytes).size();
        case Format::webp:
            return webp_size(bytes);
        case Format::other:
            break;
    }
    return bmp_or_tga_size(bytes);
}

ReadImage read_image(Bytes bytes, unsigned halvings, Texels texels) {
    const ImageSize size = read_image_size(bytes);
    if (!size.problem.empty()) return {{}, size.problem};
    switch (format_of(bytes)) {
        case Format::png:
            return read_png(bytes, size, halvings, texels);
        case Format::jpeg:
            return JpegReader(bytes).read(size, halvings, texels);
        case Format::webp:
            return read_webp(bytes, size, halvings, texels);
        case Format::other:
            break;
    }
    return read_bmp_or_tga(bytes, size, halvings, texels);
}

}  // namespace bendy::viewer
