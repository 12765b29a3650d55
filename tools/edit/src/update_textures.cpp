#include "kept.h"

#include "renumber.h"

#include <bendy/format/records.h>

#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <vector>

namespace bendy::edit {
namespace {

bool is_image(FourCC id) {
    return id == FourCC("IMAG") || id == FourCC("LINK") || id == FourCC("SAME");
}

/// The images of every texture: their chunks.
std::vector<std::vector<std::uint32_t>> image_chunks(const Source& source) {
    std::vector<std::vector<std::uint32_t>> images;
    for (const TextureView& texture : source.document.textures) {
        images.emplace_back();
        for (const std::uint32_t child : source.tree.children(texture.chunk)) {
            if (is_image(source.tree[child].id)) images.back().push_back(child);
        }
    }
    return images;
}

/// A SAME must point to the image's new owner: if a removed texture owned a shared image, the first remaining one owns
/// it.
void repair_shared_images(const Source& source, const std::vector<bool>& stays, std::span<const std::uint32_t> now,
                          Rewrite& rewrite) {
    const auto images = image_chunks(source);
    std::map<std::uint32_t, SameRecord> moved;  // by the chunk of the removed image
    for (std::uint32_t t = 0; t < images.size(); ++t) {
        if (!stays[t]) continue;
        for (std::uint32_t k = 0; k < images[t].size(); ++k) {
            const std::uint32_t chunk = images[t][k];
            if (!(source.tree[chunk].id == FourCC("SAME"))) continue;
            SameRecord same;
            copy_at(source.tree.payload(chunk), 0, same);
            const std::uint32_t image = images[same.texture][same.image];
            if (!stays[same.texture] && moved.try_emplace(image, SameRecord{now[t], k}).second) {
                const Chunk& there = source.tree[image];
                const Bytes whole = source.tree.bytes().subspan(there.offset, kChunkHeaderSize + padded(there.size));
                rewrite.replace_whole(chunk, {whole.begin(), whole.end()});
                continue;
            }
            const SameRecord updated = stays[same.texture] ? SameRecord{now[same.texture], same.image} : moved[image];
            if (updated.texture == same.texture && updated.image == same.image) continue;
            rewrite.overwrite(chunk, 0, bytes_of(updated));
        }
    }
}

}  // namespace

void update_textures(const Source& source, const Kept& kept, Rewrite& rewrite) {
    const auto now = renumbered(kept.textures);
    bool is_changed = false;
    for (std::size_t t = 0; t < now.size(); ++t) {
        if (now[t] == t) continue;
        is_changed = true;
        if (now[t] == kNone) rewrite.remove(source.document.textures[t].chunk);
    }
    if (!is_changed) return;
    repair_shared_images(source, kept.textures, now, rewrite);
    NewNumbers numbers;
    numbers.of(Entity::texture) = now;
    for (const MaterialView& material : source.document.materials)
        renumber_leaves(source.tree, material.chunk, numbers, nullptr, nullptr, rewrite);
}

}  // namespace bendy::edit
