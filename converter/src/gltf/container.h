#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::converter::gltf {

/// The two parts of a source file. `json` and `bin` look into `bytes`.
struct Container {
    std::vector<std::byte> bytes;
    std::string_view json;
    std::span<const std::byte> bin;  ///< the BIN chunk's data
    bool is_glb = false;
    bool has_bin = false;  ///< a BIN chunk is there, perhaps of no length
};

/// Tells .glb from .gltf by the first bytes and takes the first apart. Fails with an empty place.
Container open_container(std::vector<std::byte> bytes);

}  // namespace bendy::converter::gltf
