#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Texture numbers in a material's extensions (EXTN): glTF's texture infos, objects with an "index", whose names end in
// "Texture". The text is changed where they stand and nowhere else.
namespace bendy::edit {

/// All of them; nothing if the text is not JSON as far as that can be seen.
std::optional<std::vector<std::uint32_t>> texture_numbers(std::string_view json);

/// The text with now[number] in place of each number; a texture info goes, with its name, where that is kNone. Nothing
/// if the text is not JSON, or a number is not there.
std::optional<std::string> renumber_textures(std::string_view json, std::span<const std::uint32_t> now);

}  // namespace bendy::edit
