#include "object_reader.h"
#include "parts.h"
#include "scene/failure.h"
#include "scene/source/source_file.h"

#include <bendy/converter/import.h>

#define ZLIB_CONST  // declares zlib's input pointers const
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <new>
#include <string>
#include <string_view>

namespace bendy::converter {

namespace x {
namespace {

constexpr std::size_t kCompressedHeader = 16;
constexpr std::size_t kVariant = 8;  // offset of `tzip` or `bzip`
constexpr std::size_t kLargestBlock = 32'768;
constexpr std::string_view kSignature = "CK";

/// zlib's decompressor of raw deflate streams.
class Inflater {
public:
    Inflater() {
        if (inflateInit2(&stream_, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
    }
    ~Inflater() { inflateEnd(&stream_); }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;
    Inflater(Inflater&&) = delete;
    Inflater& operator=(Inflater&&) = delete;

    /// \param before  the preceding blocks' last bytes, or nothing
    /// \return the block; nothing if the data is damaged
    std::string_view block(std::string_view data, std::string_view before) {
        inflateReset(&stream_);
        if (!before.empty()) inflateSetDictionary(&stream_, bytes_of(before), static_cast<uInt>(before.size()));
        stream_.next_in = bytes_of(data);
        stream_.avail_in = static_cast<uInt>(data.size());
        stream_.next_out = reinterpret_cast<Bytef*>(block_.data());
        stream_.avail_out = static_cast<uInt>(block_.size());
        const int status = inflate(&stream_, Z_FINISH);
        if (status == Z_MEM_ERROR) throw std::bad_alloc();
        return status == Z_STREAM_END ? std::string_view(block_.data(), block_.size() - stream_.avail_out)
                                      : std::string_view();
    }

private:
    static const Bytef* bytes_of(std::string_view text) { return reinterpret_cast<const Bytef*>(text.data()); }

    z_stream stream_{};
    std::array<char, kLargestBlock> block_{};
};

std::uint32_t number_at(std::string_view file, std::size_t at, std::size_t size) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value |= std::uint32_t{static_cast<unsigned char>(file[at + i])} << (8 * i);
    return value;
}

/// True for `xof 0303tzip0032` and `xof 0303bzip0032`: text or binary files that are compressed after their header.
bool is_compressed(std::string_view file) {
    return file.size() >= kCompressedHeader && file.starts_with("xof ") && file.substr(kVariant + 1, 3) == "zip" &&
           (file[kVariant] == 't' || file[kVariant] == 'b');
}

/// Decompresses the file; the result includes the header. The data is MSZIP: blocks of at most 32,768 bytes, each
/// deflated with the preceding block as its dictionary (MS-MCI, section 2). Fails at the byte of a damaged block. The
/// decompressed bytes are charged to the budget as they grow.
std::string decompress(std::string_view file, Budget& budget) {
    std::string plain(file.substr(0, kCompressedHeader));
    plain.replace(kVariant, 4, file[kVariant] == 't' ? "txt " : "bin ");
    std::size_t at = kCompressedHeader;
    if (file.size() - at < 4) fail("byte 16", "expected the size of the data, found the end of the file");
    const std::uint32_t size = number_at(file, at, 4);  // including the header
    at += 4;
    Inflater inflater;
    std::string_view before;
    while (plain.size() < size) {
        const std::string place = "byte " + std::to_string(at);
        if (file.size() - at < 4 + kSignature.size())
            fail(place, "expected a compressed block, found the end of the file");
        const std::size_t due = number_at(file, at, 2);
        const std::size_t compressed = number_at(file, at + 2, 2);
        at += 4;
        if (compressed < kSignature.size() || compressed > file.size() - at)
            fail(place, "a compressed block of " + std::to_string(compressed) + " bytes does not fit into the file");
        const std::string_view data = file.substr(at, compressed);
        if (!data.starts_with(kSignature)) fail(place, "expected a compressed block that begins with CK");
        const std::string_view block = inflater.block(data.substr(kSignature.size()), before);
        if (block.empty() || block.size() != due) {
            fail(place, "a compressed block is damaged: it says " + std::to_string(due) + " bytes and holds " +
                            std::to_string(block.size()));
        }
        budget.take(block.size(), 1, place);
        plain += block;
        before = std::string_view(plain).substr(kCompressedHeader);
        before.remove_prefix(before.size() - std::min(before.size(), kLargestBlock));
        at += compressed;
    }
    return plain;
}

/// The time of the file's last key, in ticks from its first.
double last_tick(const XFile& file) {
    double last = 0.0;
    for (const AnimationSet& set : file.sets) {
        for (const Animation& animation : set.animations) {
            for (const Keys& keys : animation.keys) {
                if (!keys.times.empty()) last = std::max(last, keys.times.back());
            }
        }
    }
    return last;
}

/// Sets the length of a tick; reports the assumption if the file does not give one.
/// \param stated  by the user; 0: nothing
void set_tick(XFile& file, double stated, Report& report) {
    constexpr double kDirectX = 4800.0;
    constexpr double kFrames = 30.0;
    constexpr double kShortest = 0.1;  // seconds: no motion is shorter
    if (stated != 0.0) {
        file.ticks_per_second = stated;
        return;
    }
    if (!file.ticks_place.empty()) {
        if (file.ticks_per_second > 0.0) return;
        fail(file.ticks_place,
             "AnimTicksPerSecond must be above 0; --ticks-per-second sets the rate in place of the file's");
    }
    const double last = last_tick(file);
    const bool are_frames = last / kDirectX < kShortest;
    file.ticks_per_second = are_frames ? kFrames : kDirectX;
    if (last == 0.0) return;
    std::array<char, 240> text{};
    std::snprintf(text.data(), text.size(),
                  are_frames ? "AnimTicksPerSecond is missing, and with DirectX's 4,800 ticks a second the last key "
                               "would be at %.3g s: keys are taken as frames, 30 a second; --ticks-per-second sets "
                               "another rate"
                             : "AnimTicksPerSecond is missing: 4,800 ticks a second are assumed, as DirectX does, so "
                               "that the last key is at %.3g s; --ticks-per-second sets another rate",
                  last / kDirectX);
    report.warn(text.data(), {});
}

Scene import(std::string_view bytes, ReadableFolders folders, const XOptions& options, Report& report) {
    Budget budget;
    budget.add_source(bytes.size());
    std::string plain;
    if (is_compressed(bytes)) bytes = plain = decompress(bytes, budget);
    XFile source = read_x_file(bytes, report);
    set_tick(source, options.ticks_per_second, report);
    Scene scene;
    const FrameIndex frames(source);
    import_joints(source, scene, report);
    import_rig(source, frames, scene, report);
    NamedFiles files(std::move(folders), budget, report);
    import_materials(source, files, options.embed_images, scene, report);
    import_clips(source, frames, scene, report);
    import_meshes(source, frames, budget, scene, report);
    if (scene.joints.empty()) fail({}, "there is nothing to convert: the file has neither frames nor meshes");
    return scene;
}

}  // namespace
}  // namespace x

Result<Scene, ImportError> import_x(std::string_view bytes, const std::filesystem::path& file, const XOptions& options,
                                    Report& report) {
    return without_throwing<Scene>([&]() -> Result<Scene, ImportError> {
        return x::import(bytes, folders_of_bytes(file, options.root), options, report);
    });
}

Result<Scene, ImportError> import_x(const std::filesystem::path& file, const XOptions& options, Report& report) {
    return without_throwing<Scene>([&]() -> Result<Scene, ImportError> {
        const std::vector<std::byte> bytes = read_file(file, {});
        return x::import({reinterpret_cast<const char*>(bytes.data()), bytes.size()},
                         ReadableFolders::of(file, options.root), options, report);
    });
}

}  // namespace bendy::converter
