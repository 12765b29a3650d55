#pragma once

#include "gltf_out/buffer.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <cstdint>
#include <span>
#include <vector>

namespace bendy::converter::gltf_out {

struct ExportedMeshes {
    Json meshes = Json::array();
    Json skins = Json::array();
    std::vector<std::uint32_t> node_of_mesh;  ///< the node that draws a mesh of the scene; kNone: left out
};

/// Writes the scene's meshes, each on the node of the joint that carries it; those of one joint that go together become
/// primitives of one glTF mesh. What cannot share a node gets one of its own below, which is appended to `nodes`; its
/// number is added to `roots` where no joint carries it.
/// \param node_members  by joint, Joint::more: `skin` in it is what is said of the skin
ExportedMeshes export_meshes(const Scene& scene, std::span<const Json> node_members, Json& nodes, Json& roots,
                             Buffer& buffer, Report& report);

}  // namespace bendy::converter::gltf_out
