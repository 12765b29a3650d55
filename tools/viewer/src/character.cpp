#include "character.h"

#include <bendy/format/diagnostics.h>

#include <glm/common.hpp>

#include <algorithm>
#include <cstdint>

namespace bendy::viewer {
namespace {

constexpr std::uint64_t kMostTextureBytesInWindow = std::uint64_t{512} << 20u;

Model open_model(Bytes bytes, const std::string& title) {
    Result<Model> model = Model::from_memory(bytes);
    if (!model) throw ViewerError(title + ": " + describe_with_place(model.error(), bytes));
    return *std::move(model);
}

/// Returns a box around the character at rest and in its first clips.
Box box_of(const Model& model) {
    constexpr std::size_t kClips = 4;
    Box box = bounding_box(model, nullptr);
    for (std::size_t k = 0; k < std::min(kClips, model.clips().size()); ++k) {
        const Box more = bounding_box(model, &model.clips()[k]);
        box = {glm::min(box.low, more.low), glm::max(box.high, more.high)};
    }
    return box;
}

}  // namespace

Character::Character(std::vector<std::byte> file_bytes, std::string name, const ReadableFolders& folders, bool is_demo,
                     const Warn& warn)
    : bytes(std::move(file_bytes)), title(std::move(name)) {
    model = std::make_unique<Model>(open_model(bytes, title));
    if (is_demo && model->chains().empty()) throw ViewerError(title + ": has no IK chain");
    Result<ChunkTree> chunks = read_chunk_tree(bytes);
    if (chunks) tree = *std::move(chunks);
    box = box_of(*model);
    renderer = std::make_unique<Renderer>(*model, folders, warn);
    renderer->set_box(box);
    // The window can become larger, and the camera can go near.
    renderer->load_textures({2.0 * kMostPixels, kMostTextureBytesInWindow});
    player = std::make_unique<Player>(*model);
    if (is_demo) demo = std::make_unique<Demo>(*model);
}

std::vector<TargetMark> Character::targets() const {
    if (demo) return {{demo->state().target, demo->tip(), demo->state().inverse}};
    std::vector<TargetMark> marks;
    for (std::size_t k = 0; k < player->chains.size(); ++k) {
        const ChainControl& control = player->chains[k];
        marks.push_back({control.target, tip_of(model->chains()[k], player->pose()), control.is_on});
    }
    return marks;
}

void Character::move_target(std::size_t number, const glm::vec3& position) const {
    if (demo) {
        demo->drag_target(position);
    } else {
        player->chains[number].target = position;
        player->chains[number].is_on = true;
    }
}

}  // namespace bendy::viewer
