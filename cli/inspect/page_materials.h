#pragma once

#include <bendy/format/document.h>

#include <nlohmann/json.hpp>

#include <cstddef>

namespace bendy::cli {

/// Images are embedded up to this many bytes in all, in the order of the file.
inline constexpr std::size_t kMostImageBytes = std::size_t{32} << 20u;

/// The bytes as a URI that holds them.
std::string data_uri(std::string_view media_type, Bytes bytes);

/// The textures: images as data URIs as far as a browser can show them, samplers, who uses them.
nlohmann::ordered_json page_textures(const Document& document);
/// The materials: surface parameters, textures, extensions.
nlohmann::ordered_json page_materials(const Document& document);

}  // namespace bendy::cli
