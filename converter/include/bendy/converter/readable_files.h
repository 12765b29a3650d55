#pragma once

#include <filesystem>
#include <string>

namespace bendy::converter {

/// ".gltf, .glb, ...": what the names of files that `convert` reads end in, bendy files apart; for messages. What a
/// file is, its content tells.
std::string list_readable_suffixes();

/// True if the file's name ends in one of them, in capitals or not.
bool has_readable_suffix(const std::filesystem::path& file);

}  // namespace bendy::converter
