#pragma once

#include "document.h"
#include "scene/source/normalise.h"

#include <bendy/converter/scene.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace bendy::converter::gltf {

/// The vertices of one primitive, decoded and checked. `mesh` holds streams and targets; the influences still have all
/// their sets (see trim_influences).
struct Vertices {
    Mesh mesh;
    LargestBone largest_bone;
    std::vector<std::uint32_t> draco_indices;  ///< the triangles, where Draco stores them
};

/// Whether the primitive has positions; without them it draws nothing.
bool has_positions(const tinygltf::Primitive& primitive, const Json& json);

/// Decodes the streams of a primitive; influences only if `skinned` and present. `place` is the primitive's.
Vertices read_vertices(const Document& document, const tinygltf::Primitive& primitive, const Json& json, bool skinned,
                       const std::string& place);

/// The primitive's list of vertex indices, with strips, fans and loops resolved; all below `vertex_count`.
Submesh read_submesh(const Document& document, const tinygltf::Primitive& primitive, const Json& json,
                     std::size_t vertex_count, const std::vector<std::uint32_t>& draco_indices,
                     const std::string& place);

/// The names in `extras.targetNames` of a mesh or a primitive for its first `count` morph targets; empty if there are
/// none.
std::vector<std::string> target_names(const Json& owner, std::size_t count);

/// The mesh or primitive without the names that target_names returns, if it has no others.
Json without_target_names(const Json& owner, std::size_t count);

}  // namespace bendy::converter::gltf
