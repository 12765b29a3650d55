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

/// What the window shows: a file's bytes and all that is made of them. Stays where it is made.
struct Character {
    /// Throws ViewerError if the bytes are no good file. `file_bytes` are the whole file; `is_demo`: the tentacle.
    Character(std::vector<std::byte> file_bytes, std::string name, const std::filesystem::path& folder, bool is_demo,
              const Warn& warn);
    Character(const Character&) = delete;
    Character& operator=(const Character&) = delete;
    Character(Character&&) = delete;
    Character& operator=(Character&&) = delete;
    ~Character() = default;

    [[nodiscard]] Pose& pose() const { return demo ? demo->pose() : player->pose(); }
    /// The chains' targets as they are drawn and dragged: one a chain, the demo's one.
    [[nodiscard]] std::vector<TargetMark> targets() const;
    /// A target was dragged there.
    void move_target(std::size_t number, const glm::vec3& position) const;

    std::vector<std::byte> bytes;
    std::string title;
    ChunkTree tree;
    std::unique_ptr<Model> model;
    Box box;
    std::unique_ptr<Renderer> renderer;
    std::unique_ptr<Player> player;
    std::unique_ptr<Demo> demo;  // null: a file is looked at
};

}  // namespace bendy::viewer
