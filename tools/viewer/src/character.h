#pragma once

#include "players.h"
#include "renderer.h"

#include <bendy/format/chunk_reader.h>
#include <bendy/runtime.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace bendy::viewer {

/// The content of the window: a file's bytes and everything made from them. It cannot be moved.
struct Character {
    /// Throws ViewerError if the file is invalid. `file_bytes` is the whole file; `is_demo`: it is the tentacle.
    Character(std::vector<std::byte> file_bytes, std::string name, const ReadableFolders& folders, bool is_demo,
              const Warn& warn);
    Character(const Character&) = delete;
    Character& operator=(const Character&) = delete;
    Character(Character&&) = delete;
    Character& operator=(Character&&) = delete;
    ~Character() = default;

    [[nodiscard]] Pose& pose() const { return demo ? demo->pose() : player->pose(); }
    /// Returns the targets to draw and drag: one for each chain; in the demo, one.
    [[nodiscard]] std::vector<TargetMark> targets() const;
    /// Moves the target that the user drags.
    void move_target(std::size_t number, const glm::vec3& position) const;

    std::vector<std::byte> bytes;
    std::string title;
    ChunkTree tree;
    std::unique_ptr<Model> model;
    Box box;
    std::unique_ptr<Renderer> renderer;
    std::unique_ptr<Player> player;
    std::unique_ptr<Demo> demo;  // null: a file is shown
};

}  // namespace bendy::viewer
