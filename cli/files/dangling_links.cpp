#include "files/dangling_links.h"

#include <bendy/converter/source_format.h>
#include <bendy/format/decode_leaves.h>
#include <bendy/format/document.h>

#include <system_error>

namespace bendy::cli {

std::vector<DanglingLink> find_dangling_links(const std::filesystem::path& file, Bytes bytes) {
    Result<ChunkTree> tree = read_chunk_tree(bytes);
    if (!tree) return {};
    decode_leaves(*tree);
    Faults ignored;
    const Document document = read_document(*tree, ignored);
    std::vector<DanglingLink> dangling;
    for (const TextureView& texture : document.textures) {
        for (const ImageView& image : texture.images) {
            if (image.uri.empty()) continue;
            const auto linked = converter::linked_file(image.uri, file);
            std::error_code problem;
            if (linked && !std::filesystem::exists(*linked, problem))
                dangling.push_back({(*tree)[image.chunk].offset, std::string(image.uri)});
        }
    }
    return dangling;
}

}  // namespace bendy::cli
