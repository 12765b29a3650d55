#pragma once

#include "rewrite.h"

#include <bendy/format/leaf_parts.h>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Numbers of things that are taken out or counted anew, in every leaf that refers to them: records.def and
// leaf_parts.def say which do.
namespace bendy::edit {

/// The number of each thing from now on, by Entity; kNone: it goes. An empty list: all stay as they were. Frames,
/// chains, meshes and joints are an object's, materials and textures HEAD's.
struct NewNumbers {
    std::array<std::span<const std::uint32_t>, kEntities> now;
    bool own_materials = true;  ///< the joints' own ones stay

    std::span<const std::uint32_t>& of(Entity thing) { return now[static_cast<std::size_t>(thing)]; }
    [[nodiscard]] std::uint32_t number(Entity thing, std::uint32_t before) const;
};

/// A field that refers to nothing from now on.
struct Lost {
    std::string_view field;
    Entity entity = Entity::nothing;
    std::uint32_t number = 0;  ///< that it held
};

struct Renumbered {
    /// The payload from now on; nothing: the leaf goes, since its record does.
    std::optional<Buffer> payload;
    std::vector<Lost> lost;  ///< of the leaf's record; if it goes, the field for which it goes
};

/// Decides about a record beyond its references, with the numbers that it had; may change other fields of it. False: it
/// goes.
using RecordRule = std::function<bool(const RecordLayout& layout, std::span<std::byte> record)>;

/// Records, rows and names go with what they refer or belong to; optional references become kNone.
Renumbered renumber_leaf(const LeafLayout& leaf, Bytes payload, const NewNumbers& numbers,
                         const RecordRule& rule = nullptr);

/// The leaf refers to things, or has rows that belong to some.
bool has_references(const LeafLayout& leaf);

/// A leaf that has changed or goes: its chunk, and what it has lost.
using ToldLeaf = std::function<void(std::uint32_t chunk, const Renumbered& renumbered)>;
using LeafRule = std::function<bool(std::uint32_t chunk, const RecordLayout& layout, std::span<std::byte> record)>;

/// Renumbers all leaves in a container that are there still, but for those of which edit/ knows more: PALT, VINF, LODD,
/// TRAK, PACK, PLAY, SAME. \param told  may be empty
void renumber_leaves(const ChunkTree& tree, std::uint32_t container, const NewNumbers& numbers, const LeafRule& rule,
                     const ToldLeaf& told, Rewrite& rewrite);

/// "CURV \"glow\"", for a leaf that has a name in it; else empty.
std::string name_of_leaf(const ChunkTree& tree, std::uint32_t chunk);

/// A leaf right in the container is there still that refers to something.
bool has_references_left(const ChunkTree& tree, std::uint32_t container, const Rewrite& rewrite);

}  // namespace bendy::edit
