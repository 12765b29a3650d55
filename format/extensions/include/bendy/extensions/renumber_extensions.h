#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// glTF extensions that are kept as JSON (EXTN), and the numbers in them: references.def.
namespace bendy::extensions {

/// The maximum nesting of arrays and objects: copying and printing JSON recurses.
inline constexpr std::size_t kMostLevels = 128;

/// The kind of thing that a number in an extension refers to.
enum class Thing : std::uint8_t {
    joint,            ///< in glTF: a node
    mesh,             ///< VECT; in glTF: a mesh
    target_of_joint,  ///< a morph target of the joint's mesh
    target_of_mesh,   ///< a morph target of a mesh
    material,
    texture,
    image,              ///< in a bendy file the texture that owns the image; in glTF: an image
    element,            ///< of an array of the same extension
    rows_of_materials,  ///< not a number: an array with one element per material
};

/// The owner of the `extensions` object.
enum class Host : std::uint8_t { root, node, material };

/// Returns the new number of a thing, or nothing if it does not exist. \param owner  of targets: the number of the
/// joint or mesh
using NewNumber = std::function<std::optional<std::uint32_t>(Thing thing, std::uint32_t number, std::uint32_t owner)>;

/// Returns the number itself, if it is less than the number of things.
inline std::optional<std::uint32_t> below(std::uint32_t number, std::size_t count) {
    return number < count ? std::optional(number) : std::nullopt;
}

struct Renumbered {
    std::string json;  ///< an object, or empty if no extension is left; the very same text if no number has changed,
                       ///< else members by name
    std::vector<std::string> gone;     ///< the removed parts: "VRM.humanoid.humanBones[3].node"
    std::vector<std::string> unknown;  ///< extensions with whole numbers of unknown meaning; not those of materials
};

/// Puts the new numbers into extensions, and removes the entries whose things no longer exist. In a material also the
/// texture of each "...Texture": {"index": ...}, whatever the extension. \param json  an object of extensions by name.
/// Returns nothing if it is not an object, or is nested deeper than kMostLevels
std::optional<Renumbered> renumber_extensions(std::string_view json, Host host, const NewNumber& now);

/// Returns true if the meaning of all numbers in an extension of that name is known.
bool is_known(std::string_view name);

}  // namespace bendy::extensions
