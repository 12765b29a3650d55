#pragma once

#include "check_json.h"

// No image codecs and no files; set before every inclusion, so that all see the same classes.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#include <tiny_gltf.h>

namespace bendy::converter::gltf {

/// Lets tinygltf read the structure of checked JSON. It is given no buffer, image, camera or extension, so it opens no
/// file, decodes nothing and cannot reject what it does not know; those are read from the JSON by the importer. Two
/// things differ from the JSON on purpose: `indices` of primitives are left out (tinygltf refuses accessors without a
/// view there), and a channel without a target node has target_node -1 (tinygltf would drop it). Elements stand at the
/// same indices as in the JSON.
tinygltf::Model read_structure(const Json& root);

}  // namespace bendy::converter::gltf
