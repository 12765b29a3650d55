#pragma once

#include <bendy/format/document.h>
#include <bendy/format/readable_folders.h>

#include <cstddef>
#include <string>
#include <string_view>
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
/// be drawn. Bounded in number and size. \param folders  of images that the file only names
PagePictures draw_page_pictures(Bytes file, const ReadableFolders& folders);

/// What could be read of a file. Without a tree its grammar is broken, and the document is empty.
struct InspectedFile {
    std::string name;
    Bytes bytes;
    const ChunkTree* tree = nullptr;  ///< leaves decoded
    Document document;                ///< of the tree; with faults, what of it is good
    Faults faults;
    PagePictures pictures;
};

/// One self-contained HTML page: pictures, facts, faults, chunks, skeletons, clips, textures, materials. It loads
/// nothing, and no content of the file can run in it: the data are one block of JSON without markup characters, the
/// page's script turns them into text, and the content security policy allows only that script. The page's size is
/// bounded for any file; the page counts what it leaves out.
std::string inspect_page(const InspectedFile& file);

// The page around the data, made of page/ by cmake/embed_page.cmake.
extern const std::string_view kPageBeforeData;
extern const std::string_view kPageAfterData;

}  // namespace bendy::cli
