#pragma once

#include "check_json.h"

// No image codecs and no file access; set before every inclusion, so that all see the same classes.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#include <tiny_gltf.h>

namespace bendy::converter::gltf {

/// Lets tinygltf's readers fill its structs from JSON that parse_json has checked. They get no buffers, images,
/// cameras, extensions and extras, so they open no file and decode nothing; the importer reads those from the JSON.
/// Elements keep their indices, and a channel without a target node has target_node -1.
tinygltf::Model read_structure(const Json& root);

}  // namespace bendy::converter::gltf
