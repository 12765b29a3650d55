#pragma once

#include <bendy/format/document.h>
#include <bendy/format/limits.h>

#include <cstdint>
#include <vector>

namespace bendy::edit {

/// What stays of a file, by the numbers that things have in it.
struct Kept {
    struct Mesh {
        bool stays = true;
        std::vector<bool> targets;
        std::vector<bool> vertices;  ///< empty: all
        bool keeps_levels = true;    ///< of detail
    };
    struct Object {
        bool stays = true;
        std::vector<bool> joints;    ///< a joint that stays has a parent that stays
        std::vector<bool> polygons;  ///< of each joint: does it keep its polygons and local materials?
        std::vector<bool> chains, clips;
        std::vector<Mesh> meshes;
    };
    std::vector<bool> textures, materials;  ///< HEAD's
    bool local_materials = true;
    std::vector<Object> objects;
};

/// All of it.
Kept everything(const Document& document);

/// The numbers of what stays, counted anew; kNone for what goes.
inline std::vector<std::uint32_t> renumbered(const std::vector<bool>& stays) {
    std::vector<std::uint32_t> now(stays.size(), kNone);
    std::uint32_t next = 0;
    for (std::size_t k = 0; k < stays.size(); ++k) {
        if (stays[k]) now[k] = next++;
    }
    return now;
}

}  // namespace bendy::edit
