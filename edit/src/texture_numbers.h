#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Texture numbers in a material's extensions (EXTN): glTF's texture infos, which are objects with an "index" whose
// names end in "Texture". Only these places in the text are changed.
namespace bendy::edit {

/// Returns all of them; nothing if the text is recognisably not JSON.
std::optional<std::vector<std::uint32_t>> texture_numbers(std::string_view json);

/// Returns the text with now[number] in place of each number; a texture info is removed, with its name, if that is
/// kNone. Returns nothing if the text is not JSON, or if a number is out of range.
std::optional<std::string> renumber_textures(std::string_view json, std::span<const std::uint32_t> now);

}  // namespace bendy::edit
