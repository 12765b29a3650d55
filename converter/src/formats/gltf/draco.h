#pragma once

#include "document.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace bendy::converter::gltf {

/// A primitive as KHR_draco_mesh_compression stores it.
struct DracoPrimitive {
    struct Attribute {
        std::size_t components = 0;
        std::vector<float> values;  ///< count * components, in the accessor's semantics (normalised or not)
    };
    std::size_t count = 0;                        ///< vertices
    std::vector<std::uint32_t> indices;           ///< 3 per triangle, in range
    std::map<std::string, Attribute> attributes;  ///< those that the extension lists, by glTF name
};

/// The extension object of a primitive, or null if it has none.
const Json* find_draco(const Json& primitive);

/// Decodes a primitive from its extension object. Fails at `place`, the primitive's.
DracoPrimitive decode_draco(const Document& document, const tinygltf::Primitive& primitive, const Json& extension,
                            const std::string& place);

}  // namespace bendy::converter::gltf
