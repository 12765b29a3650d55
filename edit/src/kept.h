#pragma once

#include <bendy/format/document.h>
#include <bendy/format/limits.h>

#include <cstdint>
#include <vector>

namespace bendy::edit {

/// What is kept of a file, by the numbers in the original.
struct Kept {
    struct Mesh {
        bool stays = true;
        std::vector<bool> targets;
        std::vector<bool> vertices;  ///< empty: all
        bool keeps_levels = true;    ///< of detail
    };
    struct Object {
        bool stays = true;
        std::vector<bool> joints;    ///< the parent of a kept joint is kept
        std::vector<bool> polygons;  ///< per joint: whether its submeshes and local materials are kept
        std::vector<bool> chains, clips;
        std::vector<Mesh> meshes;
    };
    std::vector<bool> textures, materials;  ///< of HEAD
    bool local_materials = true;
    std::vector<Object> objects;
};

/// Returns a Kept that keeps everything.
Kept everything(const Document& document);

/// Returns the new number of each thing that is kept; kNone for what is removed.
inline std::vector<std::uint32_t> renumbered(const std::vector<bool>& stays) {
    std::vector<std::uint32_t> now(stays.size(), kNone);
    std::uint32_t next = 0;
    for (std::size_t k = 0; k < stays.size(); ++k) {
        if (stays[k]) now[k] = next++;
    }
    return now;
}

}  // namespace bendy::edit
