#pragma once

#include "document.h"

#include <bendy/converter/scene.h>

#include <string>
#include <vector>

// EXT_mesh_gpu_instancing: a node that draws its mesh several times.
namespace bendy::converter::gltf {

/// Where each instance of a node stands, relative to the node; the extension's own attributes (`_ID`) are named in a
/// warning. Empty: the node has no such extension, or nothing to draw. Fails on a faulty one; how many there may be is
/// held against the source's bytes.
std::vector<Transform> read_instances(const Document& document, std::size_t node);

/// Puts the numbers of its attributes in place of their accessors: {"type": "VEC3", "values": [...]}, and for whole
/// numbers "integers": true. Fails on a faulty one.
void inline_instances(const Document& document, Json& extension, const std::string& place);

}  // namespace bendy::converter::gltf
