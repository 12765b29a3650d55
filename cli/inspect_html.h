#pragma once

#include "page_pictures.h"

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

/// One self-contained HTML page: pictures, facts, faults, chunks, skeletons, cycles, textures, materials. It loads
/// nothing, and nothing in the file can run in it: the file's data stand in one block of JSON without markup
/// characters, the page's script makes text of them, and its content security policy allows that script alone. Bounded
/// in size for any file; what is left out is counted on the page.
std::string inspect_page(const InspectedFile& file);

}  // namespace bendy::cli
