#pragma once

#include <bendy/viewer/picture.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

// Pictures as the bytes of image files. Everything here throws ViewerError when the library refuses.
namespace bendy::viewer {

std::vector<std::byte> encode_png(const Picture& picture);

/// A picture after another, all of one size, as an animation that repeats for ever.
class AnimationFile {
public:
    AnimationFile() = default;
    AnimationFile(const AnimationFile&) = delete;
    AnimationFile& operator=(const AnimationFile&) = delete;
    AnimationFile(AnimationFile&&) = delete;
    AnimationFile& operator=(AnimationFile&&) = delete;
    virtual ~AnimationFile() = default;
    /// \param seconds  when it is to be seen, from the start; ascending
    virtual void add(const Picture& picture, double seconds) = 0;
    /// \param seconds  the whole length
    virtual std::vector<std::byte> finish(double seconds) = 0;
};

/// 256 colours a picture, hundredths of a second; a pixel is there or is not.
std::unique_ptr<AnimationFile> make_gif(std::uint32_t width, std::uint32_t height);
std::unique_ptr<AnimationFile> make_webp(std::uint32_t width, std::uint32_t height);

/// Pictures of one size as one, in rows of `columns`. `empty`, of the same size, fills the last row.
Picture contact_sheet(const std::vector<Picture>& pictures, std::uint32_t columns, const Picture& empty);

}  // namespace bendy::viewer
