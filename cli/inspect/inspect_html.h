#pragma once

#include "inspect/page_pictures.h"

#include <bendy/format/document.h>

#include <string>

namespace bendy::cli {

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

}  // namespace bendy::cli
