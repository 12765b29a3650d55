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

// Renumbers things after a removal, in every leaf that refers to them, as described by records.def and leaf_parts.def.
namespace bendy::edit {

/// The new number of each thing, by Entity; kNone: removed. An empty list: all unchanged. Frames, chains, meshes and
/// joints are those of an object, materials and textures those of HEAD.
struct NewNumbers {
    std::array<std::span<const std::uint32_t>, kEntities> now;
    bool own_materials = true;  ///< the joints' own materials are kept

    std::span<const std::uint32_t>& of(Entity thing) { return now[static_cast<std::size_t>(thing)]; }
    [[nodiscard]] std::uint32_t number(Entity thing, std::uint32_t before) const;
};

/// A field that no longer refers to anything.
struct Lost {
    std::string_view field;
    Entity entity = Entity::nothing;
    std::uint32_t number = 0;  ///< the number that it held
};

struct Renumbered {
    /// The new payload; nothing: the leaf is removed, because its record is.
    std::optional<Buffer> payload;
    std::vector<Lost> lost;  ///< of the leaf's record; if it is removed, the field that caused it
};

/// Decides about a record beyond its references, given the original numbers; may change other fields. Returns false to
/// remove the record.
using RecordRule = std::function<bool(const RecordLayout& layout, std::span<std::byte> record)>;

/// Records, rows and names are removed with what they refer or belong to; optional references become kNone.
Renumbered renumber_leaf(const LeafLayout& leaf, Bytes payload, const NewNumbers& numbers,
                         const RecordRule& rule = nullptr);

/// Returns true if the leaf refers to things, or has rows that belong to things.
bool has_references(const LeafLayout& leaf);

/// A leaf that is changed or removed: its chunk, and the references that it has lost.
using ToldLeaf = std::function<void(std::uint32_t chunk, const Renumbered& renumbered)>;
using LeafRule = std::function<bool(std::uint32_t chunk, const RecordLayout& layout, std::span<std::byte> record)>;

/// Renumbers all leaves in a container that have not been removed, except those that edit/ handles specially: PALT,
/// VINF, LODD, TRAK, PACK, PLAY, SAME.
/// \param told  may be empty
void renumber_leaves(const ChunkTree& tree, std::uint32_t container, const NewNumbers& numbers, const LeafRule& rule,
                     const ToldLeaf& told, Rewrite& rewrite);

/// Returns "CURV \"glow\"" for a leaf that contains a name; otherwise an empty string.
std::string name_of_leaf(const ChunkTree& tree, std::uint32_t chunk);

/// Returns true if a leaf directly in the container that refers to something has not been removed.
bool has_references_left(const ChunkTree& tree, std::uint32_t container, const Rewrite& rewrite);

}  // namespace bendy::edit
