#pragma once

#include "check_json.h"

// No image codecs and no file access; set before every inclusion, so that all see the same classes.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#include <tiny_gltf.h>

namespace bendy::converter::gltf {

/// Lets tinygltf read the structure of checked JSON. It gets no buffers, images, cameras or extensions, so it opens no
/// file, decodes nothing and cannot reject what it does not know; the importer reads those from the JSON. Two things
/// differ from the JSON on purpose: `indices` of primitives are left out (tinygltf rejects accessors without a view
/// there), and a channel without a target node has target_node -1 (tinygltf would drop it). Elements keep their
/// indices.
tinygltf::Model read_structure(const Json& root);

}  // namespace bendy::converter::gltf
