#pragma once

#include <bendy/format/byte_reader.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace bendy::cli {

/// A picture of the character for the page of `inspect --html`.
struct PagePicture {
    std::string name;  ///< of the clip; empty: the rest pose
    bool is_clip = false;
    std::string media_type;  ///< image/png, image/webp
    std::vector<std::byte> bytes;
};

struct PagePictures {
    std::vector<PagePicture> list;
    std::size_t clips_left_out = 0;  ///< there are more than the page shows
    std::string why_none;            ///< where the list is empty: what is in the way
};

/// The rest pose, and the first clips as animations that repeat; nothing for a file with faults, or where nothing can
/// be drawn. Bounded in number and size. \param folder  of images that the file only names
PagePictures draw_page_pictures(Bytes file, const std::filesystem::path& folder);

}  // namespace bendy::cli
