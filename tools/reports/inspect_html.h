#pragma once

#include <bendy/format/document.h>
#include <bendy/format/readable_folders.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::tools {

/// A picture of the character for the page of `inspect --html`.
struct PagePicture {
    std::string name;  ///< the clip's; empty: the rest pose
    bool is_clip = false;
    std::string media_type;  ///< image/png, image/webp
    std::vector<std::byte> bytes;
};

struct PagePictures {
    std::vector<PagePicture> list;
    std::size_t clips_left_out = 0;  ///< number of clips beyond the page's limit
    std::string why_none;            ///< if there are no pictures: the reason
};

/// Draws the rest pose, and the first clips as repeating animations; empty for a file with faults, or if drawing is not
/// possible. Limited in number and size. \param folders  those of the images that the file links to
PagePictures draw_page_pictures(Bytes file, const ReadableFolders& folders);

/// As much of a file as could be read. If its grammar is broken, the tree is null and the document is empty.
struct InspectedFile {
    std::string name;
    Bytes bytes;
    const ChunkTree* tree = nullptr;  ///< with decoded leaves
    Document document;                ///< made from the tree; with faults, the valid part of it
    Faults faults;
    PagePictures pictures;
};

/// One self-contained HTML page: pictures, facts, faults, chunks, skeletons, clips, textures, materials. It loads
/// nothing, and the file's content cannot run in it: the data is one block of JSON without markup characters, the
/// page's script turns it into text, and the content security policy allows only that script. The page's size is
/// bounded for any file; the page counts what it leaves out.
std::string inspect_page(const InspectedFile& file);

// The page around the data, made from page/ by cmake/embed_page.cmake.
extern const std::string_view kPageBeforeData;
extern const std::string_view kPageAfterData;

}  // namespace bendy::tools
